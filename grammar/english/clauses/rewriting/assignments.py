"""Rewrite what a place is for as where things are: *use the top shelf for cups*, *the door is a place for jars*."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from deixis.grammar.english.chunking.chunk import FINITE, Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses.rewriting.editing import ENDS, type_at, word_of
from deixis.grammar.english.tree import NounPhrase
from deixis.grammar.english.vocabulary.nouns import EVENTS, HOLDERS, PEOPLE, VESSELS, last_word
from deixis.grammar.english.vocabulary.relation_words import Preposition
from deixis.grammar.english.vocabulary.tables import word_set

_STORING = word_set(
    "shelf drawer rack cupboard cabinet basket bin compartment crate locker tier pocket hook peg closet wardrobe"
    " cubby cubbyhole pigeonhole chest trunk tote caddy container box fridge refrigerator freezer pantry larder crisper"
    " counter countertop worktop sideboard dresser nightstand cart trolley pegboard garage attic basement loft shed"
    " hamper pouch organizer organiser bookcase bookshelf rail bar"
)
"""Places of which *for* tells what is kept in them: *the top shelf is for glasses*."""

_PARTS = word_set("section area zone space corner side end half level row door spot layer")
"""Parts of places, which an adjective or a place tells apart: *the left side is for forks*."""

_SPACES = word_set("section area zone space spot")
"""Parts of places that are where the words after them say: *the space behind the door*."""

_WITHIN = word_set(
    "cabinet cupboard closet pantry larder refrigerator fridge freezer cubby cubbyhole tote container hamper crisper"
    " garage attic basement loft shed trunk section area zone space corner door organizer organiser bookcase bookshelf"
)
"""Places, other than vessels and holders, that things are in and not on."""

_RESERVING = word_set(
    "use reserve keep save dedicate designate devote assign allocate allot earmark commit give utilize utilise"
)
"""Commands whose object with *for* or *to* tells what is kept in it."""

_TO_THINGS = word_set("dedicate devote assign allocate allot commit give")
"""Such commands after whose object *to* stands before the things."""

_ASSIGNED = _RESERVING - {"give", "keep", "save"} | word_set(
    "dedicated reserved meant intended mean intend design designed designated devoted assigned allocated earmarked"
)
"""Participles before *for* and *to* that tell what a place is for."""

_SUITED = word_set("ideal perfect great good best excellent suitable handy suited better right fine")
"""Qualities before *for* by which a place is recommended."""

_GOOD_PLACES = word_set("place spot location home position")
"""Nouns before *for* by which a place is recommended: *a good place for jars*."""

_KEEPING = word_set("store keep hold hang put organize organise display stash stow house corral place stack")
"""Verbs after *for* and *to* that stand before the things: *the shelf is for storing cups*."""

_GERUNDS = tuple(
    f"{verb.removesuffix('e') if verb != 'put' else 'putt'}ing " for verb in sorted(_KEEPING)
)  # 'storing cups' where it was taken for one noun

_BEING = word_set("go belong live stay sit stand lie hang rest reside")
"""Verbs after *where* that tell what is kept in a place: *the shelf is where the boots go*."""

_NO_THINGS = word_set(
    "kitchen bathroom bedroom room home house office apartment flat space family beginner storage display access use"
    " transport decoration decorating cooking baking work reach time entertaining everyday convenience safety"
)
"""Nouns after *for* that are not what is kept in a place."""


def _is_place(chunks: list[Chunk], at: int, strong: bool) -> int | None:
    """Return the end of a phrase that names a place in which things are kept."""
    if type_at(chunks, at) != "NP" or chunks[at].value.pronoun or chunks[at].value.members:
        return None
    phrase, noun = chunks[at].value, last_word(chunks[at].value.head)
    end = at + 1
    if type_at(chunks, end) in ("OF", "PREP") and type_at(chunks, end + 1) == "NP" and word_of(chunks[end]) not in (
        "for", "to", "well for",
    ):  # fmt: skip
        end += 2
    if noun in _PARTS:
        told_apart = end > at + 1 or bool(phrase.adjectives) or noun == "door"
        return end if told_apart and phrase.determiner != "no" else None
    return end if noun in _STORING and (strong or not phrase.plural) else None


def _at_place(place: list[Chunk]) -> list[Chunk]:
    """Return a place with the preposition before it; *the space behind the door* is behind the door."""
    first, noun = place[0], last_word(place[0].value.head)
    if noun in _SPACES and type_at(place, 1) == "PREP":
        return place[1:]
    inside = noun in VESSELS | HOLDERS | _WITHIN
    spot = Relator(Preposition("in" if inside else "on", "inside" if inside else "on"))
    return [Chunk("PREP", first.start, first.start, spot, (first.span[0], first.span[0])), *place]


def _names_things(phrase: NounPhrase, strong: bool) -> bool:
    """Return True for *cups* and *the bread*, but not for *transport*, which may be an act, nor for persons."""
    noun = last_word(phrase.head)
    if not phrase.head or noun in PEOPLE | EVENTS | _NO_THINGS or phrase.pronoun:
        return False
    return phrase.plural or phrase.determiner == "the" or phrase.owner is not None or (strong and phrase.known)


def _things(chunks: list[Chunk], at: int, strong: bool) -> tuple[list[Chunk], int] | None:
    """Return the things after *for*, *for storing* or *to store*, and the end of them."""
    keeps = strong
    if type_at(chunks, at) == "PREP" and word_of(chunks[at]) in ("for", "to", "well for"):
        at += 1
    elif type_at(chunks, at) == "UNKNOWN" and word_of(chunks[at]) in ("for", "to"):
        verb = chunks[at + 1] if at + 1 < len(chunks) else None
        lemma = verb.value.lemma if verb is not None and isinstance(verb.value, VerbGroup) else None
        lemma = str(verb.value) if verb is not None and lemma is None else lemma
        if lemma not in _KEEPING:
            return None
        at, keeps = at + 2, True
    else:
        return None
    found: list[Chunk] = []
    while type_at(chunks, at) == "NP":
        phrase = chunks[at].value
        stripped = next((phrase.head.removeprefix(g) for g in _GERUNDS if phrase.head.startswith(g)), None)
        if stripped:
            phrase, keeps = replace(phrase, head=stripped), True
        if not _names_things(phrase, keeps):
            return None
        found.append(replace(chunks[at], value=phrase))
        at += 1
        if [type_at(chunks, at), type_at(chunks, at + 1)] == ["OF", "NP"]:
            found += chunks[at : at + 2]
            at += 2
        if type_at(chunks, at) == "REL":  # 'for foods that need no cooking'
            end = next((k for k in range(at, len(chunks)) if chunks[k].type in ENDS), len(chunks))
            return [*found, *chunks[at:end]], end
        joints = at
        while type_at(chunks, joints) in ("COMMA", "AND", "OR"):
            joints += 1
        if joints == at or type_at(chunks, joints) != "NP" or type_at(chunks, joints + 1) in FINITE | {"PREP"}:
            break
        found += chunks[at:joints]
        at = joints
    return (found, at) if found and type_at(chunks, at) in ENDS | {"AND", "SUB"} else None


def _statement(chunks: list[Chunk], at: int) -> list[Chunk] | None:
    """Return *the top shelf is (reserved) for glasses* as *glasses are on the top shelf*."""
    end = _is_place(chunks, at, True)
    if end is None or type_at(chunks, end) not in ("BE", "VERB"):
        return None
    verb = chunks[end].value
    works = type_at(chunks, end) == "VERB" and verb.lemma == "work"
    if not isinstance(verb, VerbGroup) or not verb.positive or not (works or chunks[end].type == "BE"):
        return None
    being = replace(chunks[end], type="BE", value=replace(verb, lemma="be", kind="be", form="finite"))
    place, first = chunks[at:end], end + 1
    kept = _where(chunks, first)
    if kept is not None:
        things, last = kept
        return [*chunks[:at], *things, being, *_at_place(place), *chunks[last:]]
    strong = works
    said = chunks[first] if first < len(chunks) else None
    if said is not None and said.type == "PART":
        strong = said.value.lemma in _ASSIGNED
    elif said is not None and said.type == "ADJP":
        strong = all(adjective.word in _SUITED for adjective in said.value)
    elif said is not None and said.type == "NP":
        home = said.value.head == "home" and word_of(chunks[first + 1]) == "to" if first + 1 < len(chunks) else False
        strong = home or (last_word(said.value.head) in _GOOD_PLACES and said.value.determiner in ("a", "the"))
        strong = strong and (home or said.value.head != "home")
    stated = said is not None and said.type in ("PART", "ADJP", "NP")
    if stated and not strong:
        return None
    weak = _is_place(chunks, at, False) is not None and verb.modal in (None, "should", "must")
    if not strong and not (weak and said is not None and word_of(said) == "for"):
        return None
    told = _things(chunks, first + stated, strong)
    if told is None:
        return None
    things, last = told
    return [*chunks[:at], *things, being, *_at_place(place), *chunks[last:]]


def _where(chunks: list[Chunk], at: int) -> tuple[list[Chunk], int] | None:
    """Return the things of *is where the boots go*, and the end of the clause."""
    if type_at(chunks, at) not in ("SUB", "REL") or chunks[at].value != "where" or type_at(chunks, at + 1) != "NP":
        return None
    verb = chunks[at + 2].value if at + 2 < len(chunks) else None
    goes = type_at(chunks, at + 2) == "VERB" and isinstance(verb, VerbGroup) and verb.lemma in _BEING
    kept = [type_at(chunks, at + k) for k in (2, 3)] == ["BE", "PART"] and chunks[at + 3].value.lemma in _KEEPING
    end = at + 3 + kept
    fits = (goes or kept) and isinstance(verb, VerbGroup) and verb.positive and not (verb.past or verb.modal)
    return (chunks[at + 1 : at + 2], end) if fits and type_at(chunks, end) in ENDS else None


def _existing(chunks: list[Chunk], at: int) -> list[Chunk] | None:
    """Return *there is a place for the broom behind the piano* as *the broom is behind the piano*."""
    types = [type_at(chunks, at + k) for k in range(6)]
    if types != ["THERE", "BE", "NP", "PREP", "NP", "PREP"] or not chunks[at + 1].value.positive:
        return None
    spot, relator, thing = chunks[at + 2].value, chunks[at + 3], chunks[at + 4].value
    free = last_word(spot.head) in _GOOD_PLACES and spot.determiner in ("a", "one")
    if not free or word_of(relator) != "for" or not _names_things(thing, False):
        return None
    return [*chunks[:at], chunks[at + 4], chunks[at + 1], *chunks[at + 5 :]]


def _command(chunks: list[Chunk], at: int) -> list[Chunk] | None:
    """Return *use the upper rack for cups and the lower rack for plates* as *put cups in the upper rack and …*."""
    group = chunks[at].value
    if chunks[at].type not in ("PUT", "DO", "FIND") or not isinstance(group, VerbGroup) or not group.positive:
        return None
    if group.lemma not in _RESERVING:
        return None
    made: list[Chunk] = [*chunks[:at], replace(chunks[at], type="PUT", value=VerbGroup("put", "posture", "base"))]
    at += 1
    while True:
        told_apart = type_at(chunks, at) == "NP" and (bool(chunks[at].value.adjectives) or not chunks[at].value.plural)
        end = _is_place(chunks, at, True) if told_apart else None
        to = end is not None and type_at(chunks, end) == "PREP" and word_of(chunks[end]) == "to"
        if end is None or (to and group.lemma not in _TO_THINGS):
            return None
        told = _things(chunks, end, group.lemma not in ("use", "keep", "save"))
        if told is None:
            return None
        things, last = told
        made += [*things, *_at_place(chunks[at:end])]
        if type_at(chunks, last) not in ("AND", "COMMA") or type_at(chunks, last + 1) != "NP":
            return [*made, *chunks[last:]]
        made.append(chunks[last])
        at = last + 1


def _with_assigned_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with what a place is for as where the things are."""
    cuts = [i for i, chunk in enumerate(chunks) if chunk.type == "CUT"]
    found: list[Chunk] = []
    for start, end in pairwise([0, *cuts, len(chunks)]):
        whole = chunks[start:end]
        plain = [chunk for chunk in whole if chunk.type != "ADVERB"]
        for at in range(len(plain)):
            if type_at(plain, at - 1) not in ENDS:
                continue
            made = _statement(plain, at) or _command(plain, at) or _existing(plain, at)
            if made is not None:
                whole = made
                break
        found += whole
    return found


REWRITES = (_with_assigned_places,)
"""Rewriting of what a place is for."""
