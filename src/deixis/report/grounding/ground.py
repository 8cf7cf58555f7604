"""Groundings as lines of text for the terminal."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

from deixis.answers import share
from deixis.report.marks import doubt, violation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deixis.grammar.script import Script
    from deixis.ontology.lessons.types import Alternative, Match
    from deixis.reasoning.grounding.answers.answer import FactOutcome, Grounding, LeftOut, Member, Pivotal
    from deixis.reasoning.grounding.answers.claims import ClaimOutcome

MAX_LISTED = 12
"""Maximum number of names, and of pivotal facts, to list one by one."""

MIN_PROBABILITY_LEAD = 0.02
"""Minimum lead in probability at which another thing is reported as likelier; above the error of sampling."""


FRAMES = {"object": "by the thing's own front or axis", "table": "across the middle of the scene"}
"""Wording of the frames of reference other than the viewer's."""


def grounding_lines(found: Grounding) -> list[str]:
    """Return the matches, the interchangeable names, the violated facts, what was left out, and the qualifications.

    Parameters
    ----------
    found
        Answer of ``deixis ground``.

    Returns
    -------
    list of str
        A line for each match and each finding; doubtful and violated ones carry a mark.
    """
    objects = found.object_matches
    lines = [line for match in objects.values() if match.object not in found.members for line in match_lines(match)]
    lines += [line for name, members in found.members.items() for line in member_lines(name, members)]
    if lines:
        lines += [f"{left.name:<24} left out" for left in found.unmatched_objects[:MAX_LISTED]]
    else:
        lines = ["No object was found."]
    if found.surface is not None:
        thing = found.matches[found.surface].perceived
        lines.append(f"{found.surface:<24} {thing:<10} the surface that the objects stand on")
    lines += sureness_lines(found)
    elsewhere = [
        match.object
        for match in found.matches.values()
        if match.probability is not None
        and any((other.probability or 0.0) > match.probability + MIN_PROBABILITY_LEAD for other in match.alternatives)
    ]
    if elsewhere:
        head = "These are the most likely matches together; taken alone, another thing is more likely for: "
        lines += ["", f"{head}{', '.join(shortened_list(elsewhere))}."]
    groups = [group for group in found.interchangeable if any(name in found.matches for name in group)]
    if groups:
        lines += ["", "The description cannot tell these apart, so their names may be swapped:"]
        lines += ["    " + ", ".join(group) for group in groups]
    lines += ["", _counts_line("Facts", [entry.outcome for entry in found.outcomes])]
    lines += [violation(f"    violated: {violation_text(entry)}") for entry in found.violated]
    lines += claim_lines(found.claims)
    own = [one for one in found.frames if one.frame in FRAMES]
    lines += [f"    {one.fact}: {FRAMES[one.frame]} (probability {one.probability:.2f})" for one in own[:MAX_LISTED]]
    if found.fits is not None and found.outcomes:
        if found.matches:
            lines.append(f"The description fits this scene with probability {_probability(found.fits).strip()}.")
        elif found.unmatched_perceived:
            lines.append("Without a match, nothing shows whether the description is of this scene.")
    lines += left_out_lines((*found.unmatched_objects, *found.unmatched_perceived))
    pivotal = [line for entry in found.pivotal or () if (line := _pivotal_line(entry, found))]
    lines += pivotal[:MAX_LISTED]
    if len(pivotal) > MAX_LISTED:
        lines.append(f"and {len(pivotal) - MAX_LISTED} more facts that the answer depends on (--json lists all)")
    return [*lines, _standing_line(found), *(f"Note: {note}." for note in found.notes)]


def claim_lines(claims: Sequence[ClaimOutcome]) -> list[str]:
    """Return how many claims hold, and those that are violated or cannot be decided, with what was measured.

    Parameters
    ----------
    claims
        Outcomes of the claims of a description.

    Returns
    -------
    list of str
        Empty without claims. Violated claims are marked as violations, undecidable ones as doubt.
    """
    from deixis.reasoning.grounding.answers.claims import ClaimVerdict

    if not claims:
        return []
    lines = [_counts_line("Claims", [entry.verdict for entry in claims])]
    violated, undecidable = (
        [claim_text(entry) for entry in claims if entry.verdict is verdict]
        for verdict in (ClaimVerdict.VIOLATED, ClaimVerdict.UNDECIDABLE)
    )
    lines += [violation(f"    violated: {text}") for text in violated]
    return lines + [doubt(f"    undecidable: {text}") for text in undecidable]


NOT_SATISFIED = {
    "violated": "violated",
    "waived": "optional and not satisfied",
    "open": "about something left out",
    "undecidable": "undecidable",
}
"""Wording of the outcomes of facts and claims that are not satisfied."""


def _counts_line(what: str, outcomes: Sequence[str]) -> str:
    """Return how many facts or claims are stated, and how many have each outcome."""
    counts = Counter(outcomes)
    rest = [f"{counts[outcome]} {words}" for outcome, words in NOT_SATISFIED.items() if counts[outcome]]
    return ", ".join([f"{what}: {len(outcomes)} stated", f"{counts['satisfied']} satisfied", *rest])


def left_out_lines(left_out: Sequence[LeftOut]) -> list[str]:
    """Return what was left out, in one line for each reason.

    Parameters
    ----------
    left_out
        Described or perceived objects without a match.

    Returns
    -------
    list of str
        The names with their reason.
    """
    lines = []
    for reason in dict.fromkeys(left.reason for left in left_out):
        names = [left.name for left in left_out if left.reason == reason]
        listed = ", ".join(shortened_list(names)) + (" (--json lists all)" if len(names) > MAX_LISTED else "")
        each = "for each, " if len(names) > 1 and not {"it", "its"}.isdisjoint(reason.split()) else ""
        lines.append(f"Left out: {listed}: {each}{reason}.")
    return lines


def sureness_lines(found: Grounding) -> list[str]:
    """Return how sure the answer is, in plain words: how many names are decided, and which is the least certain.

    Parameters
    ----------
    found
        Answer of ``deixis ground``.

    Returns
    -------
    list of str
        An empty line and one sentence, marked as doubt unless all names of the description are decided; empty without
        matches. A name that was left out counts as not decided.
    """
    from deixis.reasoning.grounding.options import DECIDED

    matches = found.object_matches
    if not matches:
        return []
    left_out = len(found.unmatched_objects)
    total = len(matches) + left_out
    decided = sum(match.decided for match in matches.values())
    known = [match for match in matches.values() if match.probability is not None]
    rest = f"; {left_out} left out" if left_out else ""
    if not known:
        line = f"{share(decided, total, 'name')} decided{rest}; the answer has no probabilities."
        return ["", doubt(f"{line[0].upper()}{line[1:]}", decided < total)]
    if decided == total:
        what = "its match" if total == 1 else "each match"
        return ["", f"Sure of {share(total, total, 'name')}: {what} has a probability of at least {DECIDED:g}."]
    least = min(known, key=lambda match: match.probability or 0.0)
    probability = _probability(least.probability or 0.0).strip()
    if total == 1:
        return ["", doubt(f"Not sure: {least.object} has a probability of {probability}.")]
    line = f"Sure of {share(decided, total, 'name')} (probability {DECIDED:g} or more)"
    if decided < len(matches):
        line += f"; the least certain is {least.object} ({probability})"
    return ["", doubt(f"{line}{rest}.")]


def kinds_lines(script: Script) -> list[str]:
    """Return the kinds that grounding took from the names of objects, and the names without a known kind.

    Parameters
    ----------
    script
        Description that was grounded. Objects whose kind it states are not listed.

    Returns
    -------
    list of str
        At most two lines: the kinds with the names that they were taken from, and the names of no known kind.
    """
    by_kind: dict[str, list[str]] = {}
    unknown = []
    for name in script.objects:
        if name not in script.kinds:
            kind = script.ontology.of_name(name)[0]
            if kind is None:
                unknown.append(name)
            else:
                by_kind.setdefault(kind.label, []).append(name)
    shown = [
        label
        if [name.replace("_", " ").lower() for name in names] == [label.lower()]
        else f"{label} ({', '.join(names)})"
        for label, names in by_kind.items()
    ]
    lines = [f"Kinds taken from the names: {', '.join(shortened_list(shown))}."] if shown else []
    return lines + ([f"No known kind: {', '.join(shortened_list(unknown))}."] if unknown else [])


def _standing_line(found: Grounding) -> str:
    """Return whether the answer is proved the best, by which engine, how long it took, and the error of sampling."""
    from deixis.reasoning.grounding.answers.answer import Standing
    from deixis.reasoning.grounding.options import EngineName

    if found.proved_best:
        standing = "Proved the best answer"
    elif math.isfinite(found.gap):
        standing = f"Not proved the best answer: another could be {_times(found.gap)} as likely"
    else:
        standing = "Not proved the best answer"
    line = f"{standing}; engine {found.engine}, {found.seconds:.2f} s"
    if found.probabilities is Standing.SAMPLED and math.isfinite(found.probability_error):
        line += f"; probabilities are sampled, with an error of about {found.probability_error:.1g}"
    if found.engine == EngineName.SIMILARITY:
        line += f"; graph similarity {found.graph_similarity:.3f}"
    return doubt(f"{line}.", not found.proved_best)


def _times(nats: float) -> str:
    """Return a lead in nats as a factor in words."""
    return f"up to {math.exp(nats):.3g} times" if nats < math.log(1000) else "more than 1000 times"


def shortened_list(names: list[str]) -> list[str]:
    """Return the first :data:`MAX_LISTED` names, and how many more there are.

    Parameters
    ----------
    names
        Names in the order in which they are printed.

    Returns
    -------
    list of str
        All names, or the first of them and an entry such as ``4 more``.
    """
    return [*names[:MAX_LISTED], f"{len(names) - MAX_LISTED} more"] if len(names) > MAX_LISTED else names


def match_lines(match: Match) -> list[str]:
    """Return the line of one match, marked as doubt where the match is not decided.

    Parameters
    ----------
    match
        Match of one object of a description.

    Returns
    -------
    list of str
        A single line: object, thing, probability and alternatives.
    """
    return [doubt(_match_line(match), not match.decided)]


def member_lines(name: str, members: tuple[Member, ...]) -> list[str]:
    """Return the line with the members of a group of unknown number.

    Parameters
    ----------
    name
        Name of the group.
    members
        Things that belong to it, the most probable first.

    Returns
    -------
    list of str
        A single line: the group, the number of its members, and these with their probabilities.
    """
    listed = shortened_list([f"{one.perceived} {_probability(one.probability).strip()}" for one in members])
    return [f"{name:<24} all that fit ({len(members)}): {', '.join(listed)}"]


def _match_line(match: Match) -> str:
    """Return an object, its thing, the probability of the match, and the alternatives."""
    line = f"{match.object:<24} {match.perceived:<10}"
    if match.probability is not None:
        line += f" {_probability(match.probability)}"
        others = [f"{_thing(other)} {_probability(other.probability or 0)}" for other in match.alternatives]
        return line + (f"   or {', '.join(shortened_list(others))}" if others and not match.decided else "")
    equal = [_thing(other) for other in match.alternatives if other.cost <= 1e-9]
    if match.decided or not match.alternatives:
        return line.rstrip()
    return (
        f"{line} or {', '.join(shortened_list(equal))}"
        if equal
        else f"{line} or, less likely, {_thing(match.alternatives[0])}"
    )


def _thing(other: Alternative) -> str:
    return other.perceived or "absent"


def probability_text(value: float) -> str:
    """Return a probability with two digits; 1 only where it is certain, and below 0.99 where it is not decided.

    Parameters
    ----------
    value
        Probability of a match, in [0, 1].

    Returns
    -------
    str
        The digits.

    Examples
    --------
    >>> probability_text(0.9899), probability_text(0.9999), probability_text(1.0)
    ('0.98', '0.99', '1')
    """
    return _probability(value).strip()


def _probability(value: float) -> str:
    """Return a probability with two digits; 1 only where it is certain, and below DECIDED where undecided."""
    from deixis.reasoning.grounding.options import DECIDED

    if value < DECIDED:
        return f"{min(value, DECIDED - 0.01):.2f}"
    return "1   " if value > 1 - 1e-6 else "0.99"


def _pivotal_line(pivotal: Pivotal, found: Grounding) -> str:
    """Return how the answer would change without a fact; empty where only interchangeable objects would swap."""
    changes = dict(pivotal.changes)
    for group in found.interchangeable:
        held = {found.matches[name].perceived for name in group if name in found.matches}
        if all(changes[name] in held for name in group if name in changes):
            changes = {name: thing for name, thing in changes.items() if name not in group}
    place = f" ({pivotal.fact.source})" if pivotal.fact.source else ""
    would = [f"{name} would be {thing or 'left out'}" for name, thing in changes.items()]
    if len(pivotal.unsettled) > 1 and set(pivotal.unsettled) == {
        n for n, match in found.matches.items() if match.decided
    }:
        would.append("no match would be decided")
    elif pivotal.unsettled:
        would.append(f"{', '.join(pivotal.unsettled)} would not be decided")
    if pivotal.settled:
        would.append(f"{', '.join(pivotal.settled)} would be decided")
    return f"Without {pivotal.fact}{place}: {'; '.join(would)}." if would else ""


def claim_text(entry: ClaimOutcome) -> str:
    """Return a claim with what was measured, and its line.

    Parameters
    ----------
    entry
        Outcome of a claim.

    Returns
    -------
    str
        The claim, the measure, and the place ``file:line:column`` of the claim.
    """
    place = f" ({entry.claim.source})" if entry.claim.source else ""
    return f"{entry}{place}"


def violation_text(entry: FactOutcome) -> str:
    """Return a violated fact with its line and the relation that was perceived instead.

    Parameters
    ----------
    entry
        Outcome of a violated fact.

    Returns
    -------
    str
        The fact and its place ``file:line:column``, then the perceived relation where the pair was perceived.
    """
    place = f" ({entry.fact.source})" if entry.fact.source else ""
    if entry.perceived is None or entry.seen is None:
        return f"{entry.fact}{place}"
    subject, other = entry.perceived
    return f"{entry.fact}{place}: perceived is {entry.seen.word}({subject}, {other})"
