"""Tell a scene: choose what to say about each object, and check that the text finds the objects again."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.grammar.english.telling.telling import MAX_NUMBERED, Designation, ToldSentence
from deixis.grammar.english.telling.wording import relation_words
from deixis.grammar.reading import StatedFact
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.tbox import Ontology, default_ontology
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.geometry.overlap import gaps
from deixis.reasoning.grounding.evidence.claims.aims import stated_direction
from deixis.reasoning.grounding.evidence.properties.colours import colour_terms
from deixis.reasoning.grounding.reference.expressions import (
    Attributes,
    Description,
    reading_order,
    relate,
    single_out,
)
from deixis.workflows.descriptions.telling import NOT_READ, Plan, Telling, ToldObject

if TYPE_CHECKING:
    from deixis.perception.scene import Scene

MAX_CHECKED = 40
"""Maximum number of objects of a scene whose text is grounded again."""

MAX_MORE = 5
"""Maximum number of times that further relations are said about objects that the text does not find."""

MIN_TIME = 0.5
"""Seconds without which the text is not changed and grounded again."""

NOT_GROUNDED = "time limit reached: whether the text singles out each object was not checked"
"""Note on a text that was not grounded again."""

UNKNOWN = "thing"
"""Noun for an object without a label."""


def tell_scene(scene: Scene, all_facts: bool, deadline: Deadline) -> Telling:
    """Say where the objects of a scene are, in English; see :func:`deixis.workflows.descriptions.tell.tell`.

    Parameters
    ----------
    scene
        Scene to say.
    all_facts
        If True, say the relation of each object to each other one; if False, leave most relations out.
    deadline
        Time limit for checking the text and for describing each object by itself.

    Returns
    -------
    Telling
        Sentences, and the words for each object, with whether the text singles it out.
    """
    if not scene.objects:
        return Telling(scene.file, (), (), (), notes=("the scene has no objects",))
    ontology = default_ontology()
    attributes = _attributes(scene, ontology, deadline)
    order = list(reading_order(attributes))
    words = _designations(scene, attributes, order)
    descriptions = _descriptions(attributes, order, len(order) if all_facts else 1)
    plan, sentences = _sentences(scene, attributes, words, order, descriptions, ontology, deadline)
    found: dict[str, bool | None] = dict.fromkeys(scene.ids)
    notes: list[str] = []
    if len(order) > MAX_CHECKED:
        notes.append(f"the scene has more than {MAX_CHECKED} objects, so the text was not grounded again")
    else:
        for attempt in range(MAX_MORE + 1):
            rivals = _rivals(scene, plan, sentences, Deadline.after(deadline.left / 3))
            if rivals is None:
                found = dict.fromkeys(scene.ids)
                notes.append(NOT_GROUNDED)
                break
            found = {scene.ids[i]: not rivals[i] for i in order}
            lost = [i for i in order if rivals[i]]
            if not lost or attempt == MAX_MORE or deadline.left < MIN_TIME:
                break
            for i in lost:
                marks = [mark for mark in order if mark != i and mark not in {m for _, m in descriptions[i].relations}]
                count = len(descriptions[i].relations) + 1
                more = relate(replace(descriptions[i], rivals=rivals[i]), attributes, marks, most=count)
                same = len(more.relations) < count  # each relation fits the rivals as well: say the nearest one
                descriptions[i] = relate(descriptions[i], attributes, marks, least=count) if same else more
            plan, sentences = _sentences(scene, attributes, words, order, descriptions, ontology, deadline)
    everything = range(len(order))
    unique = [i for i in everything if not single_out(i, everything, attributes, ()).rivals]
    objects = [
        ToldObject(
            scene.ids[i],
            plan.words(scene.ids[i]),
            _description(scene, attributes, i, unique, deadline),
            found[scene.ids[i]],
        )
        for i in order
    ]
    notes += [] if plan.read_again else [NOT_READ]
    if deadline.passed and any(thing.description is None for thing in objects):
        notes.append("time limit reached: not all objects were described by themselves")
    misread = tuple(plan.facts[number].content for number in sorted(plan.misread))
    return Telling(scene.file, sentences, tuple(plan.facts), tuple(objects), (), misread, tuple(notes))


# What can be said ----------------------------------------------------------------------------------------------------


def _attributes(scene: Scene, ontology: Ontology, deadline: Deadline) -> Attributes:
    nouns = tuple(
        None if thing.label is None else " ".join(thing.label.casefold().replace("_", " ").split()) or None
        for thing in scene.objects
    )
    seen = np.array(
        [thing.colour if thing.colour is not None else (np.nan,) * 3 for thing in scene.objects], dtype=float
    )
    terms = colour_terms(seen, ontology.colours)
    extents = scene.boxes[:, 1] - scene.boxes[:, 0]
    return Attributes(
        nouns,
        tuple(None if term is None else term.label for term in terms),
        extents[:, 0] * extents[:, 1],
        scene.relations(ontology.relations, deadline=deadline),
        np.sqrt((gaps(scene.boxes) ** 2).sum(axis=2)),
    )


def _designations(scene: Scene, attributes: Attributes, order: Sequence[int]) -> dict[str, Designation]:
    """Return words for each object: its noun, with its colour or with its number if others have the noun."""
    found: dict[str, Designation] = {}
    by_noun: dict[str, list[int]] = {}
    for i in order:
        by_noun.setdefault(attributes.nouns[i] or UNKNOWN, []).append(i)
    for noun, members in by_noun.items():
        colours = Counter(attributes.colours[i] for i in members)
        for number, i in enumerate(members, start=1):
            if len(members) == 1:
                found[scene.ids[i]] = Designation(noun)
            elif None not in colours and max(colours.values()) == 1 and noun != UNKNOWN:
                found[scene.ids[i]] = Designation(f"{attributes.colours[i]} {noun}")
            elif len(members) <= MAX_NUMBERED:
                found[scene.ids[i]] = Designation(noun, number)
            else:
                found[scene.ids[i]] = Designation(f"{noun.replace(' ', '_')}_{number}", None, True)
    return found


def _descriptions(attributes: Attributes, order: Sequence[int], least: int) -> dict[int, Description]:
    """Return what is said about each object: relations to earlier objects that fit no later object."""
    descriptions = {}
    for place, i in enumerate(order):
        plain = replace(single_out(i, order[place:], attributes, ()), colour=None, size=None)
        rivals = tuple(o for o in order[place + 1 :] if attributes.share(attributes.nouns, i, o))
        descriptions[i] = relate(replace(plain, rivals=rivals), attributes, order[:place], min(place, least))
    return descriptions


def _sentences(
    scene: Scene,
    attributes: Attributes,
    words: dict[str, Designation],
    order: Sequence[int],
    descriptions: dict[int, Description],
    ontology: Ontology,
    deadline: Deadline,
) -> tuple[Plan, tuple[ToldSentence, ...]]:
    """Return the plan of the text and its sentences."""
    stated: list[Fact | Claim] = []
    first = order[0]
    if len(order) > 1:
        rivals = [other for other in order[1:] if attributes.share(attributes.nouns, first, other)]
        if rivals and attributes.sizes[first] > attributes.sizes[rivals].max():
            stated.append(Claim("largest", (scene.ids[first],)))
    for i in order:
        for word, mark in descriptions[i].relations:
            stated.append(Fact(scene.ids[i], (ontology.relations[word],), scene.ids[mark]))
        stated += _directions(scene, i)
    facts = [StatedFact(content, 0, (0, 0)) for content in stated]
    names = {name: "_".join([*d.words.split(), *([str(d.number)] if d.number else [])]) for name, d in words.items()}
    plan = Plan(facts, words, "table", ontology, names)
    return plan, plan.readable(deadline)


MAX_OFF_DIRECTION = np.pi / 6
"""Maximum angle in radians between the direction of a thing and the word that is said about it."""


def _directions(scene: Scene, i: int) -> Iterator[Claim]:
    """Yield in which direction a thing points, if a heading shows that and a word says it well."""
    thing, poses = scene.objects[i], scene.poses
    if thing.heading is None or poses is None:
        return
    for value in ("left", "right", "away", "viewer"):
        wanted = stated_direction(value)
        if wanted is not None and poses.aim_angles(wanted)[i] <= MAX_OFF_DIRECTION:
            yield Claim("pointing", (thing.id,), value=value)


# Whether it finds the objects -----------------------------------------------------------------------------------------


def _rivals(
    scene: Scene, plan: Plan, sentences: Sequence[ToldSentence], deadline: Deadline
) -> dict[int, tuple[int, ...]] | None:
    """Ground the text in the scene, and return the objects that each object could be taken for, itself left out.

    They are all others if the text does not ground the object at all. None: the time did not suffice to know.
    """
    from deixis.grammar.english.reader import read_english
    from deixis.reasoning.grounding.answers.answer import Standing
    from deixis.workflows.grounding.ground import ground

    everything = range(len(scene.objects))
    found = {i: tuple(other for other in everything if other != i) for i in everything}
    if not sentences:
        return found
    try:
        script = read_english(" ".join(s.text for s in sentences), "<told>", plan.ontology, deadline)
        grounding = ground(script, scene, time_limit=max(0.1, deadline.left))
    except OutOfTimeError:
        return None
    except DeixisError:
        return found
    if not grounding.finished or grounding.probabilities is Standing.NONE:
        return None
    assert script.reading is not None
    object_of_name = plan.names_read(script.reading)
    place = {name: i for i, name in enumerate(scene.ids)}
    for name, match in grounding.matches.items():
        if name in object_of_name:
            i = place[object_of_name[name]]
            taken = {match.perceived, *(() if match.decided else match.could_be)}
            found[i] = tuple(place[other] for other in taken if place[other] != i) or found[i] * (not match.decided)
    return found


def _description(
    scene: Scene, attributes: Attributes, target: int, unique: Sequence[int], deadline: Deadline
) -> str | None:
    """Return the shortest of the descriptions that, by ``refer``, mean this object; None if none does."""
    from deixis.workflows.descriptions.refer import refer

    for text in _candidates(attributes, target, unique):
        if deadline.passed:
            return None
        try:
            if refer(text, scene).target == scene.ids[target]:
                return text
        except DeixisError:
            continue
    return None


def _candidates(attributes: Attributes, target: int, unique: Sequence[int]) -> Iterator[str]:
    """Yield descriptions of an object: by the incremental algorithm, then with other landmarks and superlatives."""
    everything = range(len(attributes.sizes))
    chosen = single_out(target, everything, attributes, unique)
    yield _phrase(chosen, attributes)
    near = sorted((i for i in unique if i != target), key=lambda i: attributes.gaps[target, i])
    for mark in near[:4]:
        yield _phrase(replace(chosen, size=None, relations=((attributes.word(target, mark), mark),)), attributes)
    noun = attributes.nouns[target] or UNKNOWN
    for word in ("leftmost", "rightmost", "largest", "smallest"):
        yield f"the {word} {noun}"
    for first, second in itertools.pairwise(near):
        relations = tuple((attributes.word(target, mark), mark) for mark in (first, second))
        yield _phrase(replace(chosen, relations=relations), attributes)


def _phrase(description: Description, attributes: Attributes) -> str:
    """Return a description as a noun phrase."""
    words = ["the", *(word for word in (description.size, description.colour) if word), description.noun or UNKNOWN]
    related = [f"{_relation_words(word)} {_name(mark, attributes)}" for word, mark in description.relations]
    return f"{' '.join(words)} {' and '.join(related)}".strip()


def _name(mark: int, attributes: Attributes) -> str:
    description = single_out(mark, range(len(attributes.sizes)), attributes, ())
    return " ".join(
        ["the", *(word for word in (description.size, description.colour) if word), description.noun or UNKNOWN]
    )


def _relation_words(word: str) -> str:
    return {"top": "behind", "bottom": "in front of"}.get(word) or relation_words(default_ontology().relations[word])
