"""Read qualitative calculi from the three text files of GQR (Gantner, Westphal and Wölfl 2008).

A user names the specification, which names the other two files:

    comp_table_file rcc5/rcc5.comp
    converse_file rcc5/rcc5.conv
    identity EQ
    calculus_size 5

The converse file has a line ``PP :: PPI`` for each atom, and the composition file a line ``PO : PP :: ( PO PP )`` for
each pair of atoms. Empty lines, lines that begin with ``#``, and other keys of the specification, such as GQR's
``weights``, are ignored.

These files do not say whether closure decides consistency. The key ``closure_decides``, which GQR ignores, does:
``closure_decides atoms`` states that closed networks of atoms are consistent, and ``closure_decides FILE`` that closed
networks of the relations in the file are. The file has one relation per line, ``( PO PP )``, as in GQR's files of
subclasses.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, Diagnostic, shortened
from deixis.grammar.files import read_text
from deixis.ontology.graph.graph import Source
from deixis.reasoning.errors import CalculusError
from deixis.reasoning.qualitative.calculi.calculus import MAX_TABLE_ATOMS, Calculus, Subclass, TableCalculus
from deixis.reasoning.qualitative.calculi.laws import Violation, lawful
from deixis.reasoning.qualitative.calculi.registry import with_same_tables
from deixis.reasoning.qualitative.calculi.words import words_with
from deixis.spelling import nearest

MAX_SUBCLASS_ATOMS = 16  # maximum number of atoms of a calculus whose tractable relations are listed
KEYS = ("comp_table_file", "converse_file", "identity", "calculus_size")
DECIDES = "closure_decides"
CONVERSE = re.compile(r"\s*(\S+)\s*::\s*(\S+)\s*$")
COMPOSITION = re.compile(r"\s*([^\s:]+)\s*:\s*([^\s:]+)\s*::\s*\(([^()]*)\)\s*$")
RELATION = re.compile(r"\s*\(([^()]*)\)\s*$")


class CalculusFileError(DeixisError, ValueError):
    """Files of a calculus with errors; ``problems`` holds the first of them, in order."""

    def __init__(self, problems: tuple[Diagnostic, ...]) -> None:
        super().__init__(problems)
        self.problems = problems

    def __str__(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)


@dataclass(frozen=True)
class CalculusText:
    """A calculus that was read, and notes on it for the user, such as laws that its tables break."""

    calculus: Calculus
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Line:
    file: str
    number: int
    text: str

    def problem(self, message: str, part: str = "", hint: str | None = None) -> Diagnostic:
        """Return a diagnostic for a part of the line, or for the whole line."""
        start = self.text.find(part) if part else len(self.text) - len(self.text.lstrip())
        end = start + len(part) if part else len(self.text.rstrip())
        return Diagnostic(Source(self.file, self.number, start + 1, self.number, end + 1), message, self.text, hint)

    def refuse(self, message: str, part: str = "", hint: str | None = None) -> CalculusFileError:
        return CalculusFileError((self.problem(message, part, hint),))


def read_calculus(path: str | Path) -> CalculusText:
    """Read a calculus from its specification, or from a folder that holds one.

    Parameters
    ----------
    path : str or Path
        A file whose name ends in ``.spec``, or a folder with one such file.

    Returns
    -------
    CalculusText
        The calculus, named after the file. If a calculus of :mod:`deixis.reasoning.qualitative.calculi.registry` has
        the same atoms and tables, that calculus is returned, with its tractable subclasses.

    Raises
    ------
    CalculusFileError
        If the files do not describe a calculus, with the file, line and column of each error.
    ScriptFileError
        If a file cannot be read.
    """
    path = Path(path)
    if path.is_dir():
        found = sorted(path.glob("*.spec"))
        if len(found) != 1:
            names = ", ".join(each.name for each in found[:8])
            raise DeixisError(
                f"{path}: name one of the specifications in this folder ({names or 'it has no specification'})"
            )
        path = found[0]
    lines = _lines(path)
    entries = _specification(path, lines)
    atoms, converses = _converses(_beside(path, entries["converse_file"]), entries["calculus_size"])
    identity_line, identity_name = entries["identity"]
    if identity_name not in atoms:
        raise identity_line.refuse(f"'{shortened(identity_name)}' is not an atom of the converse file", identity_name)
    composition_path = _beside(path, entries["comp_table_file"])
    composition = _compositions(composition_path, atoms)
    identity = atoms[identity_name]
    try:
        table, violations = lawful(converses, composition, identity)
    except CalculusError as error:
        name = list(atoms)[error.atom]
        line = next(line for line in _lines(_beside(path, entries["converse_file"])) if line.text.split()[0] == name)
        raise line.refuse(str(error), name) from None
    brought = TableCalculus(
        path.stem, tuple(atoms), converses, table, identity, decided_by_closure=False, source=str(path)
    )
    notes = [_note(each, brought, str(composition_path)) for each in violations]
    known = with_same_tables(brought)
    if known is not None:
        return CalculusText(known, (*notes, f"{path.name} is the calculus {known.name}"))
    if DECIDES in entries:
        line, value = entries[DECIDES]
        tractable = None if value == "atoms" else _subclass(_beside(path, entries[DECIDES]), brought)
        brought = replace(brought, tractable=tractable, decided_by_closure=True)
    return CalculusText(brought, tuple(notes))


def _lines(path: Path) -> list[_Line]:
    """Return the lines that are neither empty nor comments; comments may be in any encoding."""
    text = read_text(path, str(path), undecoded="replace").removeprefix("\ufeff")
    numbered = (_Line(str(path), number, line) for number, line in enumerate(text.splitlines(), start=1))
    return [line for line in numbered if line.text.strip() and not line.text.lstrip().startswith("#")]


def _beside(specification: Path, entry: tuple[_Line, str]) -> Path:
    """Return the path of a file that the specification names."""
    line, name = entry
    try:
        path = specification.parent / name
        there = path.is_file()
    except (OSError, ValueError):
        there = False
    if not there:
        raise line.refuse(f"there is no file '{shortened(name)}' beside the specification", name)
    return path


def _specification(path: Path, lines: list[_Line]) -> dict[str, tuple[_Line, str]]:
    entries: dict[str, tuple[_Line, str]] = {}
    for line in lines:
        key, value = [*line.text.split(maxsplit=1), ""][:2]
        if key in entries:
            raise line.refuse(f"'{shortened(key)}' is given twice", key)
        entries[key] = line, value.strip()
    for key in KEYS:
        if not entries.get(key, (None, ""))[1]:
            hint = nearest(key, [other for other in entries if other not in KEYS])
            last = lines[-1] if lines else _Line(str(path), 1, "")
            advice = f"is '{hint}' a misspelling of it?" if hint else f"a specification has {', '.join(KEYS)}"
            raise last.refuse(f"the specification ends without '{key}'", hint=advice)
    line, size = entries["calculus_size"]
    if not size.isdecimal() or not size.isascii() or not 1 <= len(size) <= 6 or int(size) < 1:
        raise line.refuse(f"calculus_size must be a number of atoms, got '{shortened(size)}'", size)
    if int(size) > MAX_TABLE_ATOMS:
        raise line.refuse(f"calculus_size must be at most {MAX_TABLE_ATOMS}, got {int(size)}", size)
    return entries


def _converses(path: Path, size: tuple[_Line, str]) -> tuple[dict[str, int], NDArray[np.int64]]:
    lines, problems = _lines(path), []
    stated: dict[str, tuple[str, _Line]] = {}
    for line in lines:
        match = CONVERSE.match(line.text)
        if match is None:
            problems.append(line.problem("expected an atom and its converse", hint="write them as in 'PP :: PPI'"))
        elif match[1] in stated:
            problems.append(line.problem(f"the converse of '{shortened(match[1])}' is stated twice", match[1]))
        else:
            stated[match[1]] = match[2], line
        _stop(problems)
    for other, line in stated.values():
        if other not in stated:
            problems.append(line.problem(f"no line states the converse of '{shortened(other)}'", other))
            _stop(problems)
    if problems:
        raise CalculusFileError(tuple(problems))
    if len(stated) != int(size[1]):
        raise size[0].refuse(f"calculus_size is {int(size[1])}, but {path.name} has {len(stated)} atoms", size[1])
    atoms = {atom: code for code, atom in enumerate(stated)}
    return atoms, np.array([atoms[other] for other, _ in stated.values()], dtype=np.int64)


def _compositions(path: Path, atoms: dict[str, int]) -> NDArray[np.uint64]:
    lines, problems, size = _lines(path), [], len(atoms)
    table = np.zeros((size, size, size), dtype=np.bool_)
    stated = np.zeros((size, size), dtype=np.bool_)
    for line in lines:
        match = COMPOSITION.match(line.text)
        if match is None:
            hint = "write two atoms and their composition, as in 'PO : PP :: ( PO PP )'"
            problems.append(line.problem("expected a composition", hint=hint))
        else:
            names = [match[1], match[2], *match[3].split()]
            unknown = [name for name in names if name not in atoms]
            if unknown:
                problems.append(_unknown(line, unknown[0], atoms))
            elif stated[atoms[match[1]], atoms[match[2]]]:
                problems.append(line.problem("the composition of these two atoms is stated twice"))
            else:
                place = atoms[match[1]], atoms[match[2]]
                stated[place] = True
                table[*place, [atoms[name] for name in names[2:]]] = True
        _stop(problems)
    if not problems and not stated.all():
        first, second = np.argwhere(~stated)[0]
        names = list(atoms)
        pair = f"{shortened(names[first])} and {shortened(names[second])}"
        missing = f"{int((~stated).sum())} compositions are missing; the first is that of {pair}"
        problems.append((lines[-1] if lines else _Line(str(path), 1, "")).problem(missing))
    if problems:
        raise CalculusFileError(tuple(problems))
    words = words_with(table)
    return words[:, :, 0] if size <= 64 else words


def _unknown(line: _Line, name: str, atoms: dict[str, int]) -> Diagnostic:
    near = nearest(name, atoms)
    hint = f"did you mean '{near}'?" if near else None
    return line.problem(f"'{shortened(name)}' is not an atom of the converse file", name, hint)


def _stop(problems: list[Diagnostic]) -> None:
    """Raise CalculusFileError when as many problems were found as are shown."""
    if len(problems) >= MAX_PROBLEMS_SHOWN:
        raise CalculusFileError(tuple(problems))


def _subclass(path: Path, calculus: TableCalculus) -> Subclass:
    """Return the relations of a file; they must include all atoms, and be closed under converse and intersection."""
    lines, atoms = _lines(path), {atom: code for code, atom in enumerate(calculus.atoms)}
    first = lines[0] if lines else _Line(str(path), 1, "")
    if len(atoms) > MAX_SUBCLASS_ATOMS:
        raise first.refuse(
            f"a calculus with listed relations must have at most {MAX_SUBCLASS_ATOMS} atoms, got {len(atoms)}"
        )
    members, problems = {0, calculus.universal}, []
    for line in lines:
        match = RELATION.match(line.text)
        names = match[1].split() if match else []
        unknown = [name for name in names if name not in atoms]
        if match is None:
            problems.append(line.problem("expected a relation", hint="write it as in '( PO PP )'"))
        elif unknown:
            problems.append(_unknown(line, unknown[0], atoms))
        else:
            members.add(sum(1 << code for code in {atoms[name] for name in names}))
        _stop(problems)
    if problems:
        raise CalculusFileError(tuple(problems))
    for relation in sorted(members):
        if calculus.converse(relation) not in members:
            raise first.refuse(f"the converse of {_shown(calculus, relation)} is missing from the relations")
    for code, atom in enumerate(calculus.atoms):
        if 1 << code not in members:
            raise first.refuse(f"the atom {atom} is missing from the relations")
    array = np.array(sorted(members), dtype=np.int64)
    is_member = np.zeros(1 << len(atoms), dtype=np.bool_)
    is_member[array] = True
    for relation in array.tolist():
        lost = array[~is_member[array & relation]]
        if len(lost):
            pair = f"{_shown(calculus, relation)} and {_shown(calculus, int(lost[0]))}"
            raise first.refuse(f"the intersection of {pair} is missing from the relations")
    return Subclass(path.name, len(atoms), members.__contains__, str(path))


def _shown(calculus: Calculus, relation: int) -> str:
    return f"( {' '.join(calculus.members(relation))} )"


def _note(violation: Violation, calculus: TableCalculus, file: str) -> str:
    first, second = (calculus.atoms[code] for code in violation.first)
    entries = f"{violation.entries:,} of {len(calculus.atoms) ** 2:,} entries"
    if violation.law == "identity":
        return f"{file}: {calculus.atoms[calculus.identity]} is not neutral in composition, first in {first} : {second}"
    mended = "atoms that only some orders of the three objects allow were removed"
    return f"{file}: {entries} break the law '{violation.law}', first {first} : {second}; {mended}"
