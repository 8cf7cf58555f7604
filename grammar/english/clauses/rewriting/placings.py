"""Rewrite other ways to tell a place as a preposition with its noun: purposes, destinations, gaps and aims."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.clauses.rewriting.editing import (
    Run,
    apart,
    leave_out,
    put_in,
    type_at,
    without,
)
from deixis.grammar.english.tree import Degree, NounPhrase
from deixis.grammar.english.vocabulary.nouns import (
    AIMED_PARTS,
    HEADED,
    HOLDERS,
    PLACES_OF,
    SURFACES,
    VESSELS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import Preposition
from deixis.grammar.english.vocabulary.verbs import PUT_VERBS

_SEATS = frozenset({"place", "pride", "spot", "position", "seat"})

_MOVING = frozenset({"move", "shift", "transfer", "relocate", "return"})

_EXACTLY = frozenset({"just", "directly", "immediately", "right", "slightly"})

_OF_TOOLS = frozenset({"handle", "blade", "tine", "prong", "bowl", "spout"})

_GAPS = frozenset({"gap", "space", "distance", "clearance"})


def _place_taken(chunks: list[Chunk], at: int) -> Run | None:
    """Find what *takes the place of honour* and *has pride of place* take, which is where the thing is."""
    chunk = chunks[at]
    takes = chunk.type == "TVERB" and chunk.value.lemma in ("take", "have", "occupy", "hold")
    place = takes and type_at(chunks, at + 1) == "NP" and last_word(chunks[at + 1].value.head) in _SEATS
    end = at + 2 + 2 * ([type_at(chunks, at + k) for k in (2, 3)] == ["OF", "NP"])
    if not place or type_at(chunks, end) not in ("PREP", "ADV"):
        return None
    denied = chunks[at + 1].value.determiner == "no"  # 'phones have no place on the stand'
    group = replace(chunk.value, lemma="be", kind="be", positive=chunk.value.positive is not denied)
    return end, Chunk("BE", chunk.start, chunk.end, group, chunk.span)


def _with_measures_denied(chunks: list[Chunk]) -> list[Chunk]:
    """Return *never more than 10 cm from it* as an upper bound, and *you keep it there* as a statement."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        following = chunks[i + 1] if i + 1 < len(chunks) else None
        if chunk.type == "NOT" and following is not None and following.type == "MEASURE" and following.value[2]:
            metres, hedge, bound = following.value
            following.value = (metres, hedge, "<" if bound == ">" else ">")
            continue
        instructed = (
            chunk.type == "PUT" and type_at(chunks, i - 1) == "NP" and chunks[i - 1].value.pronoun in ("you", "we")
        )
        if instructed and type_at(chunks, i + 1) == "NP" and type_at(chunks, i - 2) == "NP":
            chunk = Chunk("TVERB", chunk.start, chunk.end, chunk.value, chunk.span)
        found.append(chunk)
    return found


def _with_destinations(chunks: list[Chunk]) -> list[Chunk]:
    """Return *she moved the pen to the drawer* and *it was moved from the desk to the drawer* as *in the drawer*.

    *It has moved to the drawer* is read as *it is in the drawer*.
    """
    for i, chunk in enumerate(chunks[:-2]):
        active = chunk.type == "TVERB" and chunk.value.lemma in _MOVING and chunks[i + 1].type == "NP"
        passive = chunk.type == "PART" and chunk.value.lemma in _MOVING and type_at(chunks, i - 1) == "BE"
        gone = chunk.type == "VERB" and chunk.value.lemma in _MOVING and chunk.value.form == "past"
        gone = gone and not chunk.value.modal and not chunk.value.past  # 'it has moved to the drawer'
        at = i + 1 + active  # of the places
        if not (active or passive or gone):
            continue
        origin = type_at(chunks, at) == "PREP" and chunks[at].value.preposition.relation == "from"
        if origin and [type_at(chunks, at + k) for k in (1, 2)] == ["NP", "PREP"]:
            del chunks[at : at + 2]
        to = type_at(chunks, at) == "PREP" and chunks[at].value.preposition.phrase == "to"
        if to and type_at(chunks, at + 1) == "NP":
            noun = last_word(chunks[at + 1].value.head)
            relation = "inside" if noun in VESSELS | HOLDERS else "on" if noun in SURFACES else "at"
            chunks[at] = replace(chunks[at], value=Relator(Preposition("to", relation)))
            if gone:
                chunks[i] = replace(chunk, type="BE", value=replace(chunk.value, lemma="be", kind="be", form="finite"))
            if passive and not chunks[i - 1].value.modal:
                chunks[i - 1] = replace(chunks[i - 1], value=replace(chunks[i - 1].value, past=False))
    return chunks


def _with_aimed_parts(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks of *with its blade to the plate* as *with its blade facing the plate*.

    *The handle* after *with* is that of the subject, and the bowl of a spoon is its tip.
    """
    found = list(chunks)
    for i in range(1, len(found) - 1):
        chunk, before, after = found[i], found[i - 1], found[i + 1]
        part = last_word(chunk.value.head) if chunk.type == "NP" and not chunk.value.members else ""
        owned = part in AIMED_PARTS and (chunk.value.owner is None or chunk.value.owner.pronoun is not None)
        has = before.type == "TVERB" and before.value.lemma == "have"
        if not owned or not (has or before.type in ("WITH", "COMMA")):
            continue
        to = after.type == "PREP" and after.value.preposition.relation == "to" and type_at(found, i + 2) == "NP"
        aims = to or after.type in ("PART", "TPART", "ADV")
        aims = aims or (after.type == "PREP" and after.value.preposition.relation in ("pointing", "facing"))
        if to:
            aim = Relator(Preposition("to", AIMED_PARTS[part]))
            found[i + 1] = replace(after, value=aim)
        tool = any(c.type == "NP" and last_word(c.value.head) in HEADED for c in found[:i])
        whose = chunk.value
        own = part in _OF_TOOLS or (tool and part == "edge")
        if aims and before.type == "WITH" and whose.determiner == "the" and own:
            whose = replace(whose, determiner=None, owner=NounPhrase(whose.span, pronoun="it"))
        if aims and part == "bowl" and tool and whose.owner is not None:
            whose = replace(whose, head="tip")
        found[i] = replace(chunk, value=whose)
    return found


def _with_shared_objects(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the stand holds a cup below or behind the jug* with the jug after both prepositions.

    After *have*, the second place would be that of the subject: *one side has a lamp above or below the box*.
    """
    found: list[Chunk] = []
    end = 0
    for i, chunk in enumerate(chunks):
        if i < end:
            continue
        types = [type_at(chunks, i + k) for k in range(-2, 4)]
        shares = types[:3] == ["TVERB", "NP", "ADV"] and types[3] in ("AND", "OR") and types[4:] == ["PREP", "NP"]
        heights = ("above", "below", "behind", "in_front", "under")
        if shares and chunk.value.preposition.relation in heights and chunks[i - 2].value.lemma == "have":
            end = i + 4
            if types[3] == "AND":
                found += [replace(chunk, type="PREP"), replace(chunks[i + 3], start=chunk.end)]
            leave_out(chunks[i + (types[3] == "AND") : end], "this does not say which of the two is where")
        elif shares and chunk.value.preposition.relation in heights:
            shared = replace(chunks[i + 3], start=chunk.end, end=chunk.end)
            found += [replace(chunk, type="PREP"), shared]
        else:
            found.append(chunk)
    return found


def _with_aims_of_subjects(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with a comma before what tells how and where else a thing is put, after its place.

    *Lay the knife above the plate pointing left* is read as *lay the knife above the plate, pointing left*, and *put
    the plate at the centre of the mat about 2 cm from its edge* as *…, about 2 cm from its edge*.
    """
    found: list[Chunk] = []
    put = False
    for i, chunk in enumerate(chunks):
        put = put and chunk.type not in FINITE
        placed = chunk.type == "PART" and chunk.value.lemma in PUT_VERBS and chunk.value.form != "ing"
        put = put or chunk.type == "PUT" or placed
        aims = chunk.type == "PART" and chunk.value.kind in ("point", "face")
        turned = chunk.type == "PREP" and chunk.value.preposition.relation in ("pointing", "facing")
        again = chunk.type == "PREP" and not _EXACTLY.isdisjoint(chunk.value.adverbs)
        again = again or (chunk.type == "MEASURE" and type_at(chunks, i + 1) == "PREP")
        at = len(found) - 2
        if put and chunk.type == "PREP" and _is_filled(found):  # 'put a jug filled with water between the cups'
            found.insert(at, put_in("COMMA", found[at]))
            found += [put_in("COMMA", chunk), chunk]
            continue
        while type_at(found, at) == "OF" and type_at(found, at - 1) == "NP":
            at -= 2
        place = found[at].value.preposition.relation if type_at(found, at) == "PREP" else ""
        of_place = place in ("on", "inside") and not _names_place(found, at + 1)  # 'on the shelf facing the door'
        accompanied = [type_at(found, at - 2), type_at(found, at - 1)] == ["WITH", "NP"]  # whose aim this is
        aims = aims and not accompanied
        if put and place and type_at(found, len(found) - 1) == "NP" and (aims or (not of_place and (turned or again))):
            found.append(put_in("COMMA", chunk))
        found.append(chunk)
    return found


def _names_place(chunks: list[Chunk], at: int) -> bool:
    return type_at(chunks, at) == "NP" and is_place(chunks[at].value)


def _is_filled(chunks: list[Chunk]) -> bool:
    """Return True for chunks that end with a thing and what it is filled with."""
    with_phrase = [chunk.type for chunk in chunks[-3:]] == ["NP", "WITH", "NP"]
    return with_phrase and chunks[-2].value.preposition.phrase.endswith("filled with")


def _with_places_of_nearest(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks of *is closest to the plate on the left* with a comma before the second place."""
    found = list(chunks)
    for i in range(len(found) - 4, -1, -1):
        types = [chunk.type for chunk in found[i : i + 5]]
        if types[:4] != ["PREP", "NP", "PREP", "NP"] or types[4:] == ["OF"]:
            continue
        near, second = found[i].value.preposition, found[i + 2]
        if (
            near.degree is Degree.SUPERLATIVE
            and is_place(found[i + 3].value)
            and second.value.preposition.phrase == "on"
        ):
            found.insert(i + 2, put_in("COMMA", second))
    return found


def _with_gaps(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks of *leave (a gap of) 2 cm between the cup and the jug* as *leave the cup 2 cm from the jug*."""
    found = list(chunks)
    for i in range(len(found) - 5, -1, -1):
        gap = [c.type for c in found[i + 1 : i + 3]] == ["NP", "OF"] and found[i + 1].value.head in _GAPS
        at = i + 3 if gap else i + 1
        types = [chunk.type for chunk in found[at : at + 5]]
        if found[i].type not in ("PUT", "DO") or found[i].value.lemma not in ("leave", "keep", "allow", "maintain"):
            continue
        if types == ["MEASURE", "PREP", "NP", "AND", "NP"] and found[at + 1].value.preposition.relation == "between":
            measure, _, first, joint, second = found[at : at + 5]
            put = Chunk("PUT", found[i].start, found[i].end, found[i].value, found[i].span)
            off = Relator(Preposition("from", "measured_from"))
            away = Chunk("PREP", joint.start, joint.end, off, joint.span)
            found[i : at + 5] = [put, first, measure, away, second]
    return found


def _with_owners_of_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the proper place for the fork is …* as *the proper place of the fork is …*."""
    found = list(chunks)
    for i, chunk in enumerate(chunks):
        types = [type_at(chunks, i + k) for k in range(4)]
        begins = type_at(chunks, i - 1) in JOINT_TYPES | {"", "ADVERB"}
        if begins and types == ["NP", "PREP", "NP", "BE"] and chunk.value.head in PLACES_OF:
            relator = chunks[i + 1]
            if relator.value.preposition.phrase == "for":
                found[i + 1] = Chunk("OF", relator.start, relator.end, None, relator.span)
    return found


def _with_options_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Return *it is on the tray, either beside A or behind B* as *it is on the tray; it is beside A or behind B*."""
    at = next((i for i, chunk in enumerate(chunks) if chunk.type == "ADVERB" and chunk.value == "either"), 0)
    if at < 2 or chunks[at - 1].type not in ("COMMA", "CUT") or type_at(chunks, at + 1) not in ("PREP", "ADV"):
        return chunks
    end = next((k for k in range(at, len(chunks)) if chunks[k].type in JOINT_TYPES - {"OR"}), len(chunks))
    first = max((k + 1 for k in range(at - 1) if chunks[k].type in JOINT_TYPES), default=0)
    before = [chunk for chunk in chunks[first : at - 1] if chunk.type != "ADVERB"]
    types = [chunk.type for chunk in before]
    is_placed = types[-2:] == ["PREP", "NP"] or types[-4:] == ["PREP", "NP", "OF", "NP"]
    if not is_placed or "OR" not in [chunk.type for chunk in chunks[at:end]]:
        return chunks
    if types[:2] == ["PUT", "NP"] and before[0].value.positive:
        thing, verb = before[1], Chunk("BE", at, at, VerbGroup("be", "be", "finite"), chunks[at].span)
    elif types[:2] in (["NP", "BE"], ["NP", "VERB"]) and before[1].value.positive:
        thing, verb = before[0], before[1]
        verb = Chunk("BE", at, at, replace(verb.value, lemma="be", kind="be", form="finite"), chunks[at].span)
    else:
        return chunks
    cut, *again = apart([thing], [verb, *chunks[at + 1 : end]], chunks[at - 1].span)
    return [*chunks[: at - 1], cut, *again, *chunks[end:]]


REWRITES = (
    _with_options_apart, _with_owners_of_places, _with_measures_denied, _with_destinations,
    without(_place_taken), _with_gaps, _with_aimed_parts, _with_shared_objects,
    _with_aims_of_subjects, _with_places_of_nearest,
)  # fmt: skip
"""Rewritings of places, in their order."""
