"""Who is who, as lines of text for the terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deixis.ontology.lessons.types import Alternative, Match
    from deixis.reasoning.grounding.answer import FactOutcome, Grounding, Pivotal

MAX_LISTED = 12
"""Names, and facts that matter, that are listed one by one."""

MIN_PROBABILITY_LEAD = 0.02
"""By how much likelier another thing is where it is told: more than what sampling makes of equal ones."""


def grounding_lines(found: Grounding) -> list[str]:
    """Who is who, what cannot be told apart, which facts fail, what was left out, and what qualifies the answer."""
    from deixis.reasoning.grounding.answer import Outcome, Standing

    lines = [_match_line(match) for match in found.matches.values()] or ["No object was found."]
    elsewhere = [
        match.object
        for match in found.matches.values()
        if match.probability is not None
        and any((other.probability or 0.0) > match.probability + MIN_PROBABILITY_LEAD for other in match.alternatives)
    ]
    if elsewhere:
        told = "This is the likeliest map as a whole; taken alone, likelier to be another thing: "
        lines += ["", f"{told}{', '.join(at_most_many(elsewhere))}."]
    groups = [group for group in found.interchangeable if any(name in found.matches for name in group)]
    if groups:
        lines += ["", "The description cannot tell these apart, so their names may be swapped:"]
        lines += ["    " + ", ".join(group) for group in groups]
    counts = {outcome: len(found.of(outcome)) for outcome in (Outcome.VIOLATED, Outcome.WAIVED, Outcome.OPEN)}
    words = {
        Outcome.VIOLATED: "violated",
        Outcome.WAIVED: "optional and not so",
        Outcome.OPEN: "about something left out",
    }
    rest = "".join(f", {number} {words[outcome]}" for outcome, number in counts.items() if number)
    lines += ["", f"Facts: {len(found.outcomes)} stated, {len(found.satisfied)} satisfied" + rest]
    lines += [f"    violated: {violation_text(entry)}" for entry in found.violated]
    if found.fits is not None:
        lines.append(f"The description is of this scene with probability {_probability(found.fits).strip()}.")
    left_out = (*found.unmatched_objects, *found.unmatched_perceived)
    for reason in dict.fromkeys(left.reason for left in left_out):
        names = [left.name for left in left_out if left.reason == reason]
        if len(names) > MAX_LISTED:
            names = [", ".join(at_most_many(names)) + " (--json has them)"]
        lines += [f"Left out: {name}: {reason}." for name in names]
    pivotal = [line for entry in found.pivotal or () if (line := _pivotal_line(entry, found))]
    lines += pivotal[:MAX_LISTED]
    if len(pivotal) > MAX_LISTED:
        lines.append(f"and {len(pivotal) - MAX_LISTED} more facts that matter (--json has them)")
    how = "proved the best in" if found.proved_best else "not proved the best,"
    if not found.proved_best and math.isfinite(found.gap):
        how = f"not proved the best: another could be likelier by {found.gap:.3g} nats at most;"
    sampled = found.probabilities is Standing.SAMPLED and math.isfinite(found.probability_error)
    error = f"; probabilities are sampled, within about {found.probability_error:.1g}" if sampled else ""
    standing = f"{how} {found.seconds:.2f} s{error}"
    lines.append(f"Graph similarity {found.graph_similarity:.3f}; engine {found.engine}, {standing}.")
    return lines + [f"Note: {note}." for note in found.notes]


def at_most_many(told: list[str]) -> list[str]:
    """Return the first ones, and how many more there are."""
    return [*told[:MAX_LISTED], f"{len(told) - MAX_LISTED} more"] if len(told) > MAX_LISTED else told


def match_lines(match: Match) -> list[str]:
    """Return the line of one match."""
    return [_match_line(match)]


def _match_line(match: Match) -> str:
    """Return an object, its thing, how probable that is, and what else it may be."""
    line = f"{match.object:<24} {match.perceived:<10}"
    if match.probability is not None:
        line += f" {_probability(match.probability)}"
        others = [f"{_thing(other)} {_probability(other.probability or 0)}" for other in match.alternatives]
        return line + (f"   or {', '.join(at_most_many(others))}" if others and not match.decided else "")
    equal = [_thing(other) for other in match.alternatives if other.cost <= 1e-9]
    if match.decided or not match.alternatives:
        return line.rstrip()
    return (
        f"{line} or {', '.join(at_most_many(equal))}"
        if equal
        else f"{line} or, less likely, {_thing(match.alternatives[0])}"
    )


def _thing(other: Alternative) -> str:
    return other.perceived or "not there"


def _probability(value: float) -> str:
    """Two digits, never 1 for what is not certain, and what is not called decided looks so."""
    from deixis.reasoning.grounding.options import DECIDED

    if value < DECIDED:
        return f"{min(value, DECIDED - 0.01):.2f}"
    return "1   " if value > 1 - 1e-6 else "0.99"


def _pivotal_line(pivotal: Pivotal, found: Grounding) -> str:
    """What would be otherwise without a fact, empty where interchangeable objects would only swap their things."""
    changes = dict(pivotal.changes)
    for group in found.interchangeable:
        held = {found.matches[name].perceived for name in group if name in found.matches}
        if all(changes[name] in held for name in group if name in changes):
            changes = {name: thing for name, thing in changes.items() if name not in group}
    place = f" ({pivotal.fact.source})" if pivotal.fact.source else ""
    would = [f"{name} would be {thing or 'left out'}" for name, thing in changes.items()]
    if pivotal.unsettled:
        would.append(f"{', '.join(pivotal.unsettled)} would not be settled")
    if pivotal.settled:
        would.append(f"{', '.join(pivotal.settled)} would be settled")
    return f"Without {pivotal.fact}{place}: {'; '.join(would)}." if would else ""


def violation_text(entry: FactOutcome) -> str:
    """Return a violated fact with its line and what was perceived instead."""
    place = f" ({entry.fact.source})" if entry.fact.source else ""
    if entry.perceived is None or entry.seen is None:
        return f"{entry.fact}{place}"
    subject, other = entry.perceived
    return f"{entry.fact}{place}: perceived is {entry.seen.word}({subject}, {other})"
