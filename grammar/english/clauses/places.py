"""Read places: *to the left of the plate*, *in the far left corner of the tray*, *on each side*, *at its 3 o'clock*."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import Relator
from deixis.grammar.english.tree import Adjective, Degree, NounPhrase, Predicate, Span, Viewpoint
from deixis.grammar.english.vocabulary.nouns import EVENTS, PEOPLE, SURFACES, last_word
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS

_ROWS = {
    "row": "row",
    "line": "row",
    "column": "row",
    "series": "row",
    "circle": "circle",
    "ring": "circle",
    "semicircle": "circle",
    "stack": "stacked",
    "pile": "stacked",
    "horizontal line": "row",
    "vertical line": "row",
}
_DIRECTIONS = {
    **{"north": "top", "south": "bottom", "west": "left", "east": "right", "low": "bottom", "high": "top"},
    **{
        "upper": "top",
        "lower": "bottom",
        "rear": "back",
        "distant": "far",
        "downstage": "near",
        "upstage": "far",
        "up": "top",
        "down": "bottom",
    },
}
_SIDES = ("left", "right", "top", "bottom", "front", "back", "far", "near", "middle", "other", "opposite")
_BINARY = {"front": "in_front", "back": "behind"}
HOURS = {12: "top", 3: "right", 6: "bottom", 9: "left", 1: "top_right", 2: "top_right", 4: "bottom_right",
          5: "bottom_right", 7: "bottom_left", 8: "bottom_left", 10: "top_left", 11: "top_left"}  # fmt: skip
_FLAT = frozenset({"door", "lid", "wall", "window", "flap", "cover", "panel", "screen", "shutter", "gate"})
"""Nouns of flat things, whose inside is the side that faces in."""
_STARTS = frozenset({"start", "beginning"})
"""Nouns of the end of a thing at which people come to it first: *at the start of the buffet*."""
_ON = frozenset({"on", "inside", "at", "to", "along"})
GENERAL_OWNERS = frozenset({"you", "me", "we"})


def is_place(phrase: NounPhrase) -> bool:
    """Return True if the head names a place or a direction: *the far left corner*, *the left*, *its back*.

    Parameters
    ----------
    phrase
        Noun phrase.

    Returns
    -------
    bool
        True for a part of a thing or of the table; False for an object and for a coordination.
    """
    if not phrase.head or phrase.members:
        return False
    return (
        phrase.head in PLACE_NOUNS
        or phrase.head == "o'clock"
        or (phrase.head in _STARTS and phrase.of is not None and phrase.of.head not in EVENTS)
        or (arrangement_of(phrase) is not None and phrase.determiner in (None, "a", "an", "one"))
    )


def arrangement_of(phrase: NounPhrase) -> str | None:
    """Return the relation of *a row*, and of *concentric circles*, where another word stands before a plural.

    Parameters
    ----------
    phrase
        Noun phrase.

    Returns
    -------
    str or None
        ``row``, ``circle`` or ``stacked``; None for a phrase that names no arrangement.
    """
    return _ROWS.get(phrase.head) or (_ROWS.get(last_word(phrase.head)) if phrase.plural else None)


def directions_of(phrase: NounPhrase) -> tuple[str, ...]:
    """Return the directions among the adjectives of a place, in order: *far left*.

    Parameters
    ----------
    phrase
        Noun phrase that names a place.

    Returns
    -------
    tuple of str
        Directions as the layout language names them.
    """
    found = []
    for adjective in phrase.adjectives:
        word = _DIRECTIONS.get(adjective.word, adjective.word)
        if word in _SIDES:
            found.append(word)
    return tuple(found)


def place(relator: Relator, phrase: NounPhrase, span: Span) -> Predicate | None:
    """Return the predicate of a preposition and a place; None if the phrase is not a place.

    Parameters
    ----------
    relator
        Preposition with its adverbs.
    phrase
        Noun phrase after the preposition.
    span
        Place of both in the text.

    Returns
    -------
    Predicate or None
        Predicate such as *corner* of the tray with the part *far left*.
    """
    relation = relator.preposition.relation
    if not is_place(phrase) or relation not in _ON:
        return None
    head = phrase.head
    row = None if head in PLACE_NOUNS else arrangement_of(phrase)
    if row is not None and relation == "on" and phrase.of is None:
        return None  # 'kettle on back ring'
    if head in _STARTS:
        return _made(relator, "end", _owner(phrase), span, part="start")
    if head == "o'clock":
        return _made(relator, HOURS.get(phrase.count or 0, "top"), _owner(phrase), span, value=_clock(phrase))
    if row == "stacked" and relation == "on" and phrase.of is not None:
        return _made(relator, "on", (phrase.of,), span)  # 'on a pile of letters'
    if row is not None:
        of = () if phrase.of is None else (phrase.of,)
        return _made(relator, row, of, span)
    if phrase.count is not None and phrase.of is not None and phrase.of.head.startswith("clock"):
        return _made(relator, HOURS.get(phrase.count, "top"), (), span, value=_clock(phrase))
    kind = PLACE_NOUNS[head]
    sides = directions_of(phrase)
    arguments, own = _owner(phrase), _own(phrase)
    superlative = any(a.degree is Degree.SUPERLATIVE and a.word in ("far", "left", "right") for a in phrase.adjectives)
    if head == "end" and not sides and phrase.owner is not None and relation == "on" and phrase.of is None:
        standing = Adjective("on end", "state", Degree.PLAIN, phrase.span)  # 'place the sofas on their ends'
        return _made(relator, "state", (), span, value=standing) if phrase.owner.pronoun in ("it", "they") else None
    if kind in ("side", "part", "corner") and "o'clock" not in head:
        sided = _sided(relator, kind, head, sides, phrase, arguments, span, own)
        if sided is not None:
            return sided
    if kind in ("corner", "edge", "end", "middle", "side", "part"):
        part = " ".join(sides) or None
        if kind == "middle" and sides:
            kind = "middle"
        return _made(relator, kind, arguments, span, part=part, viewpoint=own)
    if kind in ("inside", "outside"):
        flat = bool(arguments) and all(last_word(argument.head) in _FLAT for argument in arguments)
        return _made(relator, "on" if flat else kind, arguments, span)  # 'on the inside of the door'
    return _direction(relator, (*sides, *kind.split()), arguments, span, own, superlative)


def _sided(
    relator: Relator, kind: str, head: str, sides: tuple[str, ...], phrase: NounPhrase,
    arguments: tuple[NounPhrase, ...], span: Span, own: Viewpoint | None,
) -> Predicate | None:  # fmt: skip
    """Return the predicate of *on each side*, *on the left side*, *in the right direction*, *on the other side*."""
    if kind == "corner":
        return None
    if kind == "side" and phrase.plural and sides == ("opposite",):
        return _made(relator, "each_side", arguments, span)
    if kind == "side" and (phrase.determiner in ("each", "either", "both") or (phrase.plural and phrase.count == 2)):
        return _made(relator, "each_side", arguments, span)
    if sides in (("opposite",), ("other",)) or (sides == ("far",) and kind == "side"):
        if arguments and sides != ("far",):
            return _made(relator, "opposite", arguments, span)
        return _made(relator, kind, arguments, span, part=sides[0])
    if kind == "side" and not sides and phrase.owner is not None and phrase.owner.pronoun in ("it", "they"):
        lying = Adjective("sideways", "state", Degree.PLAIN, phrase.span)
        return _made(relator, "state", (), span, value=lying)
    if kind == "side" and not sides and phrase.owner is not None and last_word(phrase.owner.head) in PEOPLE:
        return _made(relator, "side", (), span)
    if kind == "side" and not sides:
        return _made(
            relator,
            "side"
            if phrase.owner is not None and phrase.of is not None
            else "next_to"
            if relator.preposition.relation in ("at", "to", "near") or not arguments
            else "side",
            arguments,
            span,
        )
    if head == "position" and not sides and phrase.adjectives and phrase.adjectives[0].dimension != "other":
        return _made(relator, "state", (), span, value=phrase.adjectives[0])
    if head in ("direction", "position") or kind == "side":
        pure = tuple(s for s in sides if s in ("left", "right", "top", "bottom", "front", "back"))
        if pure and pure == sides:
            if kind == "side" and arguments and sides[0] in ("front", "back"):
                return _made(relator, "part", arguments, span, part=sides[0], viewpoint=own)
            found = _direction(relator, sides, arguments, span, own, False, wide=True)
            return replace(found, part="side") if kind == "side" and head == "side" else found
    return None


def other_side(relator: Relator, thing: NounPhrase, span: Span) -> Predicate:
    """Return the predicate of *on the other side of the plate*, and of *… from the knife*.

    Parameters
    ----------
    relator
        Preposition with its adverbs.
    thing
        Thing whose side is meant.
    span
        Place of the phrase in the text.

    Returns
    -------
    Predicate
        *Opposite* of what stands after *from*; else a side of a table or another surface, which is on it, and
        *opposite* of another thing.
    """
    bare = replace(thing, predicates=())
    beyond = next((p for p in thing.predicates if p.relation == "from" and p.arguments), None)
    if beyond is not None:
        return _made(relator, "opposite", beyond.arguments, span)
    if last_word(thing.head) in SURFACES:
        return _made(relator, "side", (bare,), span, part="other")
    return _made(relator, "opposite", (bare,), span)


def _direction(
    relator: Relator, sides: tuple[str, ...], arguments: tuple[NounPhrase, ...], span: Span, own: Viewpoint | None,
    superlative: bool, wide: bool = False,
) -> Predicate:  # fmt: skip
    """Return the predicate of a direction: *to the upper left of X*, *on the left*, *at the back of X*."""
    relation = relator.preposition.relation
    sides = tuple(dict.fromkeys(sides))
    degree = Degree.SUPERLATIVE if superlative else Degree.PLAIN
    if sides == ("top",) and relation == "on" and arguments:
        return _made(relator, "on", arguments, span)
    vertical = [s for s in sides if s in ("top", "bottom")]
    lateral = [s for s in sides if s in ("left", "right")]
    if len(vertical) == 1 and len(lateral) == 1 and len(sides) == 2:
        return _made(relator, f"{vertical[0]}_{lateral[0]}", arguments, span, viewpoint=own, degree=degree)
    if len(sides) > 1:
        shown = [s for s in sides if not (superlative and s == "far")]
        if len(shown) == 1 or superlative:
            return _made(relator, shown[-1], arguments, span, viewpoint=own, degree=Degree.SUPERLATIVE)
        return _made(relator, "part", arguments, span, part=" ".join(sides), viewpoint=own)
    side = sides[0]
    if side in ("left", "right") or relation == "to" or wide:
        here = None if arguments or relation == "to" or wide else side
        return _made(relator, _BINARY.get(side, side), arguments, span, part=here, viewpoint=own, degree=degree)
    if not arguments and side in ("top", "bottom"):
        return _made(relator, side, arguments, span, part=side, viewpoint=own)
    return _made(relator, "part", arguments, span, part=side, viewpoint=own)


def _made(
    relator: Relator, relation: str, arguments: tuple[NounPhrase, ...], span: Span, *, part: str | None = None,
    viewpoint: Viewpoint | None = None, value: Adjective | None = None, degree: Degree = Degree.PLAIN,
) -> Predicate:  # fmt: skip
    return Predicate(
        relation, arguments, span, value=value, part=part, degree=degree, adverbs=relator.adverbs,
        positive=relator.positive, viewpoint=viewpoint,
    )  # fmt: skip


def _owner(phrase: NounPhrase) -> tuple[NounPhrase, ...]:
    if phrase.of is not None:
        return (phrase.of,)
    if phrase.owner is not None and phrase.owner.pronoun not in GENERAL_OWNERS:
        return (phrase.owner,)
    return ()


def _own(phrase: NounPhrase) -> Viewpoint | None:
    owner = phrase.owner
    return None if owner is None or owner.pronoun == "it" else Viewpoint(owner.span, own=owner)


def _clock(phrase: NounPhrase) -> Adjective:
    return Adjective(str(phrase.count), "clock", Degree.PLAIN, phrase.span, rank=phrase.count)
