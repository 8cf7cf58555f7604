"""Say a query in English."""

from __future__ import annotations

from deixis.ontology.inflection import plural
from deixis.ontology.kinds import with_article
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
    """Return what a query says of the object, as a noun phrase with its viewer.

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
    said = noun_phrase(query.target)
    return said if query.viewer is None else f"{_viewer(query.viewer)}, {said}"


def noun_phrase(said: Description) -> str:
    """Return a description as a noun phrase.

    Parameters
    ----------
    said
        The description.

    Returns
    -------
    str
        The noun phrase with the definite article.
    """
    before = [_adjective(one) for one in said.properties if one.positive and not _is_place(one)]
    after = [_place(one) for one in said.properties if one.positive and _is_place(one)]
    after += [f"not {_adjective(one)}" for one in said.properties if not one.positive]
    after += [_relation(one) for one in said.relations]
    count = "" if said.count is None or said.count < 2 else f"{said.count} "
    many = said.plural or bool(count)
    nouns = [plural(noun) if many and noun else noun for noun in said.nouns]
    named_by = " or ".join(nouns) or ("ones" if many else "one")
    phrase = " ".join(["the", f"{count}{' '.join([*before, named_by])}", _joined(after)])
    return phrase.strip()


def _is_place(said: Property) -> bool:
    if said.person is not None:
        return True
    return said.dimension in {"position", "rank"} and said.degree == "plain"


def _joined(parts: list[str]) -> str:
    return " and ".join(parts)


def _adjective(said: Property) -> str:
    if said.degree == "superlative" and said.word not in {"leftmost", "rightmost"}:
        return _graded(said.word, "est")
    return _graded(said.word, "er") if said.degree == "comparative" else said.word


def _graded(word: str, ending: str) -> str:
    irregular = {("far", "est"): "farthest", ("far", "er"): "farther", ("left", "est"): "leftmost"}
    irregular |= {("right", "est"): "rightmost", ("little", "est"): "smallest", ("little", "er"): "smaller"}
    if (word, ending) in irregular:
        return irregular[word, ending]
    stem = word[:-1] if word.endswith("e") else word
    if len(word) == 3 and word[-1] in "bgntd" and word[-2] in "aeiou":
        stem = word + word[-1]
    return stem + ending


def _place(said: Property) -> str:
    if said.person is not None:
        return _from_person(said, said.person)
    if said.rank is not None:
        side = f"{said.word} side" if said.word in {"far", "near"} else said.word
        return f"that is {ORDINALS.get(said.rank, f'number {said.rank}')} from the {side}"
    return PLACES.get(said.word, f"at the {said.word}")


def _from_person(said: Property, person: Person) -> str:
    """Return a place as a person sees it: *closest to you*, *second closest to me*, *on your left*."""
    whom, whose = PRONOUNS[person]
    if said.word in {"near", "far"}:
        degree = "superlative" if said.rank is not None and said.degree == "plain" else said.degree
        near = DEGREES.get((said.word, degree), {"near": "near", "far": "far from"}[said.word])
        rank = "" if said.rank in {None, 1} else f"{ORDINALS.get(said.rank or 0, f'number {said.rank}')} "
        return f"{rank}{near} {whom}"
    if said.rank is not None:
        return f"that is {ORDINALS.get(said.rank, f'number {said.rank}')} from {whose} {said.word}"
    far = "far " if said.degree == "superlative" else ""
    return f"on {whose} {far}{said.word}" if said.word in {"left", "right"} else f"at {whose} {said.word}"


def _relation(said: Relation) -> str:
    place = WORDS.get(said.name, said.name.replace("_", " "))
    name = DEGREES.get((said.name, said.degree), place)
    phrase = _joined([noun_phrase(one) for one in said.arguments])
    if said.inverted:
        return (
            f"{'with' if said.positive else 'without'} {phrase} {WORDS.get(said.name, said.name.replace('_', ' '))} it"
        )
    return f"{'' if said.positive else 'not '}{name} {phrase}"


def _viewer(said: Viewer) -> str:
    if said.person is not None:
        return f"from {PRONOUNS[said.person][1]} point of view"
    landmark = noun_phrase(said.landmark)
    if said.stance == "towards" and said.target is not None:
        return f"looking from {landmark} to {noun_phrase(said.target)}"
    return {
        "facing": f"facing {landmark}",
        "entering": f"coming in through {landmark}",
        "own": f"as seen by {landmark}",
    }.get(said.stance, f"from {landmark}")


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
