"""Phrases that state claims in the layout language: their patterns, what each means, and how a claim is written.

A claim is what is not a relation between two objects (:mod:`deixis.ontology.graph.claims`): a place (*at the far left
corner*), an arrangement (*in a row*), a distance (*about 2 cm from*), a comparison with several (*between*, *largest
of*). A phrase stands for the term of the claim, its value and its metres. Some phrases are followed by objects.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from deixis.grammar.layout.words import BETWEEN, BOUNDARY, by_first_word
from deixis.ontology.graph.claims import COLLECTIVE, PLACES, SUPERLATIVES, Claim
from deixis.ontology.lexicon.adjectives import adjectives
from deixis.ontology.relations.relation import ARTICLES

SIDES = (
    *("left", "right", "far", "near", "front", "back", "top", "bottom", "upper", "lower", "rear", "above", "below"),
    *("middle", "central", "other", "opposite"),
)
PLACE_NOUNS = {
    **{place: place for place in ("corner", "edge", "end", "side", "part", "middle")},
    **dict.fromkeys(("centre", "center"), "middle"),
    **dict.fromkeys(("half", "area"), "part"),
}
DIRECTIONS = (
    *SIDES,
    *("forward", "forwards", "backward", "backwards", "up", "down", "upward", "downward", "sideways", "away", "viewer"),
)
PARTS = {
    **dict.fromkeys(("blade", "edge"), "facing"),
    **dict.fromkeys(("tines", "prongs", "tip", "bowl", "head", "spout", "mouth", "nib", "bristles"), "pointing"),
    **dict.fromkeys(("front", "face", "screen"), "pointing"),
    **dict.fromkeys(("handle", "grip"), "pointing"),
}
"""Parts whose direction is stated (*with its blade to the plate*), and the term of the claim.

A blade faces what its edge is turned to; its tip need not point there.
"""

PREPOSITIONS = ("at", "in", "on", "along")
"""Prepositions of places."""

AIMS = ("pointing", "facing")

TOWARD = ("to", "toward", "towards", "at")
"""Prepositions between a part and where it points."""

RANKS = {
    word: rank
    for rank, word in enumerate(
        ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"), start=1
    )
} | {"last": -1}
UNITS = {
    **dict.fromkeys(("mm", "millimetre", "millimetres", "millimeter", "millimeters"), 1000),
    **dict.fromkeys(("cm", "centimetre", "centimetres", "centimeter", "centimeters"), 100),
    **dict.fromkeys(("m", "metre", "metres", "meter", "meters"), 1),
}
"""Number of units in a metre."""

DISTANCES = {
    "distance": ("about", "roughly", "around", "approximately", ""),
    "distance_less": ("at most", "within", "less than", "no more than"),
    "distance_more": ("at least", "more than", "no less than"),
}
EACH_OTHER = {
    "near_each_other": ("near", "next to"),
    "touching_each_other": ("touching",),
    "parallel_each_other": ("parallel to",),
    "nested": ("inside",),
}
ARRANGEMENTS = {"row": "row", "line": "row", "circle": "circle", "ring": "circle", "stack": "stacked"}
NEAREST = {
    **dict.fromkeys(("nearest to", "closest to"), "nearest"),
    **dict.fromkeys(("farthest from", "furthest from"), "farthest"),
}
CLOSER = {
    **dict.fromkeys(("closer to", "nearer to"), "closer"),
    **dict.fromkeys(("farther from", "further from"), "farther"),
}
PROPERTIES = (
    *("colour", "size", "shape", "material", "state", "contents", "count", "kind"),
    *("height", "length", "width", "thickness"),
)
"""Claims about one property of an object, with a word as value."""

ADJECTIVE_PROPERTIES = ("size", "shape", "material", "state", "height", "length", "width", "thickness")
STATES = (*SUPERLATIVES, "empty", "open", "closed", "alone", "nested", "stacked")
"""Claims without a value that are said by one adjective; *upside down* has two words."""


@dataclass(frozen=True, slots=True)
class Phrase:
    """Meaning of a phrase: the term of a claim, its value, and its distance in metres."""

    term: str
    value: str | None = None
    metres: float | None = None


def _words(*phrases: str) -> str:
    """Return the pattern of one of the phrases, longer ones first."""
    found = sorted(set(phrases), key=lambda phrase: (-len(phrase), phrase))
    return f"(?:{'|'.join(BETWEEN.join(map(re.escape, phrase.split())) for phrase in found)})"


_SIDED = f"(?:{_words(*SIDES)}(?>(?:[ \\t_-]+{_words(*SIDES)})*){BOUNDARY})"
_ARTICLE = r"(?>(?:(?:the|an|a)[ \t_]+)?)"
_NOUN = _words(*PLACE_NOUNS)
_REGION = f"(?:{_SIDED}{BETWEEN})?{_words('edge', 'end', 'side', 'corner')}"
_NOT_OF = f"(?!{BETWEEN}of{BOUNDARY})"
_WHICH = f"{BETWEEN}(?>(?:any{BETWEEN})?)(?:{_SIDED}{BETWEEN})?"
_MIDDLE_OF_SIDE = (
    f"{_words('middle', 'centre', 'center')}{BETWEEN}of{BETWEEN}{_SIDED}"
    f"(?>(?:{BETWEEN}{_words('edge', 'end', 'side')})?)"
)
_PLACE = f"{_words(*PREPOSITIONS)}{_WHICH}(?:{_MIDDLE_OF_SIDE}|{_NOUN})"
_PLACE_OF = (  # others, as 'in the middle of' and 'on the left side of', are relations
    f"(?:at{_WHICH}(?:{_MIDDLE_OF_SIDE}|{_NOUN})"
    f"|{_words('in', 'on', 'along')}{_WHICH}{_words('corner', 'edge', 'end')})"
)
_EACH_OTHER = tuple(phrase for phrases in EACH_OTHER.values() for phrase in phrases)
_BETWEEN = ("between", "among", "in between")
_BOUNDS = tuple(bound for bounds in DISTANCES.values() for bound in bounds if bound)
_SUPERLATIVE = f"{_ARTICLE}{_words(*SUPERLATIVES)}"
_RANK = f"{_ARTICLE}(?:{_words(*RANKS)}|[1-9][0-9]?(?:st|nd|rd|th)){BETWEEN}from{BETWEEN}{_SIDED}"
_PARALLEL = f"parallel{BETWEEN}{_words('to', 'with')}{BETWEEN}{_REGION}"
_CLOSER_TO_REGION = f"{_words(*CLOSER)}{BETWEEN}{_REGION}"
_WITH_PART = (
    f"with{BETWEEN}(?>(?:its{BETWEEN})?){_words(*PARTS)}{BETWEEN}"
    f"(?>(?:{_words('pointing', 'facing', 'turned')}{BETWEEN})?)"
)
_TO = _words(*TOWARD)
_DISTANCE = (
    f"(?>(?:{_words(*_BOUNDS)}{BETWEEN})?)"
    rf"(?>[0-9]+(?:\.[0-9]+)?[ \t]*){_words(*UNITS)}(?:{BETWEEN}away)?{BETWEEN}from"
)

_CLAIMS = (
    (PREPOSITIONS, f"(?>{_PLACE}){BOUNDARY}{_NOT_OF}"),
    (("at",), f"(?>at{BETWEEN}{_SIDED}){_NOT_OF}(?!{BETWEEN}{_NOUN}{BOUNDARY})"),
    (("on",), f"on{BETWEEN}surface{BOUNDARY}"),
    (("in",), f"in{BETWEEN}row{BETWEEN}from{BETWEEN}{_SIDED}{BETWEEN}to{BETWEEN}{_SIDED}"),
    (("in",), f"in{BETWEEN}{_words(*ARRANGEMENTS)}{BOUNDARY}{_NOT_OF}"),
    (_EACH_OTHER, f"{_words(*_EACH_OTHER)}{BETWEEN}each{BETWEEN}other{BOUNDARY}"),
    (AIMS, f"(?>{_words(*AIMS)}{BETWEEN}(?>(?:{_words('to', 'toward', 'towards')}{BETWEEN})?)"
           f"{_words(*DIRECTIONS)}){BOUNDARY}{_NOT_OF}"),
    (("with",), f"(?>{_WITH_PART}(?>(?:{_TO}{BETWEEN})?){_words(*DIRECTIONS)}){BOUNDARY}{_NOT_OF}"),
    (("parallel",), f"(?>{_PARALLEL}){BOUNDARY}{_NOT_OF}"),
    (CLOSER, f"(?>{_CLOSER_TO_REGION}){BOUNDARY}{_NOT_OF}"),
    ((*ARTICLES, *RANKS, ""), f"(?>{_RANK}){_NOT_OF}"),
    ((*ARTICLES, *SUPERLATIVES), f"{_SUPERLATIVE}{BETWEEN}at{BETWEEN}{_SIDED}"),
    (("upside",), f"upside{BETWEEN}down{BOUNDARY}"),
)  # fmt: skip
_CLAIMS_OF = (
    (PREPOSITIONS, f"(?>{_PLACE_OF}){BETWEEN}of{BOUNDARY}"),
    (_BETWEEN, f"{_words(*_BETWEEN)}{BOUNDARY}"),
    (("on",), f"on{BETWEEN}{_words('each side', 'either side', 'both sides')}{BETWEEN}of{BOUNDARY}"),
    ((*ARTICLES, *SUPERLATIVES), f"{_SUPERLATIVE}{BETWEEN}of{BOUNDARY}"),
    ((*ARTICLES, *RANKS, ""), f"{_RANK}{BETWEEN}of{BOUNDARY}"),
    ((*ARTICLES, *NEAREST), f"{_ARTICLE}{_words(*NEAREST)}{BOUNDARY}"),
    (("parallel",), f"(?>{_PARALLEL}){BETWEEN}of{BOUNDARY}"),
    (CLOSER, f"{_words(*CLOSER)}{BOUNDARY}"),
    (("with",), f"{_WITH_PART}{_TO}{BOUNDARY}"),
    ((*_BOUNDS, ""), f"{_DISTANCE}{BOUNDARY}"),
)
"""Patterns of claims, each with the phrases that it begins with; an empty one stands for a number."""


CLAIM_PATTERNS, CLAIM_OF_PATTERNS = by_first_word(_CLAIMS), by_first_word(_CLAIMS_OF)
"""Regular expressions of the phrases that no object follows, and of those that objects follow, by first word."""

CLAIM_PATTERN, CLAIM_OF_PATTERN = ("|".join(pattern for _, pattern in claims) for claims in (_CLAIMS, _CLAIMS_OF))
"""Regular expressions of all such phrases."""

HAS = ("has", "have")
HAS_PATTERN = f"{_words(*HAS)}{BETWEEN}{_words(*PROPERTIES, 'color')}{BOUNDARY}"
"""Regular expression of the phrases that the value of a property follows."""

COMMON_PHRASES = (
    *("between", "among", *NEAREST, *CLOSER, "in a row", "in a circle", "near each other", "touching each other"),
    *("at the left", "at the right", "in the middle", "on each side of", "upside down"),
    *(f"at the {side} {noun}" for side in ("left", "right", "near", "far") for noun in ("edge", "end", "side")),
    *(f"at the {depth} {side} corner" for depth in ("near", "far") for side in ("left", "right")),
)
"""Phrases that are suggested for misspelt ones."""

PHRASE_STARTS = frozenset(
    phrase.split()[0]
    for phrase in (*NEAREST, *CLOSER, *RANKS, *SUPERLATIVES, *EACH_OTHER["parallel_each_other"], "pointing", "upside")
)
"""Words that can be names, but begin a phrase that relates them."""


def meaning(phrase: str) -> Phrase:
    """Return what a phrase means that one of the patterns matches.

    Parameters
    ----------
    phrase
        Phrase of the language without its objects, such as ``at the far left corner of``. It must match a pattern of
        the language.

    Returns
    -------
    Phrase
        Term of the claim, its value, and its distance in metres.

    Examples
    --------
    >>> meaning("at the far-left corner of"), meaning("about 2 cm away from").metres
    (Phrase(term='corner', value='far left', metres=None), 0.02)
    >>> meaning("with its handle to the right"), meaning("with its blade to").term
    (Phrase(term='pointing', value='handle right', metres=None), 'facing')
    >>> meaning("in a row from left to right").value, meaning("the 2nd from the left of").value
    ('left to right', '2 from left')
    """
    words = [word for word in re.split(r"[ \t_-]+", phrase.casefold()) if word and word not in ARTICLES]
    if words[0] in HAS:
        return Phrase("colour" if words[1] == "color" else words[1])
    if words[-1] == "of":
        words.pop()
    text = " ".join(words)
    if text in ("between", "in between", "among"):
        return Phrase(words[-1])
    if text == "on surface":
        return Phrase("on")
    if text in ("on each side", "on either side", "on both sides"):
        return Phrase("each_side")
    if text == "upside down":
        return Phrase("upside_down")
    if words[-2:] == ["each", "other"]:
        return Phrase(next(t for t, phrases in EACH_OTHER.items() if " ".join(words[:-2]) in phrases))
    if text in NEAREST:
        return Phrase(NEAREST[text])
    if " ".join(words[:2]) in CLOSER:
        return Phrase(CLOSER[" ".join(words[:2])], " ".join(words[2:]) or None)
    if words[0] in SUPERLATIVES:
        return Phrase(words[0], " ".join(words[2:]) or None)
    if words[0] == "parallel":
        return Phrase("parallel", " ".join(words[2:]))
    if words[0] in AIMS:
        return Phrase(words[0], " ".join(word for word in words[1:] if word not in ("to", "toward", "towards")))
    if words[0] == "with":
        part = next(word for word in words if word in PARTS)
        after = [word for word in words[words.index(part) + 1 :] if word not in (*TOWARD, "turned")]
        aims = [word for word in after if word in AIMS]
        rest = [word for word in after if word not in aims]
        part = "handle" if part == "grip" else part
        return Phrase((aims or [PARTS[part]])[0], " ".join([part, *rest]))
    if words[0] == "in" and words[1] in ARRANGEMENTS:
        return Phrase(ARRANGEMENTS[words[1]], " ".join(words[3:]) or None)
    if (number := re.search(r"([0-9.]+) *([a-z]+)", text)) is not None and number[2] in UNITS:
        bound = text[: number.start()].strip()
        term = next(term for term, words_ in DISTANCES.items() if bound in words_)
        return Phrase(term, None, float(number[1]) / UNITS[number[2]])
    if "from" in words:
        rank = RANKS.get(words[0]) or int(words[0][:-2])
        return Phrase("ordinal", f"{rank} from {' '.join(words[2:])}")
    words = [word for word in words[1:] if word != "any"]  # a place
    if "of" in words:
        return Phrase("middle", " ".join(words[words.index("of") + 1 :]))
    if words[-1] in PLACE_NOUNS and not (words[-1] == "middle" and len(words) > 1 and "part" in words):
        return Phrase(PLACE_NOUNS[words[-1]], " ".join(words[:-1]) or None)
    return Phrase("part", " ".join(words))


def adjective_property(word: str) -> Phrase | None:
    """Return the claim that an adjective makes of a thing; None for a word that makes none.

    Parameters
    ----------
    word
        Adjective, in any case.

    Returns
    -------
    Phrase or None
        Term and value of the claim; None for a word that makes no claim.

    Examples
    --------
    >>> adjective_property("big"), adjective_property("nested"), adjective_property("fork")
    (Phrase(term='size', value='big', metres=None), Phrase(term='nested', value=None, metres=None), None)
    """
    plain = word.casefold()
    if plain in STATES:
        return Phrase(plain)
    known = adjectives().get(plain)
    return Phrase(known.dimension, plain) if known is not None and known.dimension in ADJECTIVE_PROPERTIES else None


def phrase_of(claim: Claim) -> str | None:
    """Return the phrase of a claim, without its objects; None where the language has none.

    Parameters
    ----------
    claim
        Claim to say.

    Returns
    -------
    str or None
        The phrase, which :func:`meaning` reads as the same term, value and distance.

    Examples
    --------
    >>> phrase_of(Claim("corner", ("lamp",), ("desk",), value="far left"))
    'at far left corner of'
    >>> phrase_of(Claim("distance_more", ("fork",), ("plate",), metres=0.025))
    'at least 2.5 cm from'
    """
    wanted = Phrase(claim.relation, claim.value, claim.metres)
    pattern = CLAIM_OF_PATTERN if claim.arguments and not _objects_are_of_than(claim) else CLAIM_PATTERN
    for phrase in _candidates(claim):
        if re.fullmatch(pattern, phrase, re.IGNORECASE) and meaning(phrase) == wanted:
            return phrase
    return None


def _objects_are_of_than(claim: Claim) -> bool:
    """Return True for *closer to the near edge than the cup*, whose objects follow ``than``."""
    return claim.relation in ("closer", "farther") and claim.value is not None


def _candidates(claim: Claim) -> Iterator[str]:
    term, value = claim.relation, claim.value
    of = " of" if claim.arguments else ""
    if term in PLACES:
        if term == "part" and value is not None and not claim.arguments:
            yield f"at {value}"
        if term == "middle" and value is not None:
            yield f"at middle of {value}{of}"
        elif value is not None:
            yield f"at {value} {term}{of}"
        else:
            yield f"at any {term}{of}" if term != "middle" else f"at middle{of}"
    elif term in ("between", "among"):
        yield term
    elif term == "on":
        yield "on surface"
    elif term == "each_side":
        yield "on each side of"
    elif term == "upside_down":
        yield "upside down"
    elif term in EACH_OTHER:
        yield f"{EACH_OTHER[term][0]} each other"
    elif term in ARRANGEMENTS.values():
        shape = next(shape for shape, arrangement in ARRANGEMENTS.items() if arrangement == term)
        yield f"in a {shape}" + (f" from {value}" if value is not None else "")
    elif term in NEAREST.values():
        yield next(phrase for phrase, relation in NEAREST.items() if relation == term)
    elif term in CLOSER.values():
        phrase = next(phrase for phrase, relation in CLOSER.items() if relation == term)
        yield phrase if value is None else f"{phrase} {value}"
    elif term in SUPERLATIVES:
        yield f"{term} of" if value is None else f"{term} at {value}"
    elif term == "ordinal" and value is not None:
        rank, _, start = value.partition(" ")
        words = (word for word, number in RANKS.items() if str(number) == rank)
        yield f"{next(words, f'{rank}th')} {start}{of}"
    elif term in ("pointing", "facing") and value is not None and value.split()[0] in PARTS:
        part, _, side = value.partition(" ")
        aim = "" if PARTS[part] == term else f" {term}"
        yield f"with its {part}{aim} to{f' {side}' if side else ''}"
        yield f"with its {part}{aim} {side}"
    elif term in ("pointing", "facing", "parallel") and value is not None:
        yield f"{term} {value}" if term != "parallel" else f"parallel to {value}{of}"
    elif term in DISTANCES and claim.metres is not None:
        bound = DISTANCES[term][0]
        for unit in ("cm", "m", "mm"):
            yield f"{bound} {_decimal(claim.metres * UNITS[unit])} {unit} from"
        yield f"{bound} {claim.metres!r} m from"


def _decimal(number: float) -> str:
    return f"{number:.10f}".rstrip("0").rstrip(".")


def is_collective(term: str) -> bool:
    """Return True for the term of a claim about all of its subjects together, as *in a row*.

    Parameters
    ----------
    term
        Term of a claim, such as ``row``.

    Returns
    -------
    bool
        False for a claim about each subject by itself.
    """
    return term in COLLECTIVE or term == "count" or term.startswith("none_")
