"""Tell a layout or a scene in English, in few words, so that reading the text gives the same facts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.grammar.read import is_english
from deixis.grammar.reading import StatedFact, joined_choices
from deixis.grammar.script import Declaration, Script
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.reasoning.errors import OutOfTimeError, require_time_limit
from deixis.workflows.descriptions.telling import (
    NOT_READ,
    Plan,
    Telling,
    ToldObject,
    designations,
    each_denied,
    meaning_of,
    objects_of,
)
from deixis.workflows.layouts.read import SCRIPT_ENDING, as_scene, as_script

if TYPE_CHECKING:
    from deixis.perception.scene import Scene

TELL_TIME_LIMIT = 10.0
"""Default time limit in seconds."""


@checks_arguments
def tell(
    source: Script | Scene | str | Path | Mapping[str, Any],
    *,
    all_facts: bool = False,
    time_limit: float = TELL_TIME_LIMIT,
) -> Telling:
    """Describe a layout or a scene in English.

    Parameters
    ----------
    source
        A script or a scene, its file, or the parsed JSON of a scene.
    all_facts
        Say every fact of a layout; by default, facts that follow from the others are left out. Of a scene, say the
        relation of each object to each other one.
    time_limit
        Seconds for leaving out facts and for reading the text again.

    Returns
    -------
    Telling
        The sentences, each with the facts that it states. A name that the reader would not take as a noun phrase is
        written between backticks.

    Raises
    ------
    DeixisError
        If the script or the scene cannot be read, or the time limit is reached.

    Notes
    -----
    The descriptions of objects of a scene are made by the incremental algorithm of Dale and Reiter (1995).

    Examples
    --------
    >>> import deixis
    >>> script = deixis.read_script(text="left to right: fork, plate, knife; fork left of knife; fork below glass")
    >>> deixis.tell(script).text
    'The fork is left of the plate and nearer to you than the glass. The plate is left of the knife.'
    """
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    if isinstance(source, Script) or (isinstance(source, str | Path) and holds_facts(source)):
        return tell_layout(as_script(source, deadline=deadline), all_facts, deadline)
    from deixis.workflows.descriptions.tell_scene import tell_scene

    return tell_scene(as_scene(source), all_facts, deadline)


def holds_facts(file: str | Path) -> bool:
    """Return True for the name of a layout or of a text, False for that of a scene.

    Parameters
    ----------
    file
        Name of the file, which need not exist.

    Returns
    -------
    bool
        Decided by the ending of the name.
    """
    return str(file).casefold().endswith(SCRIPT_ENDING) or is_english(file)


def tell_layout(script: Script, all_facts: bool, deadline: Deadline) -> Telling:
    """Say the facts of a script in English; see :func:`tell`.

    Parameters
    ----------
    script
        Script to say.
    all_facts
        If False, leave out facts that follow from the others.
    deadline
        Time limit for finding facts that follow.

    Returns
    -------
    Telling
        Sentences, the words for each object, and the facts that were left out.
    """
    stated = _stated(script)
    left_out, complete = ([], True) if all_facts else _implied(script, stated, deadline)
    facts = _without_numbers([fact for number, fact in enumerate(stated) if number not in set(left_out)])
    surface = script.surface or "table"
    names = list(dict.fromkeys(name for fact in facts for name in objects_of(fact.content)))
    plan = Plan(facts, designations(names), surface.replace("_", " "), script.ontology)
    sentences = plan.readable(deadline)
    notes = [] if complete else ["time limit reached: more facts may follow from others"]
    notes += [] if plan.read_again else [NOT_READ]
    return Telling(
        script.file,
        sentences,
        tuple(facts),
        tuple(ToldObject(name, plan.words(name)) for name in names),
        tuple(fact for number in left_out if isinstance(fact := stated[number].content, Fact)),
        tuple(facts[number].content for number in sorted(plan.misread)),
        tuple(notes),
    )


def _stated(script: Script) -> list[StatedFact]:
    """Return the facts, claims, kinds and colours of a script, each once."""
    if script.reading is not None:
        stated: Iterable[StatedFact] = joined_choices(script.reading.stated)
    else:
        contents: list[Fact | Claim] = []
        for statement in script.all_statements():
            if isinstance(statement, Declaration):
                for name in dict.fromkeys(name for mention in statement.subjects for name in mention.names):
                    for relation, value in (("kind", statement.kind), ("colour", statement.colour)):
                        if value is not None:
                            contents.append(Claim(relation, (name,), value=value.label))
        stated = (StatedFact(content, 0, (0, 0)) for content in (*contents, *script.facts, *script.claims))
    once: dict[object, StatedFact] = {}
    for fact in stated:
        for one in each_denied(fact):
            once.setdefault((meaning_of(one.content, {}), one.condition, one.past, one.uncertain), one)
    return list(once.values())


def _without_numbers(stated: Sequence[StatedFact]) -> list[StatedFact]:
    """Return the facts without the number of objects that other facts mention, as the names say it."""
    counted = [fact.content.relation == "count" if isinstance(fact.content, Claim) else False for fact in stated]
    named = {name for fact, c in zip(stated, counted, strict=True) if not c for name in objects_of(fact.content)}
    return [
        fact
        for fact, is_count in zip(stated, counted, strict=True)
        if not (is_count and len(objects_of(fact.content)) > 1 and named.intersection(objects_of(fact.content)))
    ]


def _implied(script: Script, stated: Sequence[StatedFact], deadline: Deadline) -> tuple[list[int], bool]:
    """Return the places of facts that follow from the others, and whether all were examined in time."""
    from deixis.ontology.graph.graph import RelationGraph
    from deixis.reasoning.entailment.closing import consistent
    from deixis.reasoning.entailment.demands import demands_of
    from deixis.reasoning.entailment.redundant import redundant_facts

    places = [i for i, fact in enumerate(stated) if fact.asserted and isinstance(fact.content, Fact)]
    facts = [content for i in places if isinstance(content := stated[i].content, Fact)]
    graph = RelationGraph.from_facts(script.ontology.relations, script.objects, facts)
    try:
        if not consistent(demands_of(graph), deadline):
            return [], True
    except OutOfTimeError:
        return [], False
    redundant, complete = redundant_facts(graph, deadline)
    return [places[number] for number in redundant], complete
