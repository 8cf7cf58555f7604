"""SPARQL queries over a memory: which ones are allowed, and where a query is wrong."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from typing import Any

import pyoxigraph as ox

from deixis.memory.errors import QueryError
from deixis.memory.semantic.queries import worker
from deixis.memory.semantic.queries.limits import MAX_DEPTH, MAX_LENGTH, MAX_TOKENS, QueryLimits
from deixis.memory.semantic.queries.results import QueryKind, QueryResult, StoreAnswer, Term, solutions
from deixis.memory.semantic.queries.tokens import (
    Token,
    TokenKind,
    ambiguous,
    decoded,
    given_offset,
    tokens,
    too_deep,
)
from deixis.memory.semantic.rdf.files import PREFIXES, short
from deixis.memory.semantic.rdf.graphs import GRAPHS, READABLE, GraphName, graph_iri
from deixis.ontology.rdf.triples import LEARNED, typed
from deixis.ontology.rdf.vocabulary import BASE, DX, W3C
from deixis.printable import window
from deixis.spelling import nearest

_UPDATES = {"INSERT", "DELETE", "LOAD", "CLEAR", "CREATE", "DROP", "COPY", "MOVE", "ADD", "WITH", "USING"}
_FORMS = {"SELECT", "ASK", "CONSTRUCT", "DESCRIBE"}
_PROLOGUE = {"PREFIX", "BASE"}

STANDARD = ("rdf", "rdfs", "owl", "skos", "prov", "dcterms", "sh", "sosa")
"""Prefixes of the standard vocabularies whose terms rdflib knows."""

CLOSED = {"dx": BASE} | {prefix: PREFIXES[prefix] for prefix in ("dxg", *STANDARD)}
"""Namespaces by prefix of which every term is known, so that a misspelt one is an error."""

MAX_NAMED = 3
"""Maximum number of layouts that a note names."""


@dataclass(frozen=True)
class CheckedQuery:
    """An allowed query: its text, its form, and its graphs and order."""

    text: str
    kind: QueryKind
    names_graphs: bool  # with FROM
    asks_graphs: bool  # with GRAPH
    ordered: bool
    prefixes: Mapping[str, str]  # the predeclared prefixes that it uses
    terms: tuple[tuple[str, int], ...] = ()  # IRIs in the namespaces of CLOSED, and where each first stands
    learned: tuple[str, ...] = ()  # IRIs of things that a memory learned
    types: tuple[str, ...] = ()  # IRIs of the classes whose instances it asks for


class _Text:
    """The text of a query, decoded, with the places in the text as given."""

    def __init__(self, given: str) -> None:
        self.given = given
        self.text, self._places = decoded(given)

    def error(self, offset: int, message: str) -> QueryError:
        """Return an error at an offset of the decoded text, with the line and a caret."""
        offset = given_offset(offset, self._places)
        before = self.given[:offset]
        line = before.count("\n") + 1
        start = before.rfind("\n") + 1
        shown = self.given[start:].split("\n", 1)[0].rstrip("\r")
        shown, column = window(shown, offset - start)
        return QueryError(f"query:{line}:{offset - start + 1}: {message}\n  {shown}\n  {' ' * column}^")

    def offset(self, line: int, column: int) -> int:
        """Return the offset in the decoded text of a line and a column in it."""
        lines = self.text.split("\n")
        return min(sum(len(before) + 1 for before in lines[: line - 1]) + column - 1, len(self.text))


Answering = Callable[[Mapping[str, Any], QueryLimits], tuple[bytes, bytes]]
"""A function that answers a request as the process of :mod:`.worker` does, with the answer's kind and bytes."""


def run_query(answering: Answering, sparql: str, union: Sequence[ox.NamedNode], limits: QueryLimits) -> QueryResult:
    """Return the answer of a query.

    Parameters
    ----------
    answering
        Function that answers requests.
    sparql
        Text of the query.
    union
        Graphs that it reads unless it names others.
    limits
        Limits of time and memory.

    Returns
    -------
    QueryResult
        The answer, read to the end.

    Raises
    ------
    QueryError
        If the query is refused or malformed.
    QueryTimeoutError, QueryMemoryError
        If a limit is reached.
    """
    checked = _admitted(sparql)
    default = None if checked.names_graphs else [graph.value for graph in union]
    named = [graph.value for graph in READABLE] if checked.asks_graphs and default else None
    found = answer(answering, sparql, checked, checked.prefixes, default, named, None, limits)
    return QueryResult.of(checked.kind, found, checked.ordered, limits)


def answer(
    answering: Answering,
    sparql: str,
    checked: CheckedQuery,
    prefixes: Mapping[str, str],
    default_graph: Sequence[str] | None,
    named_graphs: Sequence[str] | None,
    bindings: Mapping[str, Term] | None,
    limits: QueryLimits,
) -> StoreAnswer:
    """Return Oxigraph's answer to a checked query.

    Parameters
    ----------
    answering
        Function that answers requests.
    sparql
        Text of the query as given, for messages.
    checked
        The checked query.
    prefixes
        Predeclared prefixes.
    default_graph, named_graphs
        IRIs of graphs, or None for those in the query.
    bindings
        Values of variables.
    limits
        Limits of time and memory.

    Returns
    -------
    StoreAnswer
        Solutions, a boolean, or triples.

    Raises
    ------
    QueryError
        If the query is malformed, or a limit is reached.
    RuntimeError
        If Oxigraph cannot read the store.
    """
    request = {
        "text": checked.text,
        "prefixes": dict(prefixes),
        "default_graph": default_graph,
        "named_graphs": named_graphs,
        "bindings": None if bindings is None else solutions([*bindings], [[*bindings.values()]]),
    }
    kind, content = answering(request, limits)
    if kind == worker.SYNTAX:
        raise _syntax_error(_Text(sparql), content.decode())
    if kind == worker.VALUE:
        raise QueryError(f"query: {content.decode()}")
    if kind == worker.STORAGE:
        raise RuntimeError(content.decode())
    if kind == worker.TRIPLES:
        return [quad.triple for quad in ox.parse(content, format=ox.RdfFormat.N_TRIPLES, lenient=True)]
    return ox.parse_query_results(content, format=ox.QueryResultsFormat.JSON)


@lru_cache(maxsize=256)
def _admitted(sparql: str) -> CheckedQuery:
    """Return the result of :func:`check_query`, cached, as programs repeat queries."""
    return check_query(sparql)


def check_query(sparql: str, prefixes: Mapping[str, str] = PREFIXES) -> CheckedQuery:
    """Return the properties of a query without running it.

    Parameters
    ----------
    sparql
        Text of the query.
    prefixes
        Predeclared prefixes.

    Returns
    -------
    CheckedQuery
        The properties.

    Raises
    ------
    QueryError
        If the query is refused.

    Examples
    --------
    >>> check_query("ASK { ?s ?p ?o }").kind
    <QueryKind.ASK: 'ask'>
    """
    if len(sparql) > MAX_LENGTH:
        raise QueryError(f"query: it must have at most {MAX_LENGTH:,} characters, got {len(sparql):,}")
    text = _Text(sparql)
    half = next((place for place, character in enumerate(text.text) if "\ud800" <= character <= "\udfff"), None)
    if half is not None:
        raise text.error(half, "this is not a character; write the query in UTF-8")
    found = list(islice(tokens(text.text), MAX_TOKENS + 1))
    if len(found) > MAX_TOKENS:
        raise text.error(found[-1].start, f"the query must have at most {MAX_TOKENS:,} tokens, got more; split it")
    declared = {}
    for word, name, iri in zip(found, found[1:], found[2:], strict=False):
        if word.kind is TokenKind.WORD and word.upper == "PREFIX" and name.text.endswith(":"):
            declared[name.text[:-1]] = iri.text[1:-1]
    known, prologue = {**prefixes, **declared}, _prologue(found)
    deep = too_deep(found, known.keys(), MAX_DEPTH)
    if deep is not None:
        raise text.error(
            deep.start, f"nested too deeply: brackets and signs may be nested at most {MAX_DEPTH} levels deep"
        )
    for position, token in enumerate(found):
        before = found[position - 1 : position]
        after = found[position + 1 : position + 2]
        if token.kind is TokenKind.WORD:
            if "SERVICE" in token.upper:
                raise text.error(token.start, "SERVICE is refused: a query must not read another endpoint")
            if token.upper in _UPDATES:
                raise text.error(token.start, f"{token.upper} is refused: a query must not change the memory")
        elif token.kind is TokenKind.NAME and not token.text.startswith("_:"):
            given_prefix = token.text.partition(":")[0]
            opens = after and after[0].text == "{" and not (before and before[0].upper == "GRAPH")
            if "SERVICE" in given_prefix.upper() and opens:
                raise text.error(token.start, "SERVICE is refused: a query must not read another endpoint")
            if given_prefix not in known and not (before and before[0].upper == "PREFIX"):
                near = nearest(given_prefix, sorted(known))
                hint = (
                    f"did you mean '{near}:'?"
                    if near
                    else f"the predeclared prefixes are {', '.join(sorted(PREFIXES))};"
                )
                raise text.error(
                    token.start,
                    f"unknown prefix '{given_prefix}:'; {hint} otherwise declare it: PREFIX {given_prefix}: <…>",
                )
        elif token.kind is TokenKind.IRI and position >= prologue and ambiguous(token, known.keys()):
            raise text.error(
                token.start,
                "ambiguous: an IRI or a comparison; write the IRI in full, or put spaces around '<'",
            )
    form = next((token for token in _body(found) if token.kind is TokenKind.WORD and token.upper in _FORMS), None)
    if form is None:
        raise text.error(0, "a query must begin with SELECT, ASK, CONSTRUCT or DESCRIBE")
    names_graphs = _check_from(text, found, known)
    asks_graphs = any(token.kind is TokenKind.WORD and token.upper == "GRAPH" for token in found)
    used = {token.text.partition(":")[0] for token in found if token.kind is TokenKind.NAME}
    undeclared = {prefix: base for prefix, base in prefixes.items() if prefix in used and prefix not in declared}
    kind, ordered, iris = QueryKind(form.text.lower()), _ordered(found), _iris(found, known)
    terms = tuple((iri, place) for iri, place in iris.items() if (prefix := _closed(iri)) and iri != CLOSED[prefix])
    learned = tuple(iri for iri in iris if iri.startswith(LEARNED) and iri != LEARNED)
    types = tuple(dict.fromkeys(_types(found, known)))
    return CheckedQuery(text.text, kind, names_graphs, asks_graphs, ordered, undeclared, terms, learned, types)


def _types(found: list[Token], known: Mapping[str, str]) -> Iterator[str]:
    """Yield the IRI of each class that follows ``a`` or ``rdf:type``."""
    iri_kinds = (TokenKind.IRI, TokenKind.NAME)
    for before, token in itertools.pairwise(found):
        is_type = before.text == "a" or (before.kind in iri_kinds and _iri(before, known) == W3C.RDF_TYPE)
        if is_type and token.kind in iri_kinds and not token.text.startswith("_:"):
            yield _iri(token, known)


def _iris(found: list[Token], known: Mapping[str, str]) -> dict[str, int]:
    """Return the IRIs of the query, each with its first place, without those that declare a prefix."""
    iris: dict[str, int] = {}
    for before, token in zip([None, *found], found, strict=False):
        if token.kind is TokenKind.IRI or (token.kind is TokenKind.NAME and not token.text.startswith("_:")):
            iri = _iri(token, known)
            declared = before is not None and before.upper in ("PREFIX", "BASE")
            if iri is not None and not declared:
                iris.setdefault(iri, token.start)
    return iris


def _closed(iri: str) -> str | None:
    """Return the prefix of the namespace of an IRI, None where its terms are not known one by one."""
    return next((prefix for prefix, base in CLOSED.items() if iri.startswith(base)), None)


def _terms_of(prefix: str, store: ox.Store) -> set[str]:
    """Return the local names of the vocabulary of Deixis (that of a memory and all nouns), or of a standard one."""
    if prefix == "dx":
        from deixis.ontology.tbox import default_ontology

        subjects = {quad.subject for quad in store.quads_for_pattern(None, None, None, graph_iri(GraphName.ONTOLOGY))}
        known = {subject.value for subject in subjects if isinstance(subject, ox.NamedNode)}
        known |= {kind.iri for senses in default_ontology().kinds.every_word.values() for kind in senses}
        return {value.removeprefix(BASE) for value in known if value.startswith(BASE)}
    if prefix == "dxg":
        return {graph.value.removeprefix(GRAPHS) for graph in READABLE}
    import rdflib

    terms = dir(getattr(rdflib, prefix.upper()))
    return {str(term).removeprefix(CLOSED[prefix]) for term in terms if not str(term).startswith("_")}


def require_terms(store: ox.Store, sparql: str) -> None:
    """Raise QueryError if a query names a term that neither vocabulary nor memory has.

    Parameters
    ----------
    store
        The memory.
    sparql
        An admitted query.

    Raises
    ------
    QueryError
        If it does; the message suggests the nearest term.
    """
    for iri, place in _admitted(sparql).terms:
        if _is_used(iri, store):
            continue
        prefix = _closed(iri) or "dx"
        name, names = iri.removeprefix(CLOSED[prefix]), _terms_of(prefix, store)
        if name in names or (prefix == "rdf" and re.fullmatch(r"_[1-9]\d*", name)):
            continue
        near = next((one for one in sorted(names) if one.casefold() == name.casefold()), None) or nearest(name, names)
        hint = f"; did you mean '{prefix}:{near}'?" if near else ""
        if not near and prefix == "dx":
            hint = "; docs/reference/ontology.md lists the terms"
        what = "the memory does not have this graph:" if prefix == "dxg" else "the vocabulary has no term"
        raise _Text(sparql).error(place, f"{what} '{prefix}:{name}'{hint}")


def _is_used(iri: str, store: ox.Store) -> bool:
    """Return whether a memory has a statement with an IRI."""
    term = ox.NamedNode(iri)
    uses = (
        store.quads_for_pattern(term, None, None),
        store.quads_for_pattern(None, term, None),
        store.quads_for_pattern(None, None, term),
    )
    return any(next(iter(found), None) for found in uses)


def unknown_things(store: ox.Store, sparql: str) -> Iterator[str]:
    """Yield a note for each learned thing that a query names and the memory does not have.

    Parameters
    ----------
    store
        The memory.
    sparql
        An admitted query.

    Yields
    ------
    str
        A sentence without a full stop, which suggests the nearest name.
    """
    missing = [iri for iri in _admitted(sparql).learned if not _is_used(iri, store)]
    if not missing:
        return
    subjects = {quad.subject for quad in store.quads_for_pattern(None, None, None)}
    known = [subject.value for subject in subjects if isinstance(subject, ox.NamedNode)]
    known = [iri for iri in known if iri.startswith(LEARNED)]
    for iri in missing:
        if any(one.startswith(iri) for one in known):  # the query compares the beginnings of IRIs
            continue
        near = nearest(iri, known)
        hint = f"; did you mean '{_in_query(near)}'?" if near else ""
        yield f"the memory has no '{_in_query(iri)}'{hint}"


def classes_without_instances(store: ox.Store, sparql: str) -> Iterator[str]:
    """Yield a note for each class whose instances a query asks for, and of which the memory has subclasses only.

    Parameters
    ----------
    store
        The memory.
    sparql
        An admitted query.

    Yields
    ------
    str
        A sentence without a full stop, which says how to ask for the subclasses.
    """
    for iri in _admitted(sparql).types:
        term = ox.NamedNode(iri)
        if any(store.quads_for_pattern(None, ox.NamedNode(W3C.RDF_TYPE), term)):
            continue
        below = store.quads_for_pattern(None, ox.NamedNode(W3C.RDFS_SUB_CLASS_OF), term)
        if any(isinstance(quad.subject, ox.NamedNode) and quad.subject.value.startswith(LEARNED) for quad in below):
            name = short(iri)
            yield f"'{name}' has subclasses in this memory but no instances; ask for '?x rdfs:subClassOf {name}'"


def _in_query(iri: str) -> str:
    """Return the IRI of a learned thing as a query can name it."""
    return f"lx:{iri.removeprefix(LEARNED)}".replace("/", "\\/")


def incomplete_layouts(store: ox.Store, sparql: str) -> tuple[str, ...]:
    """Return the layouts whose implications a query asks for, and for which the memory does not store all of them.

    Parameters
    ----------
    store
        The memory.
    sparql
        An admitted query.

    Returns
    -------
    tuple of str
        Names of layouts in order; empty for a query that is not about relations or implied statements.
    """
    reading, about = ox.NamedNode(DX.READING), {DX.IMPLIED_STATEMENT, DX.RULE}
    terms = (ox.NamedNode(term) for term, _ in _admitted(sparql).terms)
    if not any(term.value in about or any(store.quads_for_pattern(term, reading, None)) for term in terms):
        return ()
    not_stored = store.quads_for_pattern(None, ox.NamedNode(DX.IMPLICATIONS_STORED), typed(False))
    layouts = {quad.subject for quad in not_stored}
    return tuple(sorted(layout.value.rpartition("/")[2] for layout in layouts if isinstance(layout, ox.NamedNode)))


def notes_on(store: ox.Store, sparql: str, is_empty: bool = False) -> tuple[str, ...]:
    """Return notes on what an answer may lack.

    Parameters
    ----------
    store
        The memory.
    sparql
        An admitted query.
    is_empty
        True if the answer has neither rows nor triples.

    Returns
    -------
    tuple of str
        Sentences without a full stop; empty if the answer lacks nothing.
    """
    unknown = tuple(unknown_things(store, sparql))
    if is_empty:
        unknown += tuple(classes_without_instances(store, sparql))
    names = incomplete_layouts(store, sparql)
    if not names:
        return unknown
    listed = ", ".join(names[:MAX_NAMED]) + (f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else "")
    return (
        *unknown,
        "the memory does not store all that these layouts imply, so their part of the answer may be incomplete: "
        f"{listed}; 'deixis infer' on the script that 'deixis show' prints computes it",
    )


def _prologue(found: list[Token]) -> int:
    """Return the number of tokens that declare prefixes and bases, where ``<`` is never a comparison."""
    end = 0
    while True:
        first, second, third = (*found[end : end + 3], *[None] * 3)[:3]
        if first is None or second is None or first.kind is not TokenKind.WORD:
            return end
        if first.upper == "BASE" and second.kind is TokenKind.IRI:
            end += 2
        elif first.upper == "PREFIX" and second.text.endswith(":") and third and third.kind is TokenKind.IRI:
            end += 3
        else:
            return end


def _body(found: list[Token]) -> list[Token]:
    """Return the tokens after the prologue."""
    start = 0
    while start < len(found) and found[start].upper in _PROLOGUE:
        start += 3 if found[start].upper == "PREFIX" else 2
    return found[start:]


def _check_from(text: _Text, found: list[Token], known: dict[str, str]) -> bool:
    """Return whether the query names graphs with FROM; raise QueryError for graphs that the memory does not have."""
    own, named = {iri.value for iri in READABLE}, False
    for position, token in enumerate(found):
        if token.kind is not TokenKind.WORD or token.upper != "FROM":
            continue
        rest = found[position + 1 : position + 3]
        graph = rest[1] if rest and rest[0].upper == "NAMED" and len(rest) > 1 else rest[0] if rest else token
        if _iri(graph, known) not in own:
            listed = ", ".join(f"dxg:{iri.value.removeprefix(GRAPHS)}" for iri in READABLE)
            raise text.error(
                graph.start, f"the memory does not have this graph, and graphs are not fetched; it has {listed}"
            )
        named = True
    return named


def _iri(token: Token, known: Mapping[str, str]) -> str:
    if token.kind is TokenKind.IRI:
        return token.text[1:-1]
    prefix, _, local = token.text.partition(":")
    return known.get(prefix, "") + re.sub(
        r"\\(.)", r"\1", local
    )  # a sign is written with a backslash: lx:layout\/tea-1


def _ordered(found: list[Token]) -> bool:
    """Return whether the outermost query has an ORDER BY."""
    depth = 0
    for token in found:
        if token.kind is TokenKind.SIGN:
            depth += (token.text == "{") - (token.text == "}")
        elif token.kind is TokenKind.WORD and token.upper == "ORDER" and depth == 0:
            return True
    return False


def _syntax_error(text: _Text, message: str) -> QueryError:
    """Return the error for a message of Oxigraph's parser."""
    message = " ".join(message.split())
    found = re.match(r"error at (\d+):(\d+): (.*)", message)
    if not found:
        return QueryError(f"query: {message}")
    line, column, what = int(found.group(1)), int(found.group(2)), found.group(3)
    offset = text.offset(line, column)
    opened = None if text.text[offset:].strip() else _unclosed(text.text)
    if opened is not None:
        return text.error(opened.start, f"syntax error: the query ends before this '{opened.text}' is closed")
    return text.error(offset, f"syntax error{_unescaped(text.text, offset) or _expected(what)}")


def _unescaped(text: str, offset: int) -> str:
    """Return the advice for a prefixed name with plain slashes at an offset, empty if there is none."""
    for name in re.finditer(r"(?<![\w:/])\w+:[\w.%-]+(?:/[\w.%-]+)+(?![\w:])", text):
        if name.start() <= offset <= name.end():
            written = name.group().replace("/", r"\/")
            return rf"; write '/' in a prefixed name as '\/': {written}"
    return ""


def _unclosed(text: str) -> Token | None:
    """Return the last bracket that a query opens and does not close."""
    opened: list[Token] = []
    for token in tokens(text):
        if token.text in ("{", "(", "["):
            opened.append(token)
        elif token.text in ("}", ")", "]") and opened:
            opened.pop()
    return opened[-1] if opened else None


def _expected(what: str) -> str:
    """Return the words, without character classes, that the parser expected."""
    names = re.sub(r"\[[^\]]*\]( \|)?|'[^']*'\.\.='[^']*'", "", what.removeprefix("expected ").removeprefix("one of "))
    expected = next((name for name in names.split(", ") if " " in name.strip() and "not found" not in name), None)
    if expected:
        return f": {expected.strip()}"
    words = [name.strip() for name in names.split(",") if re.fullmatch(r'[A-Z]+|"[^"]+"', name.strip())]
    return f"; expected {' or '.join(words[:8])}" if words else ""
