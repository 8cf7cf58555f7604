"""Read the labels of notes as things and places: *forks: two, left of the plate*, *top drawer: pens*."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.clauses.rewriting.editing import (
    ENDS,
    PREDICATES,
    Run,
    cut,
    leave_out,
    put_in,
    type_at,
    without,
    word_of,
)
from deixis.grammar.english.tree import NounPhrase
from deixis.grammar.english.vocabulary.nouns import HOLDERS, PARTS, SURFACES, VESSELS, last_word
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, Preposition
from deixis.grammar.english.vocabulary.verbs import PUT_VERBS

_MIDDLES = frozenset({"centre", "center", "middle"})


def _with_labels_of_definitions(chunks: list[Chunk]) -> list[Chunk]:
    """Return *Tea pot: a vessel for tea, placed in the middle* as *tea pot placed in the middle*."""
    types = [type_at(chunks, k) for k in range(3)]
    if types != ["NP", "COLON", "NP"] or chunks[2].value.determiner not in ("a", "an") or chunks[2].value.members:
        return chunks
    end = next((k for k in range(3, len(chunks)) if chunks[k].type in ("COMMA", "CUT")), len(chunks))
    after_label = chunks[3:end]
    purpose = bool(after_label) and (
        after_label[0].type == "REL" or getattr(after_label[0].value, "lemma", "") == "use"
    )
    purpose = purpose or (
        bool(after_label) and after_label[0].type in ("UNKNOWN", "PREP") and word_of(after_label[0]) == "for"
    )
    rest = [chunk for chunk in chunks[end + 1 :] if chunk.type != "ADVERB"]
    if not purpose or type_at(chunks, end) != "COMMA" or not rest or rest[0].type not in ("PART", "PREP"):
        return chunks
    leave_out(chunks[2:end], "a definition does not say where something is")
    return [chunks[0], *chunks[end + 1 :]]


def _with_labels_of_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *Peas: plant along the wall* as *peas along the wall*: the label is the object of the command."""
    types = [chunk.type for chunk in chunks[:4]]
    if types[:3] != ["NP", "COLON", "NP"] or types[3:] not in (["PREP"], ["ADV"]) or chunks[0].value.determiner:
        return chunks
    verb = chunks[2].value
    if verb.determiner or verb.owner is not None or verb.adjectives or verb.head not in PUT_VERBS:
        return chunks
    return [chunks[0], *chunks[3:]]


def _turn(chunks: list[Chunk], at: int) -> Run | None:
    """Find the turn of a thing in a list of steps: *towel first: fold it*, *the guest first: a beaker …*."""
    turn = at == 1 and [type_at(chunks, k) for k in range(3)] == ["NP", "NP", "COLON"]
    ranked = turn and not chunks[at].value.head and chunks[at].value.determiner is None
    return (at + 1, None) if ranked and any(a.rank for a in chunks[at].value.adjectives) else None


def _side_up(chunks: list[Chunk], at: int) -> Run | None:
    """Find which side is up: *the tokens go beside the board, letter side up*."""
    types = [type_at(chunks, at + k) for k in range(3)]
    if types[:2] not in (["COMMA", "NP"], ["COLON", "NP"]) or types[2] not in ("ADVERB", "ADV"):
        return None
    side = chunks[at + 1].value
    direction = chunks[at + 2].value if types[2] == "ADVERB" else chunks[at + 2].value.preposition.phrase
    bare = side.determiner is None and side.owner is None and " " in side.head and last_word(side.head) == "side"
    if not bare or str(direction).split()[-1:] not in (["up"], ["down"], ["upward"], ["downward"], ["upwards"]):
        return None
    leave_out(chunks[at + 1 : at + 3], "which side is up does not say where something is")
    labelled = types[0] == "COLON"  # 'camera: lens side up, on the mat'
    return at + 3 + (labelled and type_at(chunks, at + 3) == "COMMA"), chunks[at] if labelled else None


def _with_counted_labels(chunks: list[Chunk]) -> list[Chunk]:
    """Return *forks: two, left of the plate* as *two forks, left of the plate*."""
    if [type_at(chunks, k) for k in range(3)] != ["NP", "COLON", "NP"] or type_at(chunks, 3) not in ENDS | {
        "PREP",
        "ADV",
    }:
        return chunks
    thing, number = chunks[0].value, chunks[2].value
    bare = not (number.head or number.pronoun or number.adjectives or number.owner)
    if not bare or number.count is None or not thing.head or thing.count is not None:
        return chunks
    counted = replace(thing, count=number.count, plural=number.count > 1)
    whole = Chunk("NP", chunks[0].start, chunks[2].end, counted, chunks[0].span)
    return [whole, *chunks[3 + (type_at(chunks, 3) == "COMMA") :]]


def _with_place_labels(chunks: list[Chunk]) -> list[Chunk]:
    """Return *centre of table: fruit bowl* and *top drawer: pens, tape* as places with their things."""
    colon = 1
    while [type_at(chunks, colon), type_at(chunks, colon + 1)] == ["OF", "NP"]:
        colon += 2
    if [type_at(chunks, 0), type_at(chunks, colon), type_at(chunks, colon + 1)] != ["NP", "COLON", "NP"]:
        return chunks
    place, thing = chunks[0].value, chunks[colon + 1].value
    if place.determiner not in (None, "the") or not place.head or not thing.head or is_place(thing):
        return chunks
    noun = last_word(place.head.rstrip("0123456789 "))
    holds = noun in VESSELS | HOLDERS or noun in SURFACES
    listed = (thing.plural and last_word(thing.head) != noun) or any(
        adjective.dimension in ("position", "rank") for adjective in place.adjectives
    )  # 'bottom shelf: pots', but not 'jug: tray'
    vessel = last_word(thing.head) in VESSELS | HOLDERS | SURFACES
    if not is_place(place) and (not holds or place.plural or (vessel and not listed)):
        return chunks
    if any(chunk.type in FINITE for chunk in chunks[colon:]) or (is_place(place) and place.plural):
        return chunks
    word = "at" if is_place(place) else "in" if noun in VESSELS | HOLDERS else "on"
    relator = Relator(Preposition(word, {"in": "inside"}.get(word, word)))
    comma = Chunk("COMMA", chunks[colon].start, chunks[colon].end, None, chunks[colon].span)
    return [put_in("PREP", chunks[0], relator), *chunks[:colon], comma, *chunks[colon + 1 :]]


def _with_bare_places_first(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with a preposition before a bare place that a command or a verb follows.

    *Top right, put the bone, which …* is read as *at the top right, put the bone, which …*.
    """
    first = next((i for i, chunk in enumerate(chunks) if chunk.type != "ADVERB"), 0)
    follows = first + 1 + (type_at(chunks, first + 1) == "COMMA")
    commanded = type_at(chunks, follows) == "PUT" and follows > first + 1
    inverted = type_at(chunks, follows) == "VERB" and type_at(chunks, follows + 1) == "NP" and follows == first + 1
    if type_at(chunks, first) != "NP" or not (commanded or inverted):
        return chunks
    place = chunks[first].value
    if not is_place(place) or place.determiner is not None or place.plural or not place.adjectives:
        return chunks
    return [*chunks[:first], put_in("PREP", chunks[first], Relator(Preposition("at", "at"))), *chunks[first:]]


def _with_telegraphic_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with a preposition before a bare place of a note: *plate centre*, *lamp: far left corner*."""
    at = Relator(Preposition("at", "at"))
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        ends = i + 1 == len(chunks) or chunks[i + 1].type in JOINT_TYPES | {"OF"}
        aside = (
            len(found) > 1 and found[-1].type == "COMMA" and found[-2].type == "NP"
            and type_at(chunks, i + 1) in ENDS
        )  # fmt: skip
        kept_in = (
            i == 2 and ends and [c.type for c in chunks[:3]] == ["NP", "COLON", "NP"] and not chunk.value.plural
            and last_word(chunk.value.head) in VESSELS | HOLDERS and chunk.value.determiner in (None, "the")
            and last_word(chunks[0].value.head) not in VESSELS | HOLDERS | SURFACES and bool(chunks[0].value.head)
            and not any(other.type in FINITE for other in chunks) and chunk.value.owner is None
        )  # fmt: skip
        noted = (
            chunk.type == "NP" and not found and ends and type_at(chunks, i + 1) == "COMMA" and not chunk.value.plural
            and chunk.value.head in PLACE_NOUNS and chunk.value.determiner is None and chunk.value.owner is None
            and not any(other.type in FINITE for other in chunks)
        )  # fmt: skip
        on = bool(found) and found[-1].type == "PREP" and found[-1].value.preposition.relation in ("on", "at", "inside")
        if on and chunk.type == "ADV" and chunk.value.preposition.phrase in PLACE_NOUNS:  # 'kettle on left'
            side = NounPhrase(chunk.span, chunk.value.preposition.phrase)
            chunk = Chunk("NP", chunk.start, chunk.end, side, chunk.span)
        if noted:  # 'limes? front left, in a bowl, knife across it'
            found.append(put_in("PREP", chunk, at))
            for k in range(i + 2, len(chunks) - 2):
                if chunks[k].type == "COMMA" and chunks[k + 1].type == "NP" and chunks[k + 2].type in PREDICATES:
                    chunks[k] = cut(chunks[k])
        if kept_in:  # 'gloves: left-hand pocket'
            found.append(put_in("PREP", chunk, Relator(Preposition("in", "inside"))))
        if (
            chunk.type == "NP"
            and ends
            and found
            and (
                found[-1].type in ("NP", "COLON")
                or (aside and (chunk.value.adjectives or chunk.value.head in _MIDDLES))
            )
            and chunk.value.head in PLACE_NOUNS
            and chunk.value.determiner is None
            and chunk.value.owner is None
            and not chunk.value.plural
            and any(other.type == "NP" for other in found)
            and (not any(other.type in FINITE for other in found) or (aside and found[-2].value.determiner is not None))
        ):
            found.append(put_in("PREP", chunk, at))
        found.append(chunk)
    return found


def _with_named_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *in the corner, the far left one* as *in the far left corner*."""
    for i in range(2, len(chunks)):
        types = [type_at(chunks, i + k) for k in range(-2, 2)]
        if types != ["PREP", "NP", "COMMA", "NP"] or type_at(chunks, i + 2) not in ENDS:
            continue
        place, one = chunks[i - 1].value, chunks[i + 1].value
        named = one.pronoun == "one" and one.determiner == "the" and bool(one.adjectives) and one.count is None
        directed = named and all(a.word in DIRECTION_WORDS for a in one.adjectives)
        if directed and place.head in PLACE_NOUNS and not place.adjectives and place.of is None:
            value = replace(place, adjectives=one.adjectives)
            return [*chunks[: i - 1], replace(chunks[i - 1], value=value), *_with_named_places(chunks[i + 2 :])]
    return chunks


def _with_labels_apart(chunks: list[Chunk]) -> list[Chunk]:
    """End the clause of a note before what is said about a part: *rear left corner, lid closed*."""
    for i, chunk in enumerate(chunks):
        before = [c.type for c in chunks[:i] if c.type != "ADVERB"][-2:]
        beside = type_at(chunks, i + 1) == "NP" and before in (["PREP", "NP"], ["OF", "NP"])
        if chunk.type != "COMMA" or not beside:
            continue
        part = chunks[i + 1].value
        described = type_at(chunks, i + 2) in ("PART", "ADJP") and type_at(chunks, i + 3) in ENDS
        verbless = not any(c.type in FINITE | {"PUT"} for c in chunks)
        other = not part.head and (part.pronoun == "one" or part.count is not None) and type_at(chunks, i + 2) == "PART"
        hangs = [type_at(chunks, i + k) for k in (2, 3, 4)] == ["PART", "PREP", "NP"] and type_at(chunks, i + 5) in ENDS
        hangs = hangs and part.determiner is None and chunks[i + 4].value.pronoun == "it"
        own = last_word(part.head) in PARTS and type_at(chunks, i + 2) in ("ADJP", "PART", "TPART")
        bare = part.determiner is None and part.owner is None and not part.adjectives
        # 'four chairs around it, one fallen' and 'behind it, lid open towards you'
        if (verbless and (other or hangs)) or (bare and (own or (described and verbless))):
            chunks[i] = cut(chunk)
    return chunks


def _with_label_nouns(chunks: list[Chunk]) -> list[Chunk]:
    """Return a label that is a colour too as a noun: *cream: side pocket*."""
    if type_at(chunks, 0) == "ADJP" and type_at(chunks, 1) == "COLON" and len(chunks[0].value) == 1:
        word = chunks[0].value[0].word
        chunks[0] = Chunk("NP", chunks[0].start, chunks[0].end, NounPhrase(chunks[0].span, word), chunks[0].span)
    return chunks


REWRITES = (
    without(_side_up), _with_counted_labels, _with_labels_of_definitions, _with_labels_of_commands, without(_turn),
    _with_label_nouns, _with_place_labels, _with_bare_places_first, _with_telegraphic_places, _with_named_places,
    _with_labels_apart,
)  # fmt: skip
"""Rewritings of labels, in their order."""
