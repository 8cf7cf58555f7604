"""Turn parsed English sentences into a query for one object."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

from deixis.grammar.english.tree import Adjective, Clause, NounPhrase, Predicate, Sentence, Viewpoint
from deixis.reasoning.grounding.reference.query import Description, Property, Query, Relation, Viewer

SURROUNDINGS = frozenset(
    {
        "room",
        "scene",
        "house",
        "apartment",
        "space",
        "area",
        "building",
    }
)
"""Nouns for the whole scene: a landmark that tells nothing."""

LEVELS = {"floor": "low", "ground": "low", "ceiling": "high"}
"""Surfaces of a room with the height of what is near them."""

GROUPS = frozenset(
    {
        "group",
        "set",
        "row",
        "line",
        "pair",
        "bunch",
        "cluster",
        "one",
        "all",
        "some",
        "rest",
        "kind",
        "type",
        "stack",
        "pile",
    }
)
"""Nouns for several objects, whose kind the complement with *of* tells."""

PARTS = frozenset(
    {
        "side",
        "end",
        "edge",
        "corner",
        "middle",
        "center",
        "centre",
        "front",
        "back",
        "top",
        "bottom",
        "foot",
        "head",
        "part",
        "section",
        "half",
        "left",
        "right",
        "rear",
    }
)
"""Nouns for a part of the object that the complement with *of* tells."""

EMPTY = frozenset(
    {
        "thing",
        "object",
        "item",
        "one",
        "it",
        "this",
        "that",
        "these",
        "those",
    }
)
"""Nouns that say nothing of the kind."""

COMPARED = {"big": "bigger", "large": "bigger", "small": "smaller", "little": "smaller", "tall": "taller"}
COMPARED |= {"short": "shorter", "long": "longer", "wide": "wider", "high": "above", "low": "below"}

UPON = {"on": "on", "top": "on", "above": "above", "under": "under", "underneath": "under", "below": "below"}
"""Relations of *with a book on top*, *with a bin underneath*."""

RENAMED = {"top": "behind", "bottom": "in_front", "nearest": "near", "closer": "near", "farthest": "far"}
"""Relations of a table that a room has under another name."""

Item = TypeVar("Item")

MAX_DEPTH = 6
"""Maximum depth of phrases within phrases; what lies deeper tells next to nothing about the object."""


def query_of(sentences: Sequence[Sentence]) -> Query:
    """Return the query of the sentences that describe one object.

    The first noun of the text names the object. What is said of *it*, *this one*, or of the same noun belongs to it;
    a clause about something else that mentions it is a relation of it.
    """
    parts = [part for sentence in sentences if not sentence.heading for part in _statements(sentence)]
    words = sum(sentence.words for sentence in sentences)
    understood = sum(sentence.words_understood for sentence in sentences) / words if words else 0.0
    viewer = next((found for sentence in sentences for found in _viewers(sentence)), None)
    target = Description("")
    for subject, predicates in parts:
        named, own = _resolve(subject, predicates)
        if not target.noun and named is not None and (name := _noun(named)):
            target = replace(target, noun=name)
        told = _description(named, 0) if named is not None else Description("")
        if told.noun and target.noun and not _same(told.noun, target.noun):
            back = _mention(own, target.noun)
            if back is not None:
                relation = Relation(RENAMED.get(back.relation, back.relation), (told,), inverted=not back.reversed)
                target = replace(target, relations=(*target.relations, relation))
            continue
        properties, relations = _said(own, 0)
        target = replace(
            target,
            properties=_distinct((*target.properties, *told.properties, *properties)),
            relations=_distinct((*target.relations, *told.relations, *relations)),
        )
    if not target.noun and viewer is not None:  # 'facing the windows, the one on the right'
        target = replace(target, noun=(viewer.target or viewer.landmark).noun)
    return Query(_with_nouns(target, viewer), viewer, understood)


def _with_nouns(target: Description, viewer: Viewer | None) -> Description:
    """Give landmarks without a noun theirs.

    *It* is what the viewer looks at (*facing the desk, the lamp to the right of it*); *the others* are of the target's
    kind (*the chair between the other two*).
    """

    def named(told: Description) -> Description:
        if told.noun:
            return told
        if viewer is not None and told == Description(""):
            return viewer.target or viewer.landmark
        return replace(told, noun=target.noun)

    relations = (replace(one, arguments=tuple(map(named, one.arguments))) for one in target.relations)
    return replace(target, relations=tuple(relations))


def _statements(sentence: Sentence) -> Iterator[tuple[NounPhrase | None, tuple[Predicate, ...]]]:
    if sentence.fragment is not None:
        yield sentence.fragment, ()
    for clause in sentence.clauses:
        yield clause.subject, _positive(clause)


def _positive(clause: Clause) -> tuple[Predicate, ...]:
    if clause.positive:
        return clause.predicates
    return tuple(replace(predicate, positive=not predicate.positive) for predicate in clause.predicates)


def _resolve(
    subject: NounPhrase | None, predicates: tuple[Predicate, ...]
) -> tuple[NounPhrase | None, tuple[Predicate, ...]]:
    """Return the phrase that names the subject (*it is the chair …*: the chair) and the other predicates."""
    kinds = [one for one in predicates if one.relation == "kind" and one.positive and one.arguments]
    rest = tuple(one for one in predicates if one not in kinds)
    if subject is not None and _noun(subject):
        extra = [one for kind in kinds for one in (*_as_predicates(kind.arguments[0]), *kind.arguments[0].predicates)]
        return subject, (*rest, *extra)
    if kinds:
        return kinds[0].arguments[0], rest
    return subject, rest


def _as_predicates(phrase: NounPhrase) -> list[Predicate]:
    return [Predicate(one.dimension, (), one.span, value=one, positive=one.positive) for one in phrase.adjectives]


def _noun(phrase: NounPhrase, depth: int = 0) -> str:
    """Return the noun of a phrase, or of its complement for *one of the chairs* and *the end of the table*."""
    if phrase.members and depth < MAX_DEPTH:
        return _noun(phrase.members[0], depth + 1)
    head = phrase.head.casefold()
    if phrase.of is not None and depth < MAX_DEPTH and (not head or head in GROUPS | PARTS | EMPTY):
        return _noun(phrase.of, depth + 1)
    return "" if head in EMPTY else head


def _same(first: str, second: str) -> bool:
    return first == second or first.split()[-1] == second.split()[-1]


def _mention(predicates: Sequence[Predicate], noun: str) -> Predicate | None:
    """Return the predicate among whose arguments the noun is."""
    for predicate in predicates:
        if any(_same(name, noun) for one in predicate.arguments if (name := _noun(one))):
            return predicate
        if any(one.pronoun in {"it", "one", "this", "that"} for one in predicate.arguments):
            return predicate
    return None


def _description(phrase: NounPhrase, depth: int) -> Description:
    """Return the description of one phrase, with those of the landmarks in it."""
    if depth > MAX_DEPTH:
        return Description("")
    if phrase.members:
        return _description(phrase.members[0], depth + 1)
    head, inner = phrase.head.casefold(), None
    if phrase.of is not None:
        inner = _description(phrase.of, depth + 1)
    properties = [_property(one) for one in phrase.adjectives]
    more, relations = _said(phrase.predicates, depth + 1)
    noun = "" if head in EMPTY else head
    if inner is not None and (not noun or noun in GROUPS | PARTS):
        noun, properties = inner.noun, [*properties, *inner.properties]
        relations = (*relations, *inner.relations)
    elif inner is not None and inner.noun and inner.noun not in SURROUNDINGS:
        relations = (*relations, Relation("with", (inner,)))
    if phrase.owner is not None and not phrase.owner.pronoun:
        relations = (*relations, Relation("with", (_description(phrase.owner, depth + 1),)))
    count = phrase.count if phrase.plural or phrase.count else None
    return Description(noun, (*properties, *more), relations, count, phrase.negated)


def _property(said: Adjective) -> Property:
    return Property(said.dimension, said.word.casefold(), str(said.degree), said.rank, said.positive)


def _said(predicates: Sequence[Predicate], depth: int) -> tuple[tuple[Property, ...], tuple[Relation, ...]]:
    """Return the properties and the relations that predicates state of their subject."""
    properties: list[Property] = []
    relations: list[Relation] = []
    for predicate in predicates:
        if depth > MAX_DEPTH:
            break
        arguments = [part for one in predicate.arguments for part in (one.members or (one,))]
        if not arguments:
            properties += _place(predicate)
            continue
        if predicate.relation == "kind":
            told = _description(arguments[0], depth + 1)
            if predicate.positive:
                properties, relations = [*properties, *told.properties], [*relations, *told.relations]
            continue
        name = RENAMED.get(predicate.relation, predicate.relation)
        if predicate.value is not None and predicate.value.word in COMPARED:
            name = COMPARED[predicate.value.word]
        landmarks = [(one, _description(one, depth + 1)) for one in arguments]
        if name == "between" or (name == "middle" and (len(arguments) > 1 or arguments[0].plural)):
            told_all = tuple(told for _, told in landmarks)
            relations.append(Relation("between", told_all, positive=predicate.positive))
            continue
        for phrase, told in landmarks:
            positive = predicate.positive != phrase.negated
            if told.noun == "wall" and told.relations:  # 'the wall with the window': the window says where
                relations.append(replace(told.relations[0], name=name, degree=str(predicate.degree), positive=positive))
            elif told.noun in SURROUNDINGS | {"wall"} | set(LEVELS) and (known := _surface(name, told.noun, positive)):
                properties += known
            elif told.noun in SURROUNDINGS:
                properties += _place(replace(predicate, positive=positive))
            else:
                degree = str(predicate.degree)
                if name == "with" and (upon := [one for one in told.properties if one.word in UPON]):
                    told = replace(told, properties=tuple(one for one in told.properties if one not in upon))
                    relations.append(Relation(UPON[upon[0].word], (told,), degree, positive, inverted=True))
                    continue
                relations.append(Relation(name, (told,), degree, positive, predicate.reversed))
    return tuple(properties), tuple(relations)


def _surface(relation: str, noun: str, positive: bool) -> list[Property]:
    """Return the property that stands for a relation to a surface of the room, if there is one."""
    if noun in LEVELS:
        return [Property("height", LEVELS[noun], positive=positive)]
    if noun == "wall" and relation in {"against", "near", "next_to", "touching", "along", "on"}:
        return [Property("position", "wall", positive=positive)]
    return []


def _place(said: Predicate) -> list[Property]:
    """Return the properties of a predicate without a landmark: *on the left*, *red*, *second from the right*."""
    if said.relation == "ordinal":
        rank = said.value.rank if said.value is not None else 1
        words = (said.part or "left").split()
        return [Property("rank", words[-1], rank=rank, positive=said.positive)]
    if said.value is not None:
        return [replace(_property(said.value), positive=said.positive and said.value.positive)]
    words = (said.part or "").split() if said.relation in {"part", "side", "end"} else [said.relation]
    if said.relation in {"corner", "left", "right", "middle"} and said.part and said.part != "side":
        words = [said.relation, *said.part.split()]
    words = [part for word in words for part in (word.split("_") if word.startswith(("top_", "bottom_")) else [word])]
    known = {"in_front": "front", "behind": "back", "above": "high", "below": "low", "under": "low", "far": "far"}
    degree = str(said.degree)
    return [Property("position", known.get(word, word), degree, positive=said.positive) for word in words]


def _viewers(sentence: Sentence) -> Iterator[Viewer]:
    if sentence.viewpoint is not None and (found := _viewer(sentence.viewpoint)) is not None:
        yield found
    phrases = [sentence.fragment] if sentence.fragment is not None else []
    predicates = [one for phrase in phrases for one in phrase.predicates]
    predicates += [one for clause in sentence.clauses for one in clause.predicates]
    for predicate in predicates:
        if predicate.viewpoint is not None and (found := _viewer(predicate.viewpoint)) is not None:
            yield found


def _viewer(said: Viewpoint) -> Viewer | None:
    """Return the viewer of a viewpoint; None for one that tells no direction (*to your left*)."""
    at = said.at if said.at is not None and _noun(said.at) not in SURROUNDINGS | {""} else None
    facing = said.facing if said.facing is not None and _noun(said.facing) not in SURROUNDINGS | {""} else None
    if facing is not None:
        if at is not None and not said.entering:
            return Viewer("towards", _description(at, 1), _description(facing, 1))
        return Viewer("facing", _description(facing, 1))
    if said.back is not None and _noun(said.back):
        return Viewer("from", _description(said.back, 1))
    if at is not None:
        return Viewer("entering" if said.entering else "from", _description(at, 1))
    if said.own is not None and _noun(said.own):
        return Viewer("own", _description(said.own, 1))
    return None


def _distinct(items: Sequence[Item]) -> tuple[Item, ...]:
    return tuple(dict.fromkeys(items))
