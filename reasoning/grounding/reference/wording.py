"""Say a query in English."""

from __future__ import annotations

from deixis.ontology.inflection import plural
from deixis.ontology.things.kinds import with_article
from deixis.reasoning.grounding.reference.query import Description, Person, Property, Query, Relation, Viewer

WORDS = {
    "left": "to the left of",
    "right": "to the right of",
    "in_front": "in front of",
    "near": "near",
    "far": "far from",
    "inside": "in",
    "back_to": "with its back to",
    "middle": "in the middle of",
    "corner": "at the corner of",
    "edge": "at the edge of",
    "end": "at the end of",
    "side": "at the side of",
    "part": "at",
    "bigger": "bigger than",
    "smaller": "smaller than",
    "taller": "taller than",
    "shorter": "shorter than",
    "longer": "longer than",
    "wider": "wider than",
    "pointing": "pointing to",
    "leaning": "leaning on",
    "stacked": "stacked on",
    "parallel": "parallel to",
    "aligned": "aligned with",
    "farthest": "farthest from",
    "nearest": "closest to",
    "closer": "closer to",
}
"""Prepositions of relations that are not said by their own names."""

DEGREES = {
    ("near", "superlative"): "closest to",
    ("near", "comparative"): "closer to",
    ("far", "superlative"): "farthest from",
    ("far", "comparative"): "farther from",
}

PRONOUNS = {Person.SPEAKER: ("me", "my"), Person.ADDRESSEE: ("you", "your")}

ORDINALS = {1: "first", 2: "second", 3: "third", 4: "fourth", 5: "fifth", -1: "last"}

PLACES = {
    "alone": "by itself",
    "corner": "in the corner",
    "wall": "against a wall",
    "middle": "in the middle",
    "back": "at the back",
    "left": "on the left",
    "right": "on the right",
    "front": "at the front",
    "far": "at the far side",
    "near": "at the near side",
    "high": "high up",
    "low": "low down",
}


def paraphrase(query: Query) -> str:
    """Return what a query says about the object, as a noun phrase with its viewer.

    Parameters
    ----------
    query
        The query.

    Returns
    -------
    str
        The noun phrase.

    Examples
    --------
    >>> desk = Description("desk", relations=(Relation("with", (Description("monitor"),)),))
    >>> paraphrase(Query(Description("chair", (Property("colour", "red"),), (Relation("left", (desk,)),))))
    'the red chair to the left of the desk with the monitor'
    """
    phrase = noun_phrase(query.target)
    return phrase if query.viewer is None else f"{_viewer(query.viewer)}, {phrase}"


def noun_phrase(description: Description) -> str:
    """Return a description as a noun phrase.

    Parameters
    ----------
    description
        The description.

    Returns
    -------
    str
        The noun phrase with the definite article.
    """
    before = [_adjective(one) for one in description.properties if one.positive and not _is_place(one)]
    after = [_place(one) for one in description.properties if one.positive and _is_place(one)]
    after += [f"not {_adjective(one)}" for one in description.properties if not one.positive]
    after += [_relation(one) for one in description.relations]
    count = "" if description.count is None or description.count < 2 else f"{description.count} "
    many = description.plural or bool(count)
    nouns = [plural(noun) if many and noun else noun for noun in description.nouns]
    named_by = " or ".join(nouns) or ("ones" if many else "one")
    phrase = " ".join(["the", f"{count}{' '.join([*before, named_by])}", _joined(after)])
    return phrase.strip()


def _is_place(prop: Property) -> bool:
    if prop.person is not None:
        return True
    return prop.dimension in {"position", "rank"} and prop.degree == "plain"


def _joined(parts: list[str]) -> str:
    return " and ".join(parts)


def _adjective(prop: Property) -> str:
    if prop.degree == "superlative" and prop.word not in {"leftmost", "rightmost"}:
        return _graded(prop.word, "est")
    return _graded(prop.word, "er") if prop.degree == "comparative" else prop.word


def _graded(word: str, ending: str) -> str:
    irregular = {("far", "est"): "farthest", ("far", "er"): "farther", ("left", "est"): "leftmost"}
    irregular |= {("right", "est"): "rightmost", ("little", "est"): "smallest", ("little", "er"): "smaller"}
    if (word, ending) in irregular:
        return irregular[word, ending]
    stem = word[:-1] if word.endswith("e") else word
    if len(word) == 3 and word[-1] in "bgntd" and word[-2] in "aeiou":
        stem = word + word[-1]
    return stem + ending


def _place(prop: Property) -> str:
    if prop.person is not None:
        return _from_person(prop, prop.person)
    if prop.rank is not None:
        side = f"{prop.word} side" if prop.word in {"far", "near"} else prop.word
        return f"that is {ORDINALS.get(prop.rank, f'number {prop.rank}')} from the {side}"
    return PLACES.get(prop.word, f"at the {prop.word}")


def _from_person(prop: Property, person: Person) -> str:
    """Return a place as a person sees it: *closest to you*, *second closest to me*, *on your left*."""
    person_word, whose = PRONOUNS[person]
    if prop.word in {"near", "far"}:
        degree = "superlative" if prop.rank is not None and prop.degree == "plain" else prop.degree
        near = DEGREES.get((prop.word, degree), {"near": "near", "far": "far from"}[prop.word])
        rank = "" if prop.rank in {None, 1} else f"{ORDINALS.get(prop.rank or 0, f'number {prop.rank}')} "
        return f"{rank}{near} {person_word}"
    if prop.rank is not None:
        return f"that is {ORDINALS.get(prop.rank, f'number {prop.rank}')} from {whose} {prop.word}"
    far = "far " if prop.degree == "superlative" else ""
    return f"on {whose} {far}{prop.word}" if prop.word in {"left", "right"} else f"at {whose} {prop.word}"


def _relation(relation: Relation) -> str:
    place = WORDS.get(relation.name, relation.name.replace("_", " "))
    name = DEGREES.get((relation.name, relation.degree), place)
    phrase = _joined([noun_phrase(one) for one in relation.arguments])
    if relation.inverted:
        return f"{'with' if relation.positive else 'without'} {phrase} {place} it"
    return f"{'' if relation.positive else 'not '}{name} {phrase}"


def _viewer(viewer: Viewer) -> str:
    if viewer.person is not None:
        return f"from {PRONOUNS[viewer.person][1]} point of view"
    landmark = noun_phrase(viewer.landmark)
    if viewer.stance == "towards" and viewer.target is not None:
        return f"looking from {landmark} to {noun_phrase(viewer.target)}"
    return {
        "facing": f"facing {landmark}",
        "entering": f"coming in through {landmark}",
        "own": f"as seen by {landmark}",
    }.get(viewer.stance, f"from {landmark}")


def named(noun: str) -> str:
    """Return a noun with its indefinite article, ``an object`` where there is none.

    Parameters
    ----------
    noun
        The noun; empty if there is none.

    Returns
    -------
    str
        Words such as *a chair*.
    """
    return with_article(noun or "object")
