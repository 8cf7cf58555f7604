"""Scripts, inferences, lessons and checks as lines of text for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Sized
from itertools import islice
from typing import TYPE_CHECKING, Any

from deixis.ontology.things.kinds import with_article
from deixis.report.grounding.ground import claim_text, left_out_lines, violation_text
from deixis.report.marks import doubt, violation

MAX_LISTED = 12
"""Maximum number of source lines to list behind an inferred fact, and of objects to list of a counterexample."""

NEXT_LINE = " " * 13
"""Indentation below the verdicts of a check."""

UNDETERMINED_REMEDY = (
    "Labels in the scene, or recognition, would show what the undetermined things are; 'deixis ground' decides by "
    "places and sizes too."
)

MAX_INFERRED_LISTED = 20_000
"""Maximum number of inferred facts to list."""

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.ontology.graph.claims import Claim
    from deixis.ontology.graph.facts import Fact
    from deixis.reasoning.comparison.checking import RoleCheck
    from deixis.reasoning.entailment.why_not import WhyNot
    from deixis.workflows.grounding.check import Check
    from deixis.workflows.knowledge.learn import Learned
    from deixis.workflows.layouts.infer import Inference


def script_lines(script: Script) -> list[str]:
    """Return the header of a script, its facts with their lines, and its kinds and colours.

    Parameters
    ----------
    script
        Script of the layout language, or text in English that was read as one.

    Returns
    -------
    list of str
        One line for the header, one for each fact or claim, and one for each stated kind or colour.
    """
    title = f' "{script.title}"' if script.title else ""
    viewpoint = f", seen from {script.viewpoint}" if script.viewpoint else ""
    head = f"{script.name or script.file}{title}: {_count(script.objects, 'object')}, {_count(script.facts, 'fact')}"
    head += f", {_count(script.claims, 'claim')}" if script.claims else ""
    kinds = [f"        {name} is {with_article(kind.label)}" for name, kind in script.kinds.items()]
    kinds += [f"        {name} is {colour.label}" for name, colour in script.colours.items()]
    return [
        f"{head}{viewpoint}",
        *(f"{_line(stated, script.file):>6}  {qualified(stated)}" for stated in script.stated),
        *kinds,
    ]


def qualified(fact: Fact | Claim) -> str:
    """Return a fact or a claim with its mark 'optional' and its weight.

    Parameters
    ----------
    fact
        Fact or claim.

    Returns
    -------
    str
        The statement, followed in brackets by ``optional`` and by a weight other than 1.
    """
    marks = [*(["optional"] if fact.optional else []), *([f"weight {fact.weight:g}"] if fact.weight != 1 else [])]
    return str(fact) + (f"   [{', '.join(marks)}]" if marks else "")


def _line(fact: Fact | Claim, file: str) -> str:
    if fact.source is None:
        return ""
    return str(fact.source.line) if fact.source.file == file else f"{fact.source.file}:{fact.source.line}"


def _count(things: Sized, noun: str) -> str:
    number = len(things)
    return f"{number} {noun}" + ("" if number == 1 else "s")


def inference_lines(inference: Inference) -> Iterator[str]:
    """Yield the stated and the inferred facts with their lines, or only the minimal conflict.

    Parameters
    ----------
    inference
        Answer of ``deixis infer``.

    Yields
    ------
    str
        The conflict, marked as a violation; or the facts, at most :data:`MAX_INFERRED_LISTED` inferred ones. Notices
        that the time limit was reached are marked as doubt.
    """
    if inference.conflict is not None:
        yield violation(f"The script contradicts itself: {inference.conflict.reason}.")
        yield from (violation(f"    {fact.source}: {fact}") for fact in inference.conflict.facts)
        if inference.conflict.minimal:
            yield "Leave out or change any one of these."
        else:
            yield "Leave out or change some of these; time limit reached before it was known which are needed."
        return
    if not inference.decided:
        reason = "time limit reached before it was known whether the facts, some with a choice, can all hold"
        yield doubt(f"Undecided: {reason}.")
        return
    yield f"Stated ({len(inference.stated)}):"
    for fact in inference.stated:
        yield f"    {qualified(fact)}   line {fact.source.line if fact.source else '?'}"
    count = inference.implications.unstated() + len(inference.of_claims)
    yield f"Inferred ({count}):"
    for entry in islice(inference.each_inferred(), MAX_INFERRED_LISTED):
        lines = entry.lines
        if not entry.steps:
            places = "facts that leave a choice"
        elif not lines or len(lines) > MAX_LISTED:
            places = f"{entry.steps} fact{'s' if entry.steps != 1 else ''}"
        else:
            places = ("line " if len(lines) == 1 else "lines ") + ", ".join(map(str, lines))
        yield f"    {entry.fact}   by {entry.rule} from {places}"
    if count > MAX_INFERRED_LISTED:
        yield f"    and {count - MAX_INFERRED_LISTED} more: --ntriples prints all that holds, --json everything"
    if not inference.complete:
        yield doubt("Time limit reached: more may follow from the facts that leave a choice.")


def why_not_lines(found: WhyNot) -> list[str]:
    """Return why a fact does not follow, with at most :data:`MAX_LISTED` objects of a counterexample.

    Parameters
    ----------
    found
        Answer of ``deixis infer --why-not``.

    Returns
    -------
    list of str
        The derivation if the fact follows after all; otherwise what excludes it, or a counterexample whose coordinates
        only order the sides of the boxes.
    """
    if found.follows is not None:
        return [f"{found.fact} does follow:", *(f"    {line}" for line in found.follows.lines())]
    if found.against is not None:
        return [f"{found.fact} cannot hold, since this does:", *(f"    {line}" for line in found.against.lines())]
    if found.conflict is not None:
        lines = [f"{found.fact} cannot hold together with these ({found.conflict.reason}):"]
        stated = [fact for fact in found.conflict.facts if fact.source is not None]
        return lines + [f"    {fact.source}: {fact}" for fact in stated]
    assert found.picture is not None
    lines = [
        f"{found.fact} does not follow: it is false on this table, where every firm fact holds "
        "(the numbers only order the sides of the boxes)."
    ]
    boxes = dict(zip(found.picture.objects, found.picture.boxes.astype(int).tolist(), strict=True))
    ends = dict.fromkeys((found.fact.subject, found.fact.object))
    shown = [*ends, *(name for name in boxes if name not in ends)][:MAX_LISTED]
    for name in shown:
        low, high = boxes[name]
        lines.append(f"    {name:<24} " + "   ".join(f"{axis} {low[k]} to {high[k]}" for k, axis in enumerate("xyz")))
    if len(boxes) > len(shown):
        lines.append(f"    and {len(boxes) - len(shown)} more (--json lists all)")
    lines += ["It would require:", *(f"    {order}" for order in found.missing)]
    known = [f"    {fact}" for fact in found.known]
    return [*lines, "What follows about the two:", *(known or ["    nothing"])]


def learned_lines(learned: Learned, memory: str | None = None) -> list[str]:
    """Return what a lesson taught, and what it left open.

    Parameters
    ----------
    learned
        Answer of ``deixis learn``.
    memory
        Name of the memory for the first line; None leaves it out.

    Returns
    -------
    list of str
        The lesson, its decided categories and new views, and the objects that are not decided or left out.
    """
    layout = learned.lesson.layout
    claims = f", {_count(layout.claims, 'claim')}" if layout.claims else ""
    lines = [
        f"Learned '{layout.name}' as lesson {layout.lesson}: {_count(layout.roles, 'role')}, "
        f"{_count(layout.facts, 'fact')}{claims}" + (f"; stored in {memory}" if memory else "")
    ]
    if learned.categories:
        lines.append("Decided, each an example of its category: " + ", ".join(learned.categories))
    new, again = ([taught.category for taught in learned.seen if taught.again == same] for same in (False, True))
    if new:
        lines.append("Categories with a new view: " + ", ".join(new))
    if again:
        lines.append("The same view as before, kept once: " + ", ".join(again))
    lines += [f"{word}." for word in learned.kept_names]
    if learned.doubtful:
        lines.append("Recorded as not decided, so no view was learned: " + ", ".join(learned.doubtful))
    lines += left_out_lines(learned.grounding.unmatched_objects)
    return lines + [f"Note: {note}." for note in learned.grounding.notes]


def check_lines(checked: Check) -> list[str]:
    """Return the verdict on a table, its errors line by line, and what is undetermined.

    Parameters
    ----------
    checked
        Answer of ``deixis check``.

    Returns
    -------
    list of str
        The verdict first; errors are marked as violations.
    """
    from deixis.reasoning.comparison.checking import RoleVerdict
    from deixis.reasoning.grounding.answers.claims import ClaimVerdict, violated

    table = checked.table
    right = "Nothing is known to be wrong" if table.of(RoleVerdict.UNDETERMINED) else "Nothing is wrong"
    name = checked.layout.name
    lines = [
        f"{right} according to '{name}'." if table.well else violation(f"This table is not laid as '{name}' says.")
    ]
    for entry in table.of(RoleVerdict.MISSING):
        facts = [
            fact for fact in checked.layout.facts if entry.role in (fact.subject, fact.object) and not fact.optional
        ]
        stated = "".join(f"; {fact}" + (f" ({fact.source})" if fact.source else "") for fact in facts)
        lines.append(violation(f"missing      {entry.role}{stated}"))
    for entry in table.of(RoleVerdict.MISPLACED):
        exchanged = f", where {entry.in_place_of} belongs" if entry.in_place_of else ""
        lines.append(violation(f"misplaced    {entry.role} ({entry.perceived}){exchanged}"))
        lines += [violation(f"{NEXT_LINE}{violation_text(broken)}") for broken in entry.broken]
    turned_by_claim = {turned.statement: entry for entry in table.turned for turned in entry.turned}
    for entry in table.turned:
        for turned in entry.turned:
            lines.append(violation(f"turned       {entry.role} ({entry.perceived}): {turned.remedy}"))
            place = f" ({turned.statement.source})" if turned.statement.source else ""
            lines.append(violation(f"{NEXT_LINE}{turned.statement}{place} does not hold"))
    blamed = {entry.role for entry in table.of(RoleVerdict.MISPLACED)}
    for broken in table.broken:
        if not blamed & {broken.fact.subject, broken.fact.object} and broken.fact not in turned_by_claim:
            lines.append(violation(f"broken       {violation_text(broken)}"))
    for entry, other in table.miscoloured:
        seen = f"{other.seen.label}, not {other.described.label}"
        lines.append(violation(f"miscoloured  {entry.role} ({entry.perceived}): {seen}"))
    lines += [violation(f"extra        {extra.perceived}: {extra.reason}") for extra in table.extra]
    lines += [
        violation(f"broken       {claim_text(entry)}")
        for entry in violated(table.claims)
        if entry.claim not in turned_by_claim
    ]
    lines += [violation(f"unexpected   {violation_text(entry)}") for entry in table.unexpected]
    hedged = (entry for entry in table.claims if entry.claim.weight < 1 and entry.verdict is ClaimVerdict.VIOLATED)
    lines += [violation(f"unexpected   {claim_text(entry)}") for entry in hedged]
    unsure = (entry for entry in table.claims if entry.verdict is ClaimVerdict.UNDECIDABLE)
    lines += [doubt(f"unchecked    {claim_text(entry)}") for entry in unsure]
    lines += [
        doubt(f"undetermined {entry.role}: {entry.perceived} {_known_by(entry)}")
        for entry in table.of(RoleVerdict.UNDETERMINED)
    ]
    lines += [f"absent       {entry.role}, which is optional" for entry in table.of(RoleVerdict.ABSENT)]
    undetermined = len(table.of(RoleVerdict.UNDETERMINED))
    rest = f", {undetermined} undetermined" if undetermined else ""
    lines.append(f"correct      {len(table.of(RoleVerdict.CORRECT))} of {len(table.roles)}{rest}")
    if undetermined:
        lines.append(UNDETERMINED_REMEDY)
    return lines + [f"Note: {note}." for note in table.grounding.notes]


def _known_by(entry: RoleCheck) -> str:
    from deixis.reasoning.comparison.checking import SURE_CONFIDENCE

    if entry.label is None or entry.confidence is None:
        return "lies in its place, but nothing shows what it is"
    if entry.confidence < SURE_CONFIDENCE:
        return f"is labelled '{entry.label}' with confidence {entry.confidence:.3g}, below {SURE_CONFIDENCE:g}"
    return f"is labelled '{entry.label}', which does not decide it"


def stats_lines(counted: dict[str, Any], lessons: Sequence[str]) -> list[str]:
    """Return the counts of a memory, one a line, and its lessons.

    Parameters
    ----------
    counted
        Number by name, or by name and graph.
    lessons
        Ids of the lessons.

    Returns
    -------
    list of str
        One line for each number and each lesson.
    """
    lines = []
    for name, value in counted.items():
        if isinstance(value, dict):
            lines += [f"{name}, {graph}: {number}" for graph, number in value.items()]
        else:
            lines.append(f"{name}: {value}")
    return [*lines, *(f"lesson {lesson}" for lesson in lessons)]
