"""Give the members of a list the places and numbers that they share, and what one of them has a phrase of its own."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, Chunk
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.clauses.rewriting.editing import (
    BREAKS,
    ENDS,
    Run,
    apart,
    end_before,
    put_in,
    type_at,
    with_last,
    without,
)
from deixis.grammar.english.tree import Degree, NounPhrase
from deixis.grammar.english.vocabulary.nouns import AIMED_PARTS, last_word
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS

_OWNING = frozenset({"have", "need", "include", "contain", "get", "bring"})
"""Verbs with lists of what one has."""


def _with_accompanied_members(chunks: list[Chunk]) -> list[Chunk]:
    """Return a list with what a member within it has at the end: *put the plate, cup with a lid, spoon and fork …*.

    Before the member there is no conjunction, so that what follows the comma is a member of the list too.
    """
    kept: list[Chunk] = []
    after: list[Chunk] = []
    i = 0
    while i < len(chunks):
        types = [type_at(chunks, i + k) for k in range(-3, 4)]
        if types == ["NP", "COMMA", "NP", "WITH", "NP", "COMMA", "NP"] and _ends_with_conjunction(chunks, i + 2):
            after += apart([chunks[i - 1]], chunks[i : i + 2], chunks[i].span)
            i += 2
            continue
        end = _end_of_own_part(chunks, i)
        if end is not None:  # 'you have the knife, with the blade facing the plate, and the spoon'
            after += apart([chunks[i - 1]], chunks[i + 1 : end], chunks[i + 1].span)
            i = end
            continue
        kept.append(chunks[i])
        i += 1
    return with_last(kept, after)


def _end_of_own_part(chunks: list[Chunk], at: int) -> int | None:
    """Return the end of *, with its blade facing the plate* between an object and *, and* with the last one."""
    aside = [type_at(chunks, at + k) for k in range(-2, 6)]
    apart = {aside[2], aside[7]} <= {"COMMA", "CUT"} and aside[0] in ("TVERB", "BE")
    if not apart or [aside[1], *aside[3:7]] != ["NP", "WITH", "NP", "PREP", "NP"]:
        return None
    listed = [type_at(chunks, at + k) for k in range(6, 9)]
    aimed = last_word(chunks[at + 2].value.head) in AIMED_PARTS
    joined = listed[0] in ("AND", "CUT") and listed[1] == "NP" and listed[2] in ENDS
    return at + 5 if aimed and joined else None


def _with_things_of_several(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the plates are left of the jug with a fork on each of them* with a comma before *with*.

    What is on *them* or on *each* is on the plates, and not on the jug.
    """
    for i in range(1, len(chunks) - 3):
        if [type_at(chunks, i + k) for k in range(-1, 4)] != ["NP", "WITH", "NP", "PREP", "NP"]:
            continue
        last, several = chunks[i - 1].value, chunks[i + 3].value.pronoun in ("each", "both", "they")
        before = [c.value for c in chunks[: i - 1] if c.type == "NP"]
        single = not last.plural and not last.members and (bool(last.head) or last.pronoun == "it")
        if several and single and type_at(chunks, i - 2) in ("PREP", "OF") and any(p.plural for p in before):
            return [*chunks[:i], put_in("COMMA", chunks[i]), *chunks[i:]]
    return chunks


def _with_first_of_owned(chunks: list[Chunk]) -> list[Chunk]:
    """Return *you have a tarp under the tent, the poles and the rope* with the place of the first thing at the end.

    The list goes on with what one has, and not with what the tarp is under.
    """
    for at in range(1, len(chunks) - 4):
        verb, thing = chunks[at - 1], chunks[at]
        if (
            verb.type != "TVERB"
            or verb.value.lemma not in _OWNING
            or thing.type != "NP"
            or thing.value.determiner is None
        ):
            continue
        first = at + 1 + 2 * ([type_at(chunks, at + 1), type_at(chunks, at + 2)] in (["OR", "NP"], ["AND", "NP"]))
        end = end_before(chunks, first, BREAKS)
        types = [chunk.type for chunk in chunks[first:end]]
        places = [chunk.value for chunk in chunks[first:end] if chunk.type == "PREP"]
        single = types[-2:] == ["PREP", "NP"] and set(types) <= {"REL", "VERB", "BE", "PART", "PREP", "NP"}
        if (
            single
            and places[-1].preposition.relation not in ("between", "among")
            and _ends_with_conjunction(chunks, end)
        ):
            places_of_first = chunks[first + 1 : end] if types[0] == "REL" else chunks[first:end]
            return with_last([*chunks[:first], *chunks[end:]], apart(chunks[at:first], places_of_first, thing.span))
    return chunks


def _ends_with_conjunction(chunks: list[Chunk], at: int) -> bool:
    """Return True for commas with bare nouns, and a last noun after *and*: *, spoon, and fork*.

    A last noun before a verb is the subject of another clause.
    """
    while [type_at(chunks, at), type_at(chunks, at + 1)] == ["COMMA", "NP"]:
        at += 2
    at += type_at(chunks, at) == "COMMA"
    return [type_at(chunks, at), type_at(chunks, at + 1)] == ["AND", "NP"] and type_at(chunks, at + 2) not in FINITE


def _with_shared_spots(chunks: list[Chunk]) -> list[Chunk]:
    """Return *with the flutes and clarinets on the left* with the place after both plurals."""
    found: list[Chunk] = []
    accompanied = False
    for i, chunk in enumerate(chunks):
        accompanied = chunk.type == "WITH" or (accompanied and chunk.type not in FINITE | BREAKS | {"SUB", "REL"})
        found.append(chunk)
        types = [type_at(chunks, i + k) for k in range(5)]
        paired = types == ["NP", "AND", "NP", "PREP", "NP"] and type_at(chunks, i - 1) in ("WITH", "AND")
        if not (accompanied and paired):
            continue
        bare, placed, spot = (chunks[i + k].value for k in (0, 2, 4))
        alike = bare.plural and placed.plural and placed.determiner in (None, bare.determiner)
        alike = alike or (bare.determiner in ("a", "an", "the") and placed.determiner is None)  # 'a knife and spoon'
        if alike and bare.head and is_place(spot) and type_at(chunks, i + 5) != "OF":
            at = chunks[i + 1].start
            found += [Chunk(c.type, at, at, c.value, c.span) for c in chunks[i + 3 : i + 5]]
    return found


def _bare_superlative(chunks: list[Chunk], at: int) -> Run | None:
    """Find the member of an uncounted group that is told apart: *pipettes on the stand, largest on the left*."""
    apart = (
        [type_at(chunks, at + k) for k in range(4)] == ["COMMA", "ADJP", "PREP", "NP"]
        and type_at(chunks, at + 4) in ENDS and chunks[at + 1].value[-1].degree is Degree.SUPERLATIVE
        and chunks[at + 3].value.head in PLACE_NOUNS
    )  # fmt: skip
    nearby = (
        [type_at(chunks, at + k) for k in range(4)] == ["COMMA", "ADJP", "PREP", "NP"]
        and type_at(chunks, at + 4) in ENDS and chunks[at + 1].value[-1].degree is Degree.SUPERLATIVE
        and chunks[at + 1].value[-1].dimension in ("size", "length", "height", "width", "thickness")
    )  # 'a rack of tubes, longest at the wall'  # fmt: skip
    above = (
        [type_at(chunks, at + k) for k in range(3)] == ["COMMA", "ADJP", "ADV"] and type_at(chunks, at + 3) in ENDS
        and chunks[at + 1].value[-1].degree is Degree.SUPERLATIVE
        and chunks[at + 1].value[-1].dimension in ("size", "length", "height", "width", "thickness", "other")
    )  # 'pans stacked on the rack, smallest on top'  # fmt: skip
    if above:
        return at + 3, None
    apart = apart or nearby
    nearest = (
        [type_at(chunks, at + k) for k in range(3)] == ["COMMA", "ADJP", "NP"] and type_at(chunks, at + 3) in ENDS
        and chunks[at + 1].value[-1].word in ("near", "far") and len(chunks[at + 1].value) > 1
    )  # 'ink pots in front of the lamp, black nearest the client'  # fmt: skip
    return (at + 3 + (not nearest), None) if apart or nearest else None


def _partition(chunks: list[Chunk], at: int) -> Run | None:
    """Find what the members of a group are of: *two frames, one of my mother and one of a ship*."""
    if chunks[at].type != "COMMA" or type_at(chunks, at - 1) != "NP":
        return None
    end, parts = at + 1, 0
    while [type_at(chunks, end + k) for k in range(3)] in (["NP", "OF", "NP"], ["NP", "PREP", "NP"]):
        one, link = chunks[end].value, chunks[end + 1]
        of = link.type == "OF" or link.value.preposition.phrase in ("for", "of")
        if one.pronoun != "one" or one.head or one.adjectives or not of:
            break
        end, parts = end + 3, parts + 1
        end = next((k for k in range(end, len(chunks)) if chunks[k].type not in ("COMMA", "AND")), len(chunks))
    last = chunks[end - 1].type if parts > 1 else ""
    return (end - (last == "AND"), None) if parts > 1 else None


def _count_apart(chunks: list[Chunk], at: int) -> Run | None:
    """Find a number that is given apart: *the mugs hang from the hooks, five of them, and …*."""
    counts = (
        [type_at(chunks, at + k) for k in range(4)] == ["COMMA", "NP", "OF", "NP"]
        and type_at(chunks, at + 4) in ENDS and chunks[at + 3].value.pronoun in ("they", "these", "those")
        and not chunks[at + 1].value.head and chunks[at + 1].value.count is not None
        and any(chunk.type in FINITE for chunk in chunks[:at])
    )  # fmt: skip
    return (at + 4, None) if counts else None


def _with_pronouns_of_lists(chunks: list[Chunk]) -> list[Chunk]:
    """Return *both to the right of the plate* after a comma as a statement about the things before."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        whole = chunk.type == "ADVERB" and chunk.value in ("both", "all", "each")
        after_list = (
            type_at(chunks, i - 1) == "COMMA" and type_at(chunks, i - 2) == "NP" and type_at(chunks, i - 3) == "AND"
        )
        if whole and after_list and type_at(chunks, i + 1) in ("PREP", "ADV"):
            phrase = NounPhrase(chunk.span, pronoun=chunk.value, plural=True)
            chunk = Chunk("NP", chunk.start, chunk.end, phrase, chunk.span)
        found.append(chunk)
    return found


def _with_places_of_pairs(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks of *with A on the left and B and C on the right* with the place after *B*, too."""
    types = [chunk.type for chunk in chunks]
    for i in range(3, len(chunks) - 5):
        pair = types[i : i + 6] == ["AND", "NP", "AND", "NP", "PREP", "NP"]
        place = ["WITH", "NP", "PREP", "NP"]
        if pair and (types[i - 4 : i] == place or types[max(0, i - 6) : i] == [*place, "OF", "NP"]):
            return [*chunks[: i + 2], *chunks[i + 4 : i + 6], *chunks[i + 2 :]]
    return chunks


def _with_contrasted_members(chunks: list[Chunk]) -> list[Chunk]:
    """Return *do not place the fork but the spoon next to it* as a list of which the second member is not denied.

    Also *on the left: never cups* with *no cups*.
    """
    found = list(chunks)
    for i, chunk in enumerate(chunks):
        types = [type_at(chunks, i + k) for k in range(4)]
        denied = types[0] in FINITE | {"PUT"} and not chunk.value.positive
        if denied and types[1:] == ["NP", "BUT", "NP"] and type_at(chunks, i + 4) not in FINITE:
            joint = chunks[i + 2]
            found[i + 2] = Chunk("AND", joint.start, joint.end, joint.value, joint.span)
            found[i + 3] = replace(chunks[i + 3], value=replace(chunks[i + 3].value, negated=True))
        if types[:3] == ["COLON", "NOT", "NP"] and chunks[i + 2].value.determiner is None:
            named = chunks[i + 2]
            found[i + 2] = replace(named, value=replace(named.value, determiner="no"))
            return [*found[: i + 1], *found[i + 2 :]]
    return found


REWRITES = (
    _with_contrasted_members, _with_accompanied_members, _with_first_of_owned, _with_things_of_several,
    _with_shared_spots, _with_pronouns_of_lists, without(_bare_superlative), without(_partition), without(_count_apart),
    _with_places_of_pairs,
)  # fmt: skip
"""Rewritings of lists, in their order."""
