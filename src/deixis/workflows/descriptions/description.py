"""Turn parsed English sentences into a query for one object."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from deixis.grammar.english.discourse.entities import plain_noun
from deixis.grammar.english.tree import Adjective, NounPhrase, Predicate, Sentence, Viewpoint
from deixis.grammar.english.vocabulary.function_words import ORDINALS
from deixis.reasoning.grounding.reference.query import Description, Person, Property, Query, Relation, Viewer

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
"""Nouns for the whole scene: a landmark without information."""

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
        "roll",
        "piece",
        "sheet",
    }
)
"""Nouns for several objects, whose kind the complement with *of* gives."""

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
"""Nouns for a part of the object that the complement with *of* names."""

PLACES_AMONG = frozenset({"middle", "center", "centre", "front", "back", "rear", "top", "bottom", "left", "right"})
"""Nouns of PARTS that choose from a group."""

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
        "option",
        "choice",
        "answer",
        "target",
    }
)
"""Nouns that say nothing about the kind."""

ANYTHING = frozenset({"thing", "object", "item"})
"""Nouns that every object fits; the other ones of EMPTY stand for a noun said before."""

PERSONS = {"me": Person.SPEAKER, "i": Person.SPEAKER, "myself": Person.SPEAKER, "us": Person.SPEAKER}
PERSONS |= {"you": Person.ADDRESSEE, "yourself": Person.ADDRESSEE}
"""Pronouns for those who take part in the conversation."""

STANDPOINTS = frozenset(
    {"view", "point of view", "viewpoint", "perspective", "vantage point", "position", "standpoint"}
)
STANDPOINTS |= {"point", "side", "end", "place", "seat", "eye", "body", "robot"}
"""Nouns for the place of the person who owns it (*from your point of view*, *closest to my side*)."""

FROM_PERSON = {
    "near": "near",
    "next_to": "near",
    "in_front": "near",
    "touching": "near",
    "against": "near",
    "on": "near",
}
FROM_PERSON |= {"left": "left", "right": "right", "far": "far", "opposite": "far", "behind": "far"}
"""Side of the scene, as a person sees it, of what stands in a relation to that person."""

WALL_RELATIONS = {"on": "near", "against": "near", "along": "near", "touching": "near", "opposite": "opposite"}
"""Relations to a wall that something singles out (*on the wall with the window*), with the relation to that thing."""

COMPARED = {"big": "bigger", "large": "bigger", "small": "smaller", "little": "smaller", "tall": "taller"}
COMPARED |= {"short": "shorter", "long": "longer", "wide": "wider", "high": "above", "low": "below"}

UPON = {"on": "on", "top": "on", "above": "above", "under": "under", "underneath": "under", "below": "below"}
"""Relations of *with a book on top*, *with a bin underneath*."""

RENAMED = {"top": "behind", "bottom": "in_front", "nearest": "near", "closer": "near", "farthest": "far"}
"""Relations of a table that a room has under another name."""

SIDE_NOUNS = frozenset({"left", "right", "middle", "center", "centre"})
"""Nouns that stand for the object at that side (*it is the one on the far right*: *the far right*)."""

ORDER_ENDS = {"left": "right", "right": "left", "top": "bottom", "bottom": "top", "front": "back", "back": "front"}
"""Sides from which objects in a row are counted, with the opposite side."""

Item = TypeVar("Item")

MAX_DEPTH = 6
"""Maximum depth of phrases within phrases; deeper phrases carry almost no information about the object."""


def query_of(sentences: Sequence[Sentence]) -> Query:
    """Return the query of the sentences that describe one object.

    The first noun of the text names the object, unless a later sentence picks another one (*there is a shelf between
    two doors; it is the door on the left*): the first one is then what *it* stands for. What is said about *it*, *this
    one*, or of the same noun belongs to the object; a clause about something else that mentions it is a relation of it.

    Parameters
    ----------
    sentences
        Parsed sentences, in order.

    Returns
    -------
    Query
        The noun, the properties and the relations of the object.
    """
    parts = [part for sentence in sentences if not sentence.heading for part in _statements(sentence)]
    words = sum(sentence.words for sentence in sentences)
    understood = sum(sentence.words_understood for sentence in sentences) / words if words else 0.0
    viewer = next((found for sentence in sentences for found in _viewers(sentence)), None)
    target, context = Description(""), None
    for part in parts:
        named, own = _resolve(part.subject, part.predicates)
        named_part = _description(named, 0) if named is not None else Description("")
        pointed = _pointed_at(part) if not target.noun else None
        if pointed is not None:
            target = Description(pointed[0], relations=(replace(pointed[1], arguments=(named_part,)),))
            continue
        back = _mention(own, target.noun) if target != Description("") else None
        begins = not target.noun and (back is None or part.picks)
        if begins and named is not None and (name := _noun(named)):
            target = replace(target, noun=name, plural=named_part.plural)
        if named_part.noun and target != Description("") and not (target.noun and _same(named_part.noun, target.noun)):
            if part.picks:
                target, context = Description(named_part.noun, plural=named_part.plural), target
            else:
                if back is not None:
                    relation = Relation(
                        RENAMED.get(back.relation, back.relation), (named_part,), inverted=not back.reversed
                    )
                    target = replace(target, relations=(*target.relations, relation))
                continue
        properties, relations = _constraints(own, 0)
        target = replace(
            target,
            properties=_ranked(_distinct((*target.properties, *named_part.properties, *properties))),
            other_nouns=target.other_nouns or named_part.other_nouns,
            anything=target.anything or named_part.anything,
            relations=_distinct((*target.relations, *named_part.relations, *relations)),
        )
    target = replace(_with_own_noun(target, viewer), properties=_ordered(target.properties))
    return Query(_with_nouns(target, viewer, context), viewer, understood, words)


def _ordered(properties: tuple[Property, ...]) -> tuple[Property, ...]:
    """Give a rank without an order that of another property: *the second closest one*, *the first one on your left*."""
    ranked = next((one for one in properties if one.rank is not None and one.word in ORDINALS), None)
    if ranked is None:
        return properties
    sides = [one for one in properties if one.rank is None and one.positive and one.dimension == "position"]
    graded = next((one for one in sides if one.degree == "superlative" or one.word in {"near", "close"}), None)
    by = graded or next((one for one in sides if one.word in {"left", "right", "front", "back"}), None)
    if by is None:
        return properties
    ordered = replace(by, dimension="rank", degree="plain", rank=ranked.rank)
    return tuple(ordered if one is ranked else one for one in properties if one is not graded)


def _with_own_noun(target: Description, viewer: Viewer | None) -> Description:
    """Give a target without a noun one: that of the group it is chosen from, or of what the viewer looks at."""
    if target.noun:
        return target
    among = next((one for one in target.relations if one.name == "among" and one.arguments[0].noun), None)
    if among is not None:  # 'of the two chairs by the door, the left one'
        group = among.arguments[0]
        own = tuple(one for one in group.properties if one.degree == "plain" and one.dimension != "position")
        rest = (*(one for one in target.relations if one is not among), *group.relations)
        return replace(target, noun=group.noun, properties=_distinct((*target.properties, *own)), relations=rest)
    if viewer is not None and viewer.person is None:  # 'facing the windows, the one on the right'
        looked = viewer.target or viewer.landmark
        if looked.noun not in SURROUNDINGS | {"wall"}:
            return replace(target, noun=looked.noun)
        carried = [one.arguments[0].noun for one in looked.relations if one.inverted or one.name == "with"]
        return replace(target, noun=next(filter(None, carried), looked.noun))
    for relation in target.relations:  # 'on the wall with two pictures, the one on the right'
        group = relation.arguments[0]
        if group.noun and group.count is not None and group.count > 1:
            return replace(
                target, noun=group.noun, relations=tuple(one for one in target.relations if one is not relation)
            )
    return target


def _with_nouns(target: Description, viewer: Viewer | None, context: Description | None) -> Description:
    """Give landmarks without a noun theirs.

    *It* is what was described before (``context``), or what the viewer looks at (*facing the desk, the lamp to the
    right of it*); *the others* are of the target's kind (*the chair between the other two*).
    *The largest object* gets none.
    """

    def named(description: Description) -> Description:
        if description.noun or (
            description.anything and any(one.degree == "superlative" for one in description.properties)
        ):
            return description
        if context is not None and description == Description(""):
            return context
        if viewer is not None and viewer.person is None and description == Description(""):
            return viewer.target or viewer.landmark
        return replace(description, noun=target.noun)

    relations = (replace(one, arguments=tuple(map(named, one.arguments))) for one in target.relations)
    return replace(target, relations=tuple(relations))


@dataclass(frozen=True, slots=True)
class Statement:
    """Something said in a description; ``picks`` is True where it names the object that is meant."""

    subject: NounPhrase | None
    predicates: tuple[Predicate, ...]
    picks: bool = False


def _statements(sentence: Sentence) -> Iterator[Statement]:
    if (fragment := sentence.fragment) is not None and fragment.negated:  # 'Not the lamp between the beds.'
        affirmed = replace(fragment, negated=False)
        yield Statement(None, (Predicate("kind", (affirmed,), fragment.span, positive=False),))
    elif fragment is not None:
        yield Statement(fragment, (), picks=fragment.determiner in {"the", "this", "that"})
    for clause in sentence.clauses:
        predicates = clause.predicates
        subject = clause.subject
        picked = [one.arguments[0] for one in predicates if one.relation == "kind" and one.arguments and one.positive]
        picks = subject is not None and bool(subject.pronoun) and any(one.determiner == "the" for one in picked)
        if subject is not None and subject.negated and not _noun(subject):  # 'not the one next to the door'
            subject, positive = None, not clause.positive
        else:
            positive = clause.positive
        if not positive:
            predicates = tuple(replace(predicate, positive=not predicate.positive) for predicate in predicates)
        yield Statement(subject, predicates, picks and positive)


def _pointed_at(part: Statement) -> tuple[str, Relation] | None:
    """Return the noun of *this desk* in *there is no lamp on this desk*, and the relation with the desk as landmark."""
    if part.subject is None or part.subject.determiner not in {"a", "an", "some", "no", None} or part.subject.pronoun:
        return None
    for predicate in part.predicates:
        for phrase in predicate.arguments:
            for nearest, landmark in (
                (predicate, phrase),
                *((one, arg) for one in phrase.predicates for arg in one.arguments),
            ):
                if landmark.determiner in {"this", "these"} and (noun := _noun(landmark)):
                    name = RENAMED.get(nearest.relation, nearest.relation)
                    positive = predicate.positive != (part.subject.determiner == "no")
                    return noun, Relation(name, (), str(nearest.degree), positive, not nearest.reversed)
    return None


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
    head = plain_noun(phrase.head).casefold()
    if phrase.of is not None and depth < MAX_DEPTH and (not head or head in GROUPS | PARTS | EMPTY):
        return _noun(phrase.of, depth + 1)
    return "" if head in EMPTY or (head in SIDE_NOUNS and phrase.of is None) else head


def _same(first: str, second: str) -> bool:
    """Return whether two nouns may stand for one object: the same head, or synonyms."""
    from deixis.ontology.lexicon.lexicon import Relatedness
    from deixis.ontology.tbox import default_ontology

    if first == second or first.split()[-1] == second.split()[-1]:
        return True
    return default_ontology().lexicon.relation(first, second) in {
        Relatedness.SAME,
        Relatedness.SYNONYM,
        Relatedness.BROADER,
        Relatedness.NARROWER,
    }


def _mention(predicates: Sequence[Predicate], noun: str) -> Predicate | None:
    """Return the predicate among whose arguments the noun is."""
    for predicate in predicates:
        if noun and any(_same(name, noun) for one in predicate.arguments if (name := _noun(one))):
            return predicate
        if any(one.pronoun in {"it", "one", "this", "that"} for one in predicate.arguments):
            return predicate
    return None


def _description(phrase: NounPhrase, depth: int) -> Description:
    """Return the description of one phrase, with those of the landmarks in it."""
    if depth > MAX_DEPTH:
        return Description("")
    if phrase.members:
        first, *others = (_description(one, depth + 1) for one in phrase.members)
        if phrase.joined_by == "or":
            return _of_either_noun(first, others)
        denied = [_denied(one) for one in others if one.negated and (not one.noun or _same(one.noun, first.noun))]
        return replace(
            first,
            properties=(*first.properties, *(prop for properties, _ in denied for prop in properties)),
            relations=(*first.relations, *(relation for _, relations in denied for relation in relations)),
        )
    head, inner = plain_noun(phrase.head).casefold(), None
    if phrase.of is not None:
        inner = _description(phrase.of, depth + 1)
    properties = [_property(one) for one in phrase.adjectives]
    more, relations = _constraints(phrase.predicates, depth + 1)
    noun, plural = "" if head in EMPTY else head, phrase.plural
    if noun in SIDE_NOUNS and inner is None:
        noun, properties = "", [*properties, Property("position", noun)]
    if inner is not None and noun in PLACES_AMONG and inner.plural:  # 'the middle of the three chairs'
        properties = [*properties, Property("position", noun)]
    if inner is not None and (not noun or noun in GROUPS | PARTS):
        plural = inner.plural and noun in GROUPS - {"one"}
        noun, properties = inner.noun, [*properties, *inner.properties]
        relations = (*relations, *inner.relations)
    elif inner is not None and inner.noun and inner.noun not in SURROUNDINGS:
        relations = (*relations, Relation("with", (inner,)))
    if phrase.owner is not None and not phrase.owner.pronoun:
        relations = (*relations, Relation("with", (_description(phrase.owner, depth + 1),)))
    count = phrase.count if phrase.plural or phrase.count else None
    properties_found = _ranked(_distinct((*properties, *more)))
    return Description(
        noun, properties_found, relations, count, phrase.negated, plural, anything=not noun and head in ANYTHING
    )


def _of_either_noun(first: Description, others: Sequence[Description]) -> Description:
    """Return the description of *the window or mirror by the bed*: what follows the last noun holds of each."""
    nouns = tuple(dict.fromkeys(one.noun for one in others if one.noun and one.noun != first.noun))
    last = others[-1]
    return replace(
        first,
        other_nouns=nouns,
        properties=_distinct((*first.properties, *last.properties)) if not first.properties else first.properties,
        relations=first.relations or last.relations,
    )


def _ranked(properties: Sequence[Property]) -> tuple[Property, ...]:
    """Return properties with *second* and *on the left* joined to *second from the left*.

    The last one on a side is the first one from it.
    """
    rank = next((one for one in properties if one.rank is not None and one.word not in ORDER_ENDS), None)
    side = next((one for one in properties if one.rank is None and one.positive and one.word in ORDER_ENDS), None)
    if rank is None or side is None or rank.rank is None:
        return tuple(properties)
    place = 1 if rank.rank == -1 else rank.rank
    joined = Property("rank", side.word, rank=place, positive=rank.positive)
    return tuple(joined if one is rank else one for one in properties if one is not side)


def _denied(description: Description) -> tuple[tuple[Property, ...], tuple[Relation, ...]]:
    """Return what *not the one next to the door* states; nothing if it denies several parts, of which one may hold."""
    if len(description.properties) + len(description.relations) != 1:
        return (), ()
    properties = tuple(replace(one, positive=not one.positive) for one in description.properties)
    return properties, tuple(replace(one, positive=not one.positive) for one in description.relations)


def _property(adjective: Adjective) -> Property:
    return Property(
        adjective.dimension, adjective.word.casefold(), str(adjective.degree), adjective.rank, adjective.positive
    )


def _constraints(predicates: Sequence[Predicate], depth: int) -> tuple[tuple[Property, ...], tuple[Relation, ...]]:
    """Return the properties and the relations that predicates state of their subject."""
    properties: list[Property] = []
    relations: list[Relation] = []
    for predicate in predicates:
        if depth > MAX_DEPTH:
            break
        arguments = [
            part
            for one in predicate.arguments
            for part in (one.members if one.members and one.joined_by != "or" else (one,))
        ]
        if not arguments:
            properties += _place(predicate)
            continue
        if predicate.relation == "kind":
            landmark = _description(arguments[0], depth + 1)
            if predicate.positive:
                properties, relations = [*properties, *landmark.properties], [*relations, *landmark.relations]
            else:
                for refused in (_denied(_description(one, depth + 1)) for one in arguments):
                    properties, relations = [*properties, *refused[0]], [*relations, *refused[1]]
            continue
        name = RENAMED.get(predicate.relation, predicate.relation)
        if predicate.value is not None and predicate.value.word in COMPARED:
            name = COMPARED[predicate.value.word]
        landmarks = [(one, _description(one, depth + 1)) for one in arguments]
        if name == "between" or (name == "middle" and (len(arguments) > 1 or arguments[0].plural)):
            landmark_pair = tuple(landmark for _, landmark in landmarks)
            relations.append(Relation("between", landmark_pair, positive=predicate.positive))
            continue
        for phrase, landmark in landmarks:
            more, others = _to_landmark(predicate, name, phrase, landmark, depth)
            properties, relations = [*properties, *more], [*relations, *others]
    return tuple(properties), tuple(relations)


def _to_landmark(
    predicate: Predicate, name: str, phrase: NounPhrase, landmark: Description, depth: int
) -> tuple[Sequence[Property], Sequence[Relation]]:
    """Return the properties and the relations that a predicate with a relation to one landmark states."""
    positive, degree = predicate.positive != (phrase.negated or phrase.determiner == "no"), str(predicate.degree)
    part = "" if predicate.subject_part is None else predicate.subject_part.head
    if name == "facing" and part in {"back", "rear"}:
        name = "near"  # 'with its back to the door': the door is right behind it
    if phrase.negated and phrase.pronoun == "one":  # 'the desk with the lamp, not the one with the screen'
        return _denied(replace(landmark, negated=False))
    if (person := _person(phrase)) is not None:
        return _from_person(replace(predicate, positive=positive), phrase, name, person), ()
    if landmark.noun == "wall" and landmark.relations:  # 'the wall with the window': the window says where
        placed = WALL_RELATIONS.get(name, name)
        return (), [replace(landmark.relations[0], name=placed, degree=degree, positive=positive, inverted=False)]
    if landmark.noun == "wall" and name in {*WALL_RELATIONS, "near", "far"} and _is_chosen(landmark, predicate):
        return (), [Relation(name, (landmark,), degree, positive)]
    if landmark.noun in SURROUNDINGS | {"wall"} | set(LEVELS) and (known := _surface(name, landmark.noun, positive)):
        return known, _on_surface(landmark, positive)
    if landmark.noun in SURROUNDINGS:
        own = tuple(  # 'on the right side of the room that is red'
            one for one in phrase.predicates if not one.arguments and one.relation in {"colour", "material"}
        )
        of_surface = _constraints(own, depth + 1)[0] if positive else ()
        return [*_place(replace(predicate, positive=positive)), *of_surface], _on_surface(landmark, positive)
    relations: list[Relation] = []
    mutual = [one for one in landmark.relations if one.inverted and one.arguments == (Description(""),)]
    if mutual and name != "between":  # 'the keyboard skewed to the monitor it is under'
        landmark = replace(landmark, relations=tuple(one for one in landmark.relations if one not in mutual))
        relations += [replace(one, arguments=(landmark,), inverted=False) for one in mutual]
    if name == "with" and (upon := [one for one in landmark.properties if one.word in UPON]):
        landmark = replace(landmark, properties=tuple(one for one in landmark.properties if one not in upon))
        return (), [*relations, Relation(UPON[upon[0].word], (landmark,), degree, positive, inverted=True)]
    return (), [*relations, Relation(name, (landmark,), degree, positive, predicate.reversed)]


def _person(phrase: NounPhrase) -> Person | None:
    """Return the person that *you*, *your side* or *the left of you* stands for; None for other phrases."""
    if phrase.pronoun is not None:
        return PERSONS.get(phrase.pronoun)
    owner = phrase.owner or phrase.of
    if owner is not None and owner.pronoun in PERSONS and phrase.head.casefold() in STANDPOINTS | PARTS:
        return PERSONS[owner.pronoun]
    return None


def _from_person(predicate: Predicate, phrase: NounPhrase, name: str, person: Person) -> list[Property]:
    """Return the properties that stand for a relation to a person: *closest to you*, *in front of me*."""
    word = FROM_PERSON.get(name)
    sides = [word for word in phrase.head.casefold().split() if word in {"left", "right"}]
    sides += [one.word for one in phrase.adjectives if one.word in {"left", "right"}]
    if word is None and not sides:
        return []
    rank = None if predicate.value is None else predicate.value.rank
    degree = str(predicate.degree)
    return [Property("position", side, degree, rank, predicate.positive, person) for side in sides or [word or "near"]]


def _is_chosen(wall: Description, predicate: Predicate) -> bool:
    """Return whether one wall is meant (*the green wall*, *closest to the wall*) rather than any."""
    return bool(wall.properties) or str(predicate.degree) != "plain"


def _surface(relation: str, noun: str, positive: bool) -> list[Property]:
    """Return the property that stands for a relation to a surface of the room, if there is one."""
    if noun in LEVELS:
        return [Property("height", LEVELS[noun], positive=positive)]
    if noun == "wall" and relation in {"against", "near", "next_to", "touching", "along", "on"}:
        return [Property("position", "wall", positive=positive)]
    return []


def _on_surface(surface: Description, positive: bool) -> list[Relation]:
    """Return what is said about a surface as relations of what is on it: *the shoes on the floor by the door*."""
    return [one for one in surface.relations if one.positive and not one.inverted] if positive else []


def _place(predicate: Predicate) -> list[Property]:
    """Return the properties of a predicate without a landmark: *on the left*, *red*, *second from the right*."""
    if predicate.relation == "ordinal":
        rank = predicate.value.rank if predicate.value is not None else 1
        words = (predicate.part or "left").split()
        return [Property("rank", words[-1], rank=rank, positive=predicate.positive)]
    if predicate.value is not None:
        return [replace(_property(predicate.value), positive=predicate.positive and predicate.value.positive)]
    words = (predicate.part or "").split() if predicate.relation in {"part", "side", "end"} else [predicate.relation]
    if predicate.relation in {"corner", "left", "right", "middle"} and predicate.part and predicate.part != "side":
        words = [predicate.relation, *predicate.part.split()]
    words = [part for word in words for part in (word.split("_") if word.startswith(("top_", "bottom_")) else [word])]
    known = {"in_front": "front", "behind": "back", "above": "high", "below": "low", "under": "low", "far": "far"}
    degree, owner = str(predicate.degree), predicate.viewpoint.own if predicate.viewpoint is not None else None
    person = None if owner is None else _person(owner)
    return [Property("position", known.get(word, word), degree, None, predicate.positive, person) for word in words]


def _viewers(sentence: Sentence) -> Iterator[Viewer]:
    if sentence.viewpoint is not None and (found := _viewer(sentence.viewpoint)) is not None:
        yield found
    phrases = [sentence.fragment] if sentence.fragment is not None else []
    predicates = [one for phrase in phrases for one in phrase.predicates]
    predicates += [one for clause in sentence.clauses for one in clause.predicates]
    for predicate in predicates:
        if predicate.viewpoint is not None and (found := _viewer(predicate.viewpoint)) is not None:
            yield found
        if predicate.relation == "from" and len(predicate.arguments) == 1:
            (phrase,) = predicate.arguments
            if (person := _person(phrase)) is not None:
                yield Viewer("person", Description(""), person=person)


def _viewer(viewpoint: Viewpoint) -> Viewer | None:
    """Return the viewer of a viewpoint; None for one that gives no direction."""
    for phrase in (viewpoint.own, viewpoint.at):
        if phrase is not None and (person := _person(phrase)) is not None:
            return Viewer("person", Description(""), person=person)
    at = viewpoint.at if viewpoint.at is not None and _noun(viewpoint.at) not in SURROUNDINGS | {""} else None
    facing = (
        viewpoint.facing
        if viewpoint.facing is not None and _noun(viewpoint.facing) not in SURROUNDINGS | {""}
        else None
    )
    if facing is not None:
        if at is not None and not viewpoint.entering:
            return Viewer("towards", _description(at, 1), _description(facing, 1))
        return Viewer("facing", _description(facing, 1))
    if viewpoint.back is not None and _noun(viewpoint.back):
        return Viewer("from", _description(viewpoint.back, 1))
    if at is not None:
        return Viewer("entering" if viewpoint.entering else "from", _description(at, 1))
    if viewpoint.own is not None and _noun(viewpoint.own):
        return Viewer("own", _description(viewpoint.own, 1))
    return None


def _distinct(items: Sequence[Item]) -> tuple[Item, ...]:
    return tuple(dict.fromkeys(items))
