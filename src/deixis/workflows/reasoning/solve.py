"""Solve the networks of a file, one by one: the verdict, its reasons, and what else was requested."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.grammar.formats.networks import NetworkText, parse_networks, read_networks
from deixis.reasoning.errors import require_time_limit
from deixis.reasoning.qualitative.calculi.bridges import Link, links_between
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.closure.state import Progress
from deixis.reasoning.qualitative.networks.combination import joint_conflict, solve_jointly
from deixis.reasoning.qualitative.networks.conflict import minimal_conflict
from deixis.reasoning.qualitative.networks.derivation import explain, require_pair
from deixis.reasoning.qualitative.networks.network import Constraint, Network, compacted
from deixis.reasoning.qualitative.networks.realisation.boxes import unrelated
from deixis.reasoning.qualitative.networks.search.consistency import Verdict
from deixis.reasoning.qualitative.networks.search.consistency import solve as solve_network
from deixis.reasoning.qualitative.relate import relate
from deixis.text_files import is_folder, require_path_or_text

if TYPE_CHECKING:
    from deixis.reasoning.qualitative.calculi.calculus import Calculus
    from deixis.reasoning.qualitative.networks.closure.rounds import Step
    from deixis.reasoning.qualitative.networks.combination import Contribution


@dataclass(frozen=True)
class SolveRequest:
    """Requests about each network besides the verdict.

    ``conflict`` asks for the reason of an inconsistency.
    """

    closure: bool = False
    scenario: bool = False
    explain: tuple[int, int] | None = None
    conflict: bool = True
    time_limit: float = 60.0


@dataclass(frozen=True, eq=False, repr=False)
class SolvedNetwork(Answer):
    r"""One network of a file, and what was found about it.

    ``seconds`` is the time that the verdict took. ``shown`` are the networks that were asked for, the closure or the
    scenario, one for each calculus. ``boxes`` satisfy everything that several calculi, or one with distances, say:
    minimum and maximum corner by thing, distances in units of the reference length.

    Examples
    --------
    >>> import deixis
    >>> (solved,) = deixis.solve(text="1\n0 1 ( < )\n.\n", calculus="point", scenario=True).networks
    >>> solved
    <SolvedNetwork consistent, 2 things>
    >>> solved.to_dict()["relations"][0]["relation"]
    ['<']
    """

    text: NetworkText
    verdict: Verdict
    reason: str
    narrowed: int
    seconds: float
    conflict: tuple[tuple[Network, Constraint], ...] = ()
    minimal: bool = True
    contributions: tuple[Contribution, ...] = ()
    shown: tuple[Network, ...] = ()
    boxes: Mapping[int, NDArray[np.float64]] = field(default_factory=dict)  # (2, 2)
    step: Step | None = None
    asked: tuple[int, int] | None = None
    explained: bool = True  # False where time ran out before it was clear why

    def summary(self) -> str:
        """Return the verdict and the number of things."""
        return f"{self.verdict}, {count(self.text.networks[0].size, 'thing')}"


@dataclass(frozen=True, eq=False, repr=False)
class Solved(Answer):
    r"""The networks of a file with their verdicts.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.solve(text="2\n0 1 ( < )\n1 2 ( < )\n0 2 ( > )\n.\n", calculus="point")
    >>> found
    <Solved 1 network: inconsistent>
    >>> found.verdict.value
    'inconsistent'
    >>> [str(constraint.source) for _, constraint in found.networks[0].conflict]
    ['<text>:2:1', '<text>:3:1', '<text>:4:1']
    """

    file: str
    networks: tuple[SolvedNetwork, ...]

    @property
    def verdict(self) -> Verdict:
        """INCONSISTENT if any of the networks is, else UNDECIDED if any of them is."""
        verdicts = {solved.verdict for solved in self.networks}
        return next(one for one in (Verdict.INCONSISTENT, Verdict.UNDECIDED, Verdict.CONSISTENT) if one in verdicts)

    def summary(self) -> str:
        """Return the number of networks and the verdict on all of them."""
        return f"{count(len(self.networks), 'network')}: {self.verdict}"


@checks_arguments
def solve(
    network: str | Path | None = None,
    *,
    calculus: str,
    text: str | None = None,
    closure: bool = False,
    scenario: bool = False,
    explain: tuple[int, int] | None = None,
    reasons: bool = True,
    time_limit: float = 60.0,
) -> Solved:
    r"""Decide whether the constraint networks of a file are consistent.

    Parameters
    ----------
    network
        File of the networks, in GQR's format.
    calculus
        Name of the calculus of the constraints; several joined by ``+``, or a file ``.spec``.
    text
        The networks themselves, instead of a file.
    closure
        True to compute the closed network.
    scenario
        True to find one solution.
    explain
        Indexes of two things whose relation to explain.
    reasons
        True to find a minimal conflict in each inconsistent network.
    time_limit
        Seconds for each network.

    Returns
    -------
    Solved
        The verdict on each network, with its reasons and what was requested.

    Raises
    ------
    DeixisError
        If the calculus is unknown, two calculi cannot be joined, or both ``closure`` and ``scenario`` are requested.
    NetworkFileError
        If the file has errors; the message names the line and column of each.
    LimitError
        If a network does not fit in memory.
    TypeError
        Unless exactly one of ``network`` and ``text`` is given.

    Examples
    --------
    >>> import deixis
    >>> print(deixis.solve(text="1\n0 1 ( DC )\n.\n", calculus="rcc8").verdict)
    consistent
    """
    require_path_or_text("solve", network, text)
    if closure and scenario:
        raise DeixisError("`closure` and `scenario` must not both be True; choose one")
    require_time_limit(time_limit)
    calculi, _ = calculi_named(calculus)
    texts = read_networks(network, calculi) if network is not None else parse_networks(text or "", calculi)
    request = SolveRequest(closure, scenario, explain, reasons, time_limit)
    return Solved("<text>" if network is None else str(network), tuple(solve_text(one, request) for one in texts))


def calculi_named(text: str) -> tuple[tuple[Calculus, ...], tuple[str, ...]]:
    """Return the calculi of ``ra+rcc8``, or of a specification in GQR's format.

    Parameters
    ----------
    text
        Names of calculi joined by ``+``, or the file of a specification.

    Returns
    -------
    tuple
        The calculi, and notes on them.

    Raises
    ------
    DeixisError
        If two are the same, or one is joined to no other.
    CalculusFileError
        If a specification is not a calculus.
    """
    from deixis.reasoning.qualitative.calculi.registry import calculus

    if text.endswith(".spec") or is_folder(text):
        from deixis.grammar.formats.calculi import read_calculus

        brought = read_calculus(text)
        return (brought.calculus,), brought.notes
    names = [name.strip() for name in text.split("+")]
    if len(set(names)) < len(names):
        raise DeixisError(f"calculus {text}: name each calculus once")
    calculi = tuple(calculus(name) for name in names)
    joined = {end.name for link in links_between(calculi) for end in (link.source, link.target)}
    for each in calculi:
        if len(calculi) > 1 and each.name not in joined:
            raise DeixisError(f"calculus {text}: no bridge connects {each.name} with the others")
    return calculi, ()


OnSolved = Callable[["SolvedNetwork"], None]
"""Called with a network as soon as its verdict is known, before it is clear why."""


def solve_text(
    text: NetworkText,
    request: SolveRequest,
    progress: Progress | None = None,
    on_solved: OnSolved = lambda solved: None,
) -> SolvedNetwork:
    """Solve one network of a file.

    Parameters
    ----------
    text
        The network with its place in the file.
    request
        What to compute, and the time limit.
    progress
        Called during the search.
    on_solved
        Called with what is known so far, once the verdict is.

    Returns
    -------
    SolvedNetwork
        The verdict with what was asked for.

    Raises
    ------
    LimitError
        If the network does not fit in memory.
    """
    solving = _solve_single if len(text.networks) == 1 else _solve_joint
    return solving(text, request, progress, on_solved)


def _solve_single(
    text: NetworkText, request: SolveRequest, progress: Progress | None, on_solved: OnSolved
) -> SolvedNetwork:
    started, deadline = time.perf_counter(), Deadline.after(request.time_limit)
    if request.explain is not None:
        require_pair(text.network, *request.explain)
    small, things = text.network.compact()
    closure = close(small, deadline, progress)
    found = solve_network(small, deadline, progress, request.scenario)
    verdict, reason, boxes = found.verdict, found.reason, None
    if (
        verdict is Verdict.UNDECIDED
        and not small.calculus.decided_by_closure
        and not unrelated((small,))
        and not deadline.passed
    ):
        witness = solve_jointly((small,), (), deadline, progress)
        verdict, reason, boxes = witness.verdict, witness.reason, witness.boxes
    seconds = time.perf_counter() - started
    solved = SolvedNetwork(text, verdict, reason, closure.narrowed, seconds, asked=request.explain)
    solved = _with_boxes(solved, boxes, things.tolist(), request)
    on_solved(solved)
    if verdict is Verdict.INCONSISTENT and request.conflict:
        conflict = minimal_conflict(text.network, deadline.for_reasons(request.time_limit), inconsistent=True)
        if conflict is not None:
            stated = tuple((text.network, c) for c in conflict.constraints)
            solved = replace(solved, conflict=stated, minimal=conflict.minimal)
    elif request.scenario and found.scenario is not None and boxes is None:
        solved = replace(solved, shown=(_renumbered(text.network, found.scenario.constraints, things.tolist()),))
    elif request.closure and closure.complete:
        relations = (Constraint(i, j, closure.relation(i, j)) for i, j in closure.known_pairs().tolist())
        solved = replace(solved, shown=(_renumbered(text.network, relations, things.tolist()),))
    if request.explain is not None and verdict is not Verdict.INCONSISTENT:
        deadline = deadline.for_reasons(request.time_limit)
        step = explain(text.network, *request.explain, deadline)
        solved = replace(solved, step=step, explained=step is not None or not deadline.passed)
    return solved


def _solve_joint(
    text: NetworkText, request: SolveRequest, progress: Progress | None, on_solved: OnSolved
) -> SolvedNetwork:
    started, deadline = time.perf_counter(), Deadline.after(request.time_limit)
    if request.explain is not None:
        raise DeixisError("a relation can be explained in one calculus at a time only")
    links: Sequence[Link] = links_between([network.calculus for network in text.networks])
    networks, things = compacted(text.networks)
    found = solve_jointly(networks, links, deadline, progress, request.scenario)
    contributions = found.closure.contributions
    narrowed = sum(each.pairs for each in contributions)
    seconds = time.perf_counter() - started
    solved = SolvedNetwork(text, found.verdict, found.reason, narrowed, seconds, contributions=contributions)
    solved = _with_boxes(solved, found.boxes, things.tolist(), request)
    on_solved(solved)
    if found.verdict is Verdict.INCONSISTENT and request.conflict:
        solved = _with_conflict(solved, links, deadline.for_reasons(request.time_limit))
    elif request.closure:
        pairs = zip(text.networks, found.closure.states, strict=True)
        solved = replace(
            solved,
            shown=tuple(
                _renumbered(
                    network,
                    (Constraint(i, j, state.relation(i, j)) for i, j in combinations(range(state.size), 2)),
                    things.tolist(),
                )
                for network, state in pairs
            ),
        )
    return solved


def _with_boxes(
    solved: SolvedNetwork, boxes: NDArray[np.float64] | None, things: list[int], request: SolveRequest
) -> SolvedNetwork:
    """Add the boxes of things, shape (n, 2, 2), and their relations in each calculus if a scenario is requested."""
    if boxes is None:
        return solved
    solved = replace(solved, boxes=dict(zip(things, boxes, strict=True)))
    if not request.scenario:
        return solved
    shown = []
    for network in solved.text.networks:
        codes = relate(boxes, network.calculus.name, reference=1.0).tolist()
        pairs = combinations(range(len(boxes)), 2)
        shown.append(_renumbered(network, (Constraint(i, j, 1 << codes[i][j]) for i, j in pairs), things))
    return replace(solved, shown=tuple(shown))


def _with_conflict(solved: SolvedNetwork, links: Sequence[Link], deadline: Deadline) -> SolvedNetwork:
    """Add the conflict that joint closure finds, or else that of a network that is inconsistent by itself."""
    networks = solved.text.networks
    joint = joint_conflict(networks, links, deadline.share(0.5))
    if joint is not None:
        by_name = {network.calculus.name: network for network in networks}
        stated = tuple((by_name[name], c) for name, c in joint.constraints)
        return replace(solved, conflict=stated, minimal=joint.minimal)
    for network in networks:
        own = minimal_conflict(network, deadline)
        if own is not None:
            return replace(solved, conflict=tuple((network, c) for c in own.constraints), minimal=own.minimal)
    return solved


def _renumbered(network: Network, constraints: Iterable[Constraint], things: list[int]) -> Network:
    """Return the constraints that exclude something, with the things numbered as in the whole network."""
    universal = network.calculus.universal
    return network.only(
        Constraint(things[c.first], things[c.second], c.relation) for c in constraints if c.relation != universal
    )
