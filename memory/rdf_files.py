"""RDF files from outside, read without trust: by their ending, up to a size, without any DTD, from a fixed base.

Nothing that a file names is fetched: ``owl:imports`` is a triple like any other.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

import pyoxigraph as ox

from deixis.memory.errors import ImportFormatError

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
    """The statements of a file. Raises ImportFormatError, with the place where it is malformed."""
    format = FORMATS.get(file.suffix.lower())
    if format is None:
        raise ImportFormatError(f"{file}: of no known format; it must end in {', '.join(FORMATS)}; views in .zip")
    content = _bytes(file)
    text = _xml(file, content) if format is ox.RdfFormat.RDF_XML else content
    try:
        yield from ox.parse(input=text, format=format, base_iri=_BASE + quote(file.stem, safe="") + "/")
    except SyntaxError as error:
        place = f"{error.lineno}:{error.offset}: " if error.lineno else ""
        raise ImportFormatError(f"{file}:{place or ' '}{' '.join(str(error.msg).split())}") from None
    except (OSError, ValueError) as error:
        raise ImportFormatError(f"{file}: {error}") from error


def _bytes(file: Path) -> bytes:
    if not file.is_file():
        raise ImportFormatError(f"{file}: there is no such file")
    size = file.stat().st_size
    if size > MAX_BYTES:
        raise ImportFormatError(f"{file}: {size} bytes are too many; at most {MAX_BYTES} are read, so split the file")
    try:
        return file.read_bytes()
    except OSError as error:
        raise ImportFormatError(f"{file}: cannot be read: {error.strerror}") from error


def _xml(file: Path, content: bytes) -> str:
    """XML as text, in whatever encoding; refused where it has a DTD or is in an encoding that could hide one."""
    text = _decoded(file, content)
    found = _DTD.search(text)
    if found:
        line = text.count("\n", 0, found.start()) + 1
        column = found.start() - text.rfind("\n", 0, found.start())
        raise ImportFormatError(
            f"{file}:{line}:{column}: a DTD (<!{found.group(1)}) is refused; take it out of the file"
        )
    return text


def _decoded(file: Path, content: bytes) -> str:
    start = next(((len(bom), name) for bom, name in _BOMS if content.startswith(bom)), None)
    start = start or next(((0, name) for bare, name in _BARE if content.startswith(bare)), (0, "utf-8"))
    try:
        text = content[start[0] :].decode(start[1])
    except UnicodeDecodeError as error:
        raise ImportFormatError(f"{file}: is not {start[1].upper()} at byte {error.start}; save it as UTF-8") from None
    declaration = _DECLARATION.match(text)
    named = _ENCODING.search(declaration.group()) if declaration else None
    if named and named.group(1).lower() not in ("utf-8", "us-ascii", start[1], start[1][:6]):
        raise ImportFormatError(f"{file}: the encoding '{named.group(1)}' is not read; save it as UTF-8")
    # the text is handed on as UTF-8, whatever it was: its declaration goes, and lines stay where they are
    return (
        text[: declaration.start()] + "\n" * declaration.group().count("\n") + text[declaration.end() :]
        if declaration
        else text
    )
