"""Answers to queries, and their output formats."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import pyoxigraph as ox

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.memory.errors import QueryError
from deixis.memory.semantic.queries.limits import CELL_BYTES, ROW_BYTES, QueryLimits
from deixis.memory.semantic.rdf.files import PREFIXES, short
from deixis.ontology.rdf.triples import with_blank_nodes
from deixis.printable import visible_line

Term = ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple
StoreAnswer = ox.QuerySolutions | ox.QueryBoolean | Sequence[ox.Triple]
_STRING = PREFIXES["xsd"] + "string"

_FORMULA = re.compile(r"[=+\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")
"""First characters of cells that a spreadsheet may run as a formula: see OWASP, CSV injection."""

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|[+-]?INF")


EMPTY_ANSWER = "the query has no answer: nothing in the memory matches it"
"""Sentence about an answer without rows and triples."""

MAX_PADDED = 80
"""Maximum width of a column of plain text to which shorter cells are padded."""


class QueryKind(StrEnum):
    """Form of a query."""

    SELECT = "select"
    ASK = "ask"
    CONSTRUCT = "construct"
    DESCRIBE = "describe"


class Row(tuple[Term | None, ...]):
    """One solution of a SELECT query: a tuple of terms that are also read by the names of their variables.

    None stands for a variable without a value. ``row.name`` reads a variable too, as with rdflib's rows, except for the
    names of the methods of a tuple (``count``, ``index``).

    Examples
    --------
    >>> row = Row((ox.Literal("fork"), None), ("name", "size"))
    >>> row["name"].value, row.name.value, row["size"], len(row)
    ('fork', 'fork', None, 2)
    >>> row.asdict()["name"].value
    'fork'
    >>> row
    Row(name="fork", size=None)
    """

    variables: tuple[str, ...]

    def __new__(cls, terms: Iterable[Term | None], variables: tuple[str, ...]) -> Row:
        """Return a row of terms in the order of ``variables``."""
        row = super().__new__(cls, terms)
        row.variables = variables
        return row

    def __getnewargs__(self) -> tuple[tuple[Term | None, ...], tuple[str, ...]]:
        """Return the arguments of ``__new__``, with which copies and pickles are made."""
        return tuple(self), self.variables

    def __getitem__(self, key: Any) -> Any:
        """Return the term of a variable's name (with or without ``?``), or of a position."""
        if not isinstance(key, str):
            return super().__getitem__(key)
        try:
            return super().__getitem__(self.variables.index(key.removeprefix("?")))
        except ValueError:
            known = ", ".join(self.variables)
            raise KeyError(f"the query selects no variable '{key}'; it selects {known}") from None

    def __getattr__(self, name: str) -> Any:
        """Return the term of a variable that is not the name of a method."""
        if name.startswith("_") or name == "variables" or name not in self.variables:
            raise AttributeError(f"'{type(self).__name__}' object has no attribute '{name}'")
        return self[name]

    def __repr__(self) -> str:
        """Return the names of the variables with their terms as SPARQL writes them."""
        return f"Row({', '.join(f'{name}={term}' for name, term in self.asdict().items())})"

    def asdict(self) -> dict[str, Term | None]:
        """Return the terms by the names of their variables.

        Returns
        -------
        dict
            Term by name; None for a variable without a value.
        """
        return dict(zip(self.variables, self, strict=True))


@dataclass(frozen=True, repr=False)
class QueryResult(Answer):
    """Answer of a query: rows of terms, a boolean, or triples, by its kind.

    An answer is iterated by its rows or triples, which ``len`` counts; it is true if there are any, or if the boolean
    is. Rows are in the order of the store; the printed rows are sorted if the query has no order, so that the same
    memory prints the same answer.

    Examples
    --------
    >>> from deixis.memory.semantic.queries.limits import QueryLimits
    >>> store = ox.Store()
    >>> store.add(ox.Quad(ox.NamedNode("urn:fork"), ox.NamedNode("urn:isA"), ox.Literal("cutlery")))
    >>> limits = QueryLimits(1.0, 1 << 20)
    >>> answer = store.query("SELECT ?what ?kind WHERE { ?what <urn:isA> ?kind }")
    >>> found = QueryResult.of(QueryKind.SELECT, answer, ordered=False, limits=limits)
    >>> found, found.empty, found.printed()[0]["kind"].value
    (<QueryResult SELECT ?what ?kind: 1 row>, False, 'cutlery')
    >>> len(found), [row.kind.value for row in found]
    (1, ['cutlery'])
    >>> found.to_table()
    ['what        kind', '----------  -------', '<urn:fork>  cutlery']
    >>> QueryResult(QueryKind.SELECT, ("what",)).remarks()
    ('the query has no answer: nothing in the memory matches it',)
    >>> found.to_csv().split()
    ['what,kind', 'urn:fork,cutlery']
    >>> found.to_json() == "".join(found.json_parts())
    True
    >>> answer = store.query("CONSTRUCT { ?what a ?kind } WHERE { ?what <urn:isA> ?kind }")
    >>> QueryResult.of(QueryKind.CONSTRUCT, answer, ordered=False, limits=limits).to_turtle().splitlines()[-1]
    '<urn:fork> a "cutlery" .'
    """

    kind: QueryKind
    variables: tuple[str, ...] = ()
    rows: tuple[Row, ...] = ()
    boolean: bool | None = None
    triples: tuple[ox.Triple, ...] = ()
    ordered: bool = False  # True if the query has ORDER BY
    notes: tuple[str, ...] = ()  # on what the answer may lack

    def __iter__(self) -> Iterator[Row | ox.Triple]:
        yield from self.rows
        yield from self.triples

    def __len__(self) -> int:
        return len(self.rows or self.triples)

    def __bool__(self) -> bool:
        return bool(self.boolean or self.rows or self.triples)

    def summary(self) -> str:
        """Return the kind of the answer, and its number of rows or triples."""
        if self.kind is QueryKind.ASK:
            return f"ASK: {'yes' if self.boolean else 'no'}"
        if self.kind is QueryKind.SELECT:
            return f"SELECT {' '.join('?' + name for name in self.variables)}: {count(len(self.rows), 'row')}"
        return f"{self.kind.upper()}: {count(len(self.triples), 'triple')}"

    @property
    def empty(self) -> bool:
        """True for a query of rows or triples that found none."""
        return self.kind is not QueryKind.ASK and not self.rows and not self.triples

    def remarks(self) -> tuple[str, ...]:
        """Return the sentence about an empty answer, if it is empty, and the notes on what the answer may lack.

        Returns
        -------
        tuple of str
            Sentences that people read beside the rows; files of rows do not have them.
        """
        return (EMPTY_ANSWER, *self.notes) if self.empty else self.notes

    @classmethod
    def of(cls, kind: QueryKind, answer: StoreAnswer, ordered: bool, limits: QueryLimits) -> QueryResult:
        """Read Oxigraph's answer to the end.

        Parameters
        ----------
        kind
            Form of the query, such as SELECT.
        answer
            The answer of the store.
        ordered
            True if the query orders its rows; others are sorted for printing.
        limits
            Limits of time and memory.

        Returns
        -------
        QueryResult
            The answer, independent of the store.

        Raises
        ------
        QueryMemoryError
            If the answer is larger than the limit.
        """
        if isinstance(answer, ox.QueryBoolean):
            return cls(kind, boolean=bool(answer))
        if isinstance(answer, ox.QuerySolutions):
            variables = tuple(variable.value for variable in answer.variables)
            rows = tuple(Row(row, variables) for row in rows_within(answer, limits))
            return cls(kind, variables, rows, ordered=ordered)
        return cls(kind, triples=tuple(sorted(set(answer), key=str)))

    def printed(self) -> Sequence[Sequence[Term | None]]:
        """Return the rows in the order in which they are printed.

        Returns
        -------
        sequence of sequence of Term or None
            One row for each solution: a term, or None for an unbound variable, in the order of the variables.
        """
        return self.rows if self.ordered else sorted(self.rows, key=_row_key)

    def to_table(self) -> list[str]:
        """Return the answer as aligned plain text.

        Returns
        -------
        list of str
            The lines, with IRIs abbreviated by known prefixes.
        """
        if self.kind is QueryKind.ASK:
            return ["yes" if self.boolean else "no"]
        if self.kind is not QueryKind.SELECT:
            return [" ".join(_readable(term, quoted=True) for term in triple) + " ." for triple in self.triples]
        cells = [[_readable(term) for term in row] for row in self.printed()]
        widths = [min(MAX_PADDED, max(map(len, column))) for column in zip(self.variables, *cells, strict=True)]
        lines = [self.variables, ["-" * width for width in widths], *cells]
        return [
            "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines
        ]

    @checks_arguments
    def to_json(self, indent: int | None = 2) -> str:
        """Return SPARQL 1.1 results as JSON; for a graph, its triples in N-Triples.

        Parameters
        ----------
        indent
            Number of spaces for each level; None gives one line.

        Returns
        -------
        str
            The text.
        """
        text = "".join(self.json_parts())
        return text if indent == 2 else json.dumps(json.loads(text), indent=indent, ensure_ascii=False)

    def json_parts(self) -> Iterator[str]:
        """Yield the text of :meth:`to_json` in parts, so that a large answer is not held twice.

        Yields
        ------
        str
            A part of the text: the head, a row, or the end.
        """
        notes = f',\n  "notes": {_indented(list(self.notes), 2)}' if self.notes else ""
        if self.kind is QueryKind.ASK:
            yield f'{{\n  "head": {{}},\n  "boolean": {json.dumps(self.boolean)}{notes}\n}}'
        elif self.kind is QueryKind.SELECT:
            head = _indented({"vars": list(self.variables)}, 2)
            yield f'{{\n  "head": {head},\n  "results": {{\n    "bindings": '
            yield from _json_list((_binding(self.variables, row) for row in self.printed()), 6)
            yield f"\n  }}{notes}\n}}"
        else:
            yield '{\n  "triples": '
            yield from _json_list((f"{triple} ." for triple in self.triples), 4)
            yield f"{notes}\n}}"

    def to_csv(self) -> str:
        """Return SPARQL 1.1 results as CSV.

        A cell that a spreadsheet would run as a formula begins with ``'``; numbers stay as they are.

        Returns
        -------
        str
            The text, with a header line of variables.

        Raises
        ------
        QueryError
            If the answer has no rows.
        """
        if self.kind is not QueryKind.SELECT:
            raise QueryError(f"the answer of {self.kind.upper()} has no rows to write as CSV; use SELECT")
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\r\n")
        writer.writerow(self.variables)
        writer.writerows([[_csv_term(term) for term in row] for row in self.printed()])
        return out.getvalue()

    def to_turtle(self) -> str:
        """Return the triples in Turtle.

        Returns
        -------
        str
            The text, with the prefixes that it uses.

        Raises
        ------
        QueryError
            If the answer has no triples.
        """
        if self.kind not in (QueryKind.CONSTRUCT, QueryKind.DESCRIBE):
            raise QueryError(
                f"the answer of {self.kind.upper()} has no triples to write as Turtle; use CONSTRUCT or DESCRIBE"
            )
        triples = with_blank_nodes(self.triples)
        return (ox.serialize(triples, format=ox.RdfFormat.TURTLE, prefixes=PREFIXES) or b"").decode("utf-8")


def solutions(variables: Sequence[str], rows: Sequence[Sequence[Term | None]]) -> dict[str, Any]:
    """Return rows as SPARQL 1.1 results in JSON.

    Parameters
    ----------
    variables
        Names of the variables.
    rows
        Terms of each row; None is a variable without a value.

    Returns
    -------
    dict
        Parsed JSON.
    """
    bindings = [_binding(variables, row) for row in rows]
    return {"head": {"vars": list(variables)}, "results": {"bindings": bindings}}


def rows_within(answer: ox.QuerySolutions, limits: QueryLimits) -> Iterator[tuple[Term | None, ...]]:
    """Yield rows within the limit of an answer.

    The text of an answer is limited where it is written, but rows without values have nearly no text.

    Parameters
    ----------
    answer
        The rows.
    limits
        Limits of time and memory.

    Yields
    ------
    tuple of Term or None
        Terms of a row.

    Raises
    ------
    QueryMemoryError
        If the rows exceed the limit.
    """
    left, row_bytes = limits.answer, ROW_BYTES + CELL_BYTES * len(answer.variables)
    for row in answer:
        left -= row_bytes
        if left < 0:
            raise limits.too_large()
        yield tuple(row)


def _binding(variables: Sequence[str], row: Sequence[Term | None]) -> dict[str, Any]:
    return {name: _json_term(term) for name, term in zip(variables, row, strict=True) if term is not None}


def _json_list(items: Iterator[Any], indent: int) -> Iterator[str]:
    """Yield the text of a list in parts, indented as ``json.dumps`` with an indent of 2 does."""
    space = "\n" + " " * indent
    before = "["
    for item in items:
        yield f"{before}{space}{_indented(item, indent)}"
        before = ","
    yield "[]" if before == "[" else space[:-2] + "]"


def _indented(item: Any, indent: int) -> str:
    return json.dumps(item, indent=2, ensure_ascii=False).replace("\n", "\n" + " " * indent)


def _row_key(row: Sequence[Term | None]) -> tuple[str, ...]:
    return tuple("" if term is None else str(term) for term in row)


def _readable(term: Term | None, quoted: bool = False) -> str:
    if term is None:
        return ""
    if isinstance(term, ox.NamedNode):
        return visible_line(short(term.value))
    if isinstance(term, ox.Literal):
        text = visible_line(term.value)
        return json.dumps(text, ensure_ascii=False) if quoted and term.datatype.value == _STRING else text
    return visible_line(str(term))


def _csv_term(term: Term | None) -> str:
    if term is None:
        return ""
    text = term.value if isinstance(term, ox.NamedNode | ox.Literal) else str(term)
    return f"'{text}" if _FORMULA.match(text) and not _NUMBER.fullmatch(text) else text


def _json_term(term: Term) -> dict[str, Any]:
    if isinstance(term, ox.NamedNode):
        return {"type": "uri", "value": term.value}
    if isinstance(term, ox.BlankNode):
        return {"type": "bnode", "value": term.value}
    if isinstance(term, ox.Triple):
        parts = zip(("subject", "predicate", "object"), term, strict=True)
        return {"type": "triple", "value": {name: _json_term(part) for name, part in parts}}
    value: dict[str, Any] = {"type": "literal", "value": term.value}
    if term.language:
        value["xml:lang"] = term.language
        if term.direction is not None:
            value["its:dir"] = term.direction.value
    elif term.datatype.value != _STRING:
        value["datatype"] = term.datatype.value
    return value
