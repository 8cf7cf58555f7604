"""Solved constraint networks as lines of text and as plain data for JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from deixis.report.marks import doubt, violation

if TYPE_CHECKING:
    from deixis.reasoning.qualitative.networks.closure.rounds import Step
    from deixis.reasoning.qualitative.networks.network import Constraint, Network
    from deixis.workflows.reasoning.solve import Solved, SolvedNetwork

MAX_CONFLICT_LISTED = 50
"""Maximum number of constraints of a conflict to list."""


def solved_lines(solved: SolvedNetwork) -> Iterator[str]:
    """Yield the verdict, then its reasons or the requested explanation.

    Parameters
    ----------
    solved
        Answer of ``deixis solve`` about one network.

    Yields
    ------
    str
        Lines of :func:`verdict_line` and :func:`reason_lines`.
    """
    yield verdict_line(solved)
    yield from reason_lines(solved)


def verdict_line(solved: SolvedNetwork) -> str:
    """Return the verdict on a network, with its size and the time in seconds.

    Parameters
    ----------
    solved
        Answer of ``deixis solve`` about one network.

    Returns
    -------
    str
        The line, marked as a violation if the network is inconsistent and as doubt if it is undecided.
    """
    networks = solved.text.networks
    stated = sum(len(network.constraints) for network in networks)
    names = "+".join(network.calculus.name for network in networks)
    comment = f" ({solved.text.comment})" if solved.text.comment else ""
    line = (
        f"line {solved.text.line}{comment}: {solved.verdict}; {_count(networks[0].size, 'thing')}, "
        f"{_count(stated, 'constraint')} in {names}, {_count(solved.narrowed, 'pair')} narrowed, {solved.seconds:.2f} s"
    )
    return violation(line) if solved.verdict == "inconsistent" else doubt(line, solved.verdict == "undecided")


def reason_lines(solved: SolvedNetwork, conflict: bool = True) -> Iterator[str]:
    """Yield the reasons for a verdict, or the requested explanation.

    Parameters
    ----------
    solved
        Answer of ``deixis solve`` about one network.
    conflict
        True if a conflict was searched for, so that a missing one is reported as a time limit.

    Yields
    ------
    str
        The boxes of a solution, the contribution of each calculus, at most :data:`MAX_CONFLICT_LISTED` constraints of a
        conflict, or the steps of a derivation.
    """
    if solved.reason:
        yield f"    {solved.reason}"
    if solved.boxes and solved.shown:
        for thing, ((west, south), (east, north)) in _plain(solved):
            yield f"    box {thing}: x from {west:.12g} to {east:.12g}, y from {south:.12g} to {north:.12g}"
    for each in solved.contributions:
        yield f"    {each.name}: {_count(each.pairs, 'pair')} narrowed, {_count(each.atoms, 'atom')} removed"
    if solved.conflict:
        kind = "" if solved.minimal else " (not proved minimal: time limit reached before all were tried)"
        yield f"These cannot all hold{kind}:"
        for network, c in solved.conflict[:MAX_CONFLICT_LISTED]:
            yield f"    {c.source}: {c.first} {c.second} ( {' '.join(network.calculus.members(c.relation))} )"
        if len(solved.conflict) > MAX_CONFLICT_LISTED:
            yield f"    … and {len(solved.conflict) - MAX_CONFLICT_LISTED} more"
        yield "Leave out or change any one of these." if solved.minimal else "Leave out or change some of these."
    elif solved.verdict == "inconsistent" and conflict:
        yield "    time limit reached before the conflicting constraints were found"
    if solved.asked is not None:
        first, second = solved.asked
        if solved.verdict == "inconsistent":
            yield f"There is nothing to explain about {first} and {second}: the constraints cannot all hold."
        elif not solved.explained:
            yield f"Time limit reached before the relation of {first} and {second} was explained."
        elif solved.step is None:
            yield f"Nothing follows about {first} and {second}."
        else:
            from deixis.reasoning.qualitative.networks.closure.rounds import step_lines

            yield from step_lines(solved.step, solved.text.network)


def solved_to_dict(solved: SolvedNetwork) -> dict[str, Any]:
    """Return a solved network as plain data for JSON.

    Parameters
    ----------
    solved
        Answer of ``deixis solve`` about one network.

    Returns
    -------
    dict
        Data for JSON. What was not requested or not found is None; ``seconds`` is the time that the verdict took.
    """
    networks = solved.text.networks
    return {
        "line": solved.text.line,
        "comment": solved.text.comment,
        "things": networks[0].size,
        "constraints": sum(len(network.constraints) for network in networks),
        "verdict": str(solved.verdict),
        "reason": solved.reason or None,
        "narrowed": solved.narrowed,
        "seconds": solved.seconds,
        "contributions": [{"by": c.name, "pairs": c.pairs, "atoms": c.atoms} for c in solved.contributions],
        "conflict": [_constraint(network, c) for network, c in solved.conflict] or None,
        "conflict_minimal": solved.minimal if solved.conflict else None,
        "boxes": [{"thing": thing, "min": low, "max": high} for thing, (low, high) in _plain(solved)] or None,
        "relations": [_constraint(network, c) for network in solved.shown for c in network.constraints] or None,
        "derivation": None if solved.step is None else _step(solved.step, networks),
    }


def network_rows(solved: SolvedNetwork) -> Iterator[dict[str, Any]]:
    """Yield a row for each relation of the closure or the scenario that was requested.

    Parameters
    ----------
    solved
        Answer of ``deixis solve`` about one network.

    Yields
    ------
    dict
        ``calculus``, ``first``, ``relation`` and ``second``; the relation holds its atoms, separated by spaces.
    """
    for network in solved.shown:
        for c in network.constraints:
            relation = " ".join(network.calculus.members(c.relation))
            yield {"calculus": network.calculus.name, "first": c.first, "relation": relation, "second": c.second}


def file_lines(solved: Solved) -> list[str]:
    """Return the lines of all networks of a file.

    Parameters
    ----------
    solved
        Answer of ``deixis solve``.

    Returns
    -------
    list of str
        Lines of :func:`solved_lines`, network after network.
    """
    return [line for network in solved.networks for line in solved_lines(network)]


def file_to_dict(solved: Solved) -> dict[str, Any]:
    """Return all networks of a file as plain data for JSON.

    Parameters
    ----------
    solved
        Answer of ``deixis solve``.

    Returns
    -------
    dict
        Data for JSON with the keys ``file`` and ``networks``.
    """
    return {"file": solved.file, "networks": [solved_to_dict(network) for network in solved.networks]}


def file_rows(solved: Solved) -> Iterator[dict[str, Any]]:
    """Yield a row for each network of a file.

    Parameters
    ----------
    solved
        Answer of ``deixis solve``.

    Yields
    ------
    dict
        ``line``, ``comment``, ``things``, ``constraints``, ``verdict``, ``narrowed`` and ``seconds`` of the network.
    """
    columns = ("line", "comment", "things", "constraints", "verdict", "narrowed", "seconds")
    for network in solved.networks:
        known = solved_to_dict(network)
        yield {column: known[column] for column in columns}


def _plain(solved: SolvedNetwork) -> list[tuple[int, list[list[float]]]]:
    """Return the boxes by thing, as lists of their corners."""
    return [(thing, box.tolist()) for thing, box in solved.boxes.items()]


def _constraint(network: Network, c: Constraint) -> dict[str, Any]:
    members = list(network.calculus.members(c.relation))
    line = None if c.source is None else c.source.line
    entry = {"calculus": network.calculus.name, "first": c.first, "second": c.second, "relation": members}
    return entry if line is None else {**entry, "line": line}


def _step(step: Step, networks: Sequence[Network]) -> dict[str, Any]:
    from deixis.ontology.graph.facts import Source

    return {
        "first": step.claim.first,
        "second": step.claim.second,
        "relation": list(networks[0].calculus.members(step.claim.relation)),
        "line": step.source.line if isinstance(step.source, Source) else None,
        "premises": [_step(premise, networks) for premise in step.premises],
    }


def _count(number: int, noun: str) -> str:
    return f"{number:,} {noun}" + ("" if number == 1 else "s")
