"""Read and write constraint networks in the text format of GQR (Gantner, Westphal and Wölfl 2008).

    3 # the largest index, and a comment
    0 1 ( < m )
    1 3 ( = )
    .

A file may hold several networks; a line with a dot ends each. Empty lines, and lines that begin with ``#``, are
ignored. Atoms of a product calculus are written ``<,m`` or ``(<,m)``. In a file over several calculi every line names
its calculus: ``0 1 ( rcc8:EC rcc8:DC )``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from deixis.errors import DeixisError
from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, Diagnostic, ScriptFileError, shortened
from deixis.grammar.files import read_text
from deixis.ontology.graph.facts import Source
from deixis.reasoning.errors import NetworkError, UnknownAtomError
from deixis.reasoning.qualitative.calculi.calculus import Calculus, bits
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.text_files import is_folder

MAX_INDEX_DIGITS = 15  # maximum number of digits of an index
HEADER = re.compile(r"\s*(\d+)\s*(?:#\s*(.*?)|(\S.*?)?)\s*$")
LINE = re.compile(r"\s*(\d+)\s+(\d+)\s*\((.*?)\)\s*(?:#.*)?$")
ATOM = re.compile(r"[^\s()]*\([^()]*\)|[^\s()]+")


class NetworkFileError(DeixisError, ValueError):
    """A network file with errors; ``problems`` holds the first of them, in order."""

    several_lines = True

    def __init__(self, problems: tuple[Diagnostic, ...]) -> None:
        super().__init__(problems)
        self.problems = problems

    def _message(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)


@dataclass(frozen=True, eq=False)
class NetworkText:
    """One network of a file: a network per calculus, all over the same things."""

    networks: tuple[Network, ...]
    comment: str
    line: int

    @property
    def network(self) -> Network:
        """The network of a file over one calculus."""
        return self.networks[0]


def read_networks(path: str | Path, calculi: Sequence[Calculus]) -> tuple[NetworkText, ...]:
    """Read the networks of a file.

    Parameters
    ----------
    path
        The file, in UTF-8.
    calculi
        Calculi that the constraints are over; if there are several, each line names its own.

    Returns
    -------
    The networks in order, each with its comment and the line of its header.

    Raises
    ------
    NetworkFileError
        If the file has errors, with the line and column of each.
    ScriptFileError
        If the file cannot be read.
    """
    if is_folder(path):
        raise ScriptFileError(f"{path}: this is a folder, not a network file")
    return parse_networks(read_text(Path(path), str(path)), calculi, str(path))


def parse_networks(text: str, calculi: Sequence[Calculus], file: str = "<text>") -> tuple[NetworkText, ...]:
    r"""Return the networks in a text.

    Parameters
    ----------
    text
        The text.
    calculi
        Calculi of its relations.
    file
        Its name in messages.

    Returns
    -------
    tuple of NetworkText
        The networks, each with its comment and line.

    Raises
    ------
    NetworkFileError
        If the text has errors; the message names the line and column of each.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> point = calculus("point")
    >>> found = parse_networks("2 # three things\n0 1 ( < )\n1 2 (< =)\n.", [point])
    >>> found[0].comment, [(c.first, c.second, point.members(c.relation)) for c in found[0].network.constraints]
    ('three things', [(0, 1, ('<',)), (1, 2, ('<', '='))])
    """
    return tuple(_Reader(text, calculi, file).networks())


class _Reader:
    def __init__(self, text: str, calculi: Sequence[Calculus], file: str) -> None:
        self._lines = text.removeprefix("\ufeff").splitlines()
        self._calculi = {calculus.name: calculus for calculus in calculi}
        self._file = file
        self._problems: list[Diagnostic] = []
        self._known: dict[str, tuple[str, int]] = {}

    def networks(self) -> list[NetworkText]:
        found, header = [], None
        constraints: dict[str, list[Constraint]] = {}
        for number, line in enumerate(self._lines, start=1):
            if not line.strip() or line.startswith("#"):
                continue
            if header is None:
                match = HEADER.match(line)
                if match is None or len(match[1]) > MAX_INDEX_DIGITS:
                    hint = "a network begins with its largest index and a comment, as in '9 # ten things'"
                    self._wrong(number, line, 0, len(line), "expected the largest index", hint)
                    header = number, 10**MAX_INDEX_DIGITS, ""
                else:
                    header = number, int(match[1]), match[2] or match[3] or ""
                constraints = {name: [] for name in self._calculi}
            elif line.startswith("."):
                found.append(self._network(header, constraints))
                header = None
            else:
                self._constraint(number, line, header[1], constraints)
            if len(self._problems) >= MAX_PROBLEMS_SHOWN:
                break
        if header is not None and len(self._problems) < MAX_PROBLEMS_SHOWN:
            self._unended(header[0])
        if not found and not self._problems:
            self._wrong(
                1, "", 0, 0, "there is no network here", "the first line is the largest index, as in '9 # ten things'"
            )
        if self._problems:
            raise NetworkFileError(tuple(self._problems))
        return found

    def _network(self, header: tuple[int, int, str], constraints: dict[str, list[Constraint]]) -> NetworkText:
        number, largest, comment = header
        if self._problems:
            return NetworkText((), comment, number)
        networks = (Network(self._calculi[name], largest + 1, tuple(stated)) for name, stated in constraints.items())
        return NetworkText(tuple(networks), comment, number)

    def _constraint(self, number: int, line: str, largest: int, constraints: dict[str, list[Constraint]]) -> None:
        match = LINE.match(line)
        if match is None:
            hint = "a constraint is two indices and relations in parentheses, as in '0 1 ( < m )'; a dot ends a network"
            start = len(line) - len(line.lstrip())
            self._wrong(number, line, start, len(line), "expected a constraint", hint)
            return
        outside = [group for group in (1, 2) if len(match[group]) > MAX_INDEX_DIGITS or int(match[group]) > largest]
        for group in outside:
            message = f"an index must be at most {largest}, the largest of this network, got {shortened(match[group])}"
            self._wrong(number, line, match.start(group), match.end(group), message)
        relation = self._known.get(match[3]) or self._relation(number, line, match)
        if relation is not None and not outside:
            source = Source(self._file, number, match.start(1) + 1, number, len(line) + 1)
            constraints[relation[0]].append(Constraint(int(match[1]), int(match[2]), relation[1], source))

    def _unended(self, header: int) -> None:
        """Report a network without its dot: the file may have been cut off."""
        number = max(k for k, line in enumerate(self._lines, start=1) if line.strip())
        line = self._lines[number - 1]
        message = f"the file ends here, but the network of line {header} has not ended"
        hint = "a line with a dot ends a network: add it if the file is complete, or else restore the missing lines"
        self._wrong(number, line, 0, len(line), message, hint)

    def _relation(self, number: int, line: str, match: re.Match[str]) -> tuple[str, int] | None:
        """Return the name of the calculus, and the relation in it."""
        stray = re.search(r"[()]", ATOM.sub(lambda atom: " " * len(atom[0]), match[3]))
        if stray is not None:
            start, hint = match.start(3) + stray.start(), "write one pair of parentheses, as in '0 1 ( < m )'"
            self._wrong(number, line, start, start + 1, "a constraint has one list of relations", hint)
            return None
        names, mask, well = set(), 0, True
        for atom in ATOM.finditer(match[3]):
            start = match.start(3) + atom.start()
            name, sign = self._split(atom[0])
            if name is None:
                message = f"'{shortened(atom[0])}' does not name its calculus"
                self._wrong(number, line, start, start + len(atom[0]), message, f"write {next(iter(self._calculi))}:…")
                return None
            try:
                mask |= 1 << self._calculi[name].code(sign)
            except UnknownAtomError as error:
                self._wrong(number, line, start, start + len(atom[0]), str(error))
                well = False
            names.add(name)
        if len(names) > 1:
            message = "the atoms of one line must belong to one calculus"
            self._wrong(number, line, match.start(3), match.end(3), message)
        if len(names) > 1 or not well:
            return None
        if not names and len(self._calculi) > 1:
            self._wrong(number, line, match.start(3), match.end(3), "the empty relation does not name its calculus")
            return None
        self._known[match[3]] = names.pop() if names else next(iter(self._calculi)), mask
        return self._known[match[3]]

    def _split(self, atom: str) -> tuple[str | None, str]:
        """Return the name of an atom's calculus, or None if it is ambiguous, and the atom's sign there."""
        name, colon, sign = atom.partition(":")
        if colon and name in self._calculi:
            return name, sign
        return (next(iter(self._calculi)) if len(self._calculi) == 1 else None), atom

    def _wrong(self, number: int, line: str, start: int, end: int, message: str, hint: str | None = None) -> None:
        source = Source(self._file, number, start + 1, number, end + 1)
        self._problems.append(Diagnostic(source, message, line, hint))


def write_networks(networks: Iterable[tuple[Network, str]]) -> str:
    """Return networks with their comments as text.

    Parameters
    ----------
    networks
        Pairs of a network and its comment.

    Returns
    -------
    str
        The text; reading it gives the same networks.

    Raises
    ------
    NetworkError
        If a network has no things, which the format cannot express.
    """
    return "".join(f"{line}\n" for network, comment in networks for line in network_lines((network,), comment))


def network_lines(networks: Sequence[Network], comment: str = "") -> Iterator[str]:
    """Yield the lines of one network.

    Parameters
    ----------
    networks
        The network over each of its calculi; if these are several, every line names its own.
    comment
        Comment of the first line.

    Yields
    ------
    str
        A line without its end.

    Raises
    ------
    NetworkError
        If the network has no things.
    """
    size = networks[0].size
    if size < 1:
        raise NetworkError("a network must have at least one thing to be written, got none")
    yield f"{size - 1} # {' '.join(comment.split())}".rstrip()
    width = len(str(size - 1))
    for network in networks:
        known: dict[int, str] = {}
        for c in network.constraints:
            if c.relation not in known:
                prefix = f"{network.calculus.name}:" if (len(networks) > 1) else ""
                written = " ".join(["(", *(prefix + network.calculus.atoms[code] for code in bits(c.relation)), ")"])
                known[c.relation] = written
            yield f"{c.first:>{width}} {c.second:>{width}} {known[c.relation]}"
    yield "."
