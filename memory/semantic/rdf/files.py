"""RDF files: read with checks, and written as sorted Turtle and TriG; the prefixes of both.

>>> import pyoxigraph as ox
>>> print(turtle([ox.Triple(ox.NamedNode("urn:a"), ox.NamedNode("urn:p"), ox.Literal("x"))]).splitlines()[-2:])
['<urn:a>', '    <urn:p> "x" .']

Nothing that a file refers to is fetched: ``owl:imports`` is a triple like any other.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import groupby
from pathlib import Path
from urllib.parse import quote

import pyoxigraph as ox

from deixis.memory.errors import ImportFormatError
from deixis.memory.semantic.rdf.graphs import GRAPHS
from deixis.ontology.rdf.triples import LEARNED, with_blank
from deixis.ontology.rdf.vocabulary import BASE, W3C

PREFIXES = {
    "dcterms": "http://purl.org/dc/terms/",
    "dx": BASE,
    "dxg": GRAPHS,
    "ep": "https://w3id.org/deixis/episodes#",
    "lx": LEARNED,
    "owl": "http://www.w3.org/2002/07/owl#",
    "prov": "http://www.w3.org/ns/prov#",
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "sh": "http://www.w3.org/ns/shacl#",
    "sosa": "http://www.w3.org/ns/sosa/",
    "skos": "http://www.w3.org/2004/02/skos/core#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}

_SAFE_LOCAL = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")


def short(iri: str) -> str:
    """Return an IRI for messages: with a prefix where there is a known one, else in angle brackets.

    Parameters
    ----------
    iri
        IRI.

    Returns
    -------
    str
        Prefix and the rest, which need not be valid Turtle.

    Examples
    --------
    >>> short("https://w3id.org/deixis/learned/layout/dinner-1")
    'lx:layout/dinner-1'
    """
    for prefix, base in PREFIXES.items():
        if iri.startswith(base):
            return f"{prefix}:{iri.removeprefix(base)}"
    return f"<{iri}>"


def turtle_name(iri: str) -> str:
    """Return an IRI in Turtle: with a prefix where the rest is a plain name, else in angle brackets.

    Parameters
    ----------
    iri
        IRI.

    Returns
    -------
    str
        Valid Turtle.

    Examples
    --------
    >>> turtle_name("https://w3id.org/deixis/learned/layout/dinner-1")
    '<https://w3id.org/deixis/learned/layout/dinner-1>'
    """
    for prefix, base in PREFIXES.items():
        if iri.startswith(base) and _SAFE_LOCAL.fullmatch(iri, len(base)):
            return f"{prefix}:{iri.removeprefix(base)}"
    return f"<{iri}>"


_STRINGS = {PREFIXES["xsd"] + "string", PREFIXES["rdf"] + "langString", PREFIXES["rdf"] + "dirLangString"}


def turtle(triples: Iterable[ox.Triple]) -> str:
    """Return a Turtle document; named blank nodes become blank nodes again.

    Parameters
    ----------
    triples
        Triples in any order.

    Returns
    -------
    str
        Document with its prefixes.
    """
    return "\n".join([*_prefixes(), "", *_statements(triples, "")]) + "\n"


def trig(graphs: Iterable[tuple[ox.NamedNode, Iterable[ox.Triple]]]) -> str:
    """Return a TriG document of named graphs, in the order given; empty ones are left out.

    Parameters
    ----------
    graphs
        Pairs of a graph and its triples.

    Returns
    -------
    str
        Document with its prefixes.
    """
    lines = [*_prefixes()]
    for graph, triples in graphs:
        statements = list(_statements(triples, "    "))
        if statements:
            lines += ["", f"{turtle_name(graph.value)} {{", *statements, "}"]
    return "\n".join(lines) + "\n"


def _prefixes() -> Iterator[str]:
    for prefix, base in PREFIXES.items():
        yield f"@prefix {prefix}: <{base}> ."


def _statements(triples: Iterable[ox.Triple], indent: str) -> Iterator[str]:
    subject, predicate, term = cache(_subject), cache(_predicate), cache(_term)  # most terms occur in many triples
    rows = sorted({(subject(t.subject), predicate(t.predicate), term(t.object)) for t in triples})
    for (_, name), about in groupby(rows, key=lambda row: row[0]):
        statements = [f"{verb} {obj}" for _, (_, verb), obj in about]
        yield indent + name
        for line in statements[:-1]:
            yield f"{indent}    {line} ;"
        yield f"{indent}    {statements[-1]} ."


def _subject(term: ox.NamedNode | ox.BlankNode) -> tuple[bool, str]:
    """Return the sort key and the text of a subject; named ones come first."""
    return isinstance(with_blank(term), ox.BlankNode), _term(term)


def _predicate(term: ox.NamedNode) -> tuple[bool, str]:
    """Return the sort key and the text of a predicate; the type comes first."""
    return (False, "a") if term.value == W3C.RDF_TYPE else (True, turtle_name(term.value))


def _term(term: ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple) -> str:
    term = with_blank(term)
    if isinstance(term, ox.NamedNode):
        return turtle_name(term.value)
    if isinstance(term, ox.Literal) and term.datatype.value not in _STRINGS:
        return f"{ox.Literal(term.value)}^^{turtle_name(term.datatype.value)}"
    return str(term)


MAX_BYTES = 2**30

FORMATS = {
    ".trig": ox.RdfFormat.TRIG,
    ".nq": ox.RdfFormat.N_QUADS,
    ".ttl": ox.RdfFormat.TURTLE,
    ".nt": ox.RdfFormat.N_TRIPLES,
    ".rdf": ox.RdfFormat.RDF_XML,
    ".owl": ox.RdfFormat.RDF_XML,
    ".xml": ox.RdfFormat.RDF_XML,
}

_BASE = "https://w3id.org/deixis/imported/"
_DTD = re.compile(r"<!\s*(DOCTYPE|ENTITY|ELEMENT|ATTLIST|NOTATION)", re.IGNORECASE)
_DECLARATION = re.compile(r"\s*<\?xml\b[^>]*?\?>")
_ENCODING = re.compile(r"encoding\s*=\s*[\"']([^\"']*)[\"']")
_BOMS = (
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_BARE = ((b"<\0\0\0", "utf-32-le"), (b"\0\0\0<", "utf-32-be"), (b"<\0", "utf-16-le"), (b"\0<", "utf-16-be"))


def read_quads(file: Path) -> Iterator[ox.Quad]:
    """Yield the statements of a file.

    Parameters
    ----------
    file
        File whose ending names its format.

    Yields
    ------
    Quad
        Statements in the order of the file.

    Raises
    ------
    ImportFormatError
        If the file is missing, too large or malformed; the message has the place.
    """
    file_format = FORMATS.get(file.suffix.lower())
    if file_format is None:
        raise ImportFormatError(f"{file}: unknown format; its name must end in {', '.join(FORMATS)}")
    if not file.is_file():
        raise ImportFormatError(f"{file}: there is no such file")
    size = file.stat().st_size
    if size > MAX_BYTES:
        raise ImportFormatError(f"{file}: the file must have at most {MAX_BYTES} bytes, got {size}; split it")
    try:
        content = file.read_bytes()
    except OSError as error:
        raise ImportFormatError(f"{file}: cannot be read: {error.strerror}") from error
    text = _xml(file, content) if file_format is ox.RdfFormat.RDF_XML else content
    try:
        yield from ox.parse(input=text, format=file_format, base_iri=_BASE + quote(file.stem, safe="") + "/")
    except SyntaxError as error:
        place = f"{error.lineno}:{error.offset}: " if error.lineno else ""
        raise ImportFormatError(f"{file}:{place or ' '}{' '.join(str(error.msg).split())}") from None
    except MemoryError as error:  # Oxigraph raises it for a name or a text that is larger than its buffer
        raise ImportFormatError(f"{file}: a name or a text in it is too long to be read; shorten it") from error
    except (OSError, ValueError) as error:
        raise ImportFormatError(f"{file}: {error}") from error


def _xml(file: Path, content: bytes) -> str:
    """Return XML as text, from any encoding; refuse it where it has a DTD, or an encoding that could hide one."""
    start = next(((len(bom), name) for bom, name in _BOMS if content.startswith(bom)), None)
    start = start or next(((0, name) for bare, name in _BARE if content.startswith(bare)), (0, "utf-8"))
    try:
        text = content[start[0] :].decode(start[1])
    except UnicodeDecodeError as error:
        raise ImportFormatError(f"{file}: invalid {start[1].upper()} at byte {error.start}; save it as UTF-8") from None
    declaration = _DECLARATION.match(text)
    named = _ENCODING.search(declaration.group()) if declaration else None
    if named and named.group(1).lower() not in ("utf-8", "us-ascii", start[1], start[1][:6]):
        raise ImportFormatError(f"{file}: the encoding '{named.group(1)}' is not supported; save it as UTF-8")
    if declaration:
        # the text is returned as UTF-8: its declaration is removed, and line numbers stay
        text = text[: declaration.start()] + "\n" * declaration.group().count("\n") + text[declaration.end() :]
    found = _DTD.search(text)
    if found:
        line = text.count("\n", 0, found.start()) + 1
        column = found.start() - text.rfind("\n", 0, found.start())
        raise ImportFormatError(
            f"{file}:{line}:{column}: a DTD (<!{found.group(1)}) is refused; take it out of the file"
        )
    return text
