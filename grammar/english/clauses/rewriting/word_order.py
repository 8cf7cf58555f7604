"""Undo inversions and put in what a relative clause leaves out, so that each clause has a plain order of words."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.clauses.rewriting.editing import (
    BREAKS,
    ENDS,
    PREDICATES,
    Run,
    emptied,
    end_before,
    put_in,
    type_at,
    without,
    word_of,
)
from deixis.grammar.english.tree import NounPhrase
from deixis.grammar.english.vocabulary.nouns import GENERAL, HOLDERS, SURFACES, VESSELS, last_word
from deixis.grammar.english.vocabulary.relation_words import Preposition
from deixis.grammar.english.vocabulary.verbs import verb_forms

_FOUND_OR_PUT = frozenset(
    {
        "have",
        "see",
        "find",
        "keep",
        "put",
        "place",
        "leave",
        "set",
        "lay",
        "hang",
        "store",
        "notice",
        "stick",
        "line",
        "arrange",
        "stack",
        "tuck",
        "stand",
        "hide",
        "want",
        "like",
    }
)
"""Verbs whose object is somewhere: *the rest you will find on the shelf*."""

_REGIONS = frozenset({"corner", "middle", "centre", "center", "side"})
"""Nouns of regions, in or on which things are."""

_ORDERS = frozenset({"order", "sequence", "arrangement", "line-up"})
"""Nouns of the way in which things follow one another."""

_HOLDING = frozenset({"have", "hold", "contain", "display", "feature", "house"})
"""Verbs of what is in a region."""

_FILLING = frozenset({"fill", "occupy", "take", "decorate"})
"""Participles of what is in a region."""

_STORING = frozenset({"keep", "store", "put", "hang", "stow", "stash", "leave", "hold"})
"""Verbs of what is kept in the thing before *where*."""

_PLACEMENTS = frozenset({"placement", "position", "location"})
"""Nouns for the place of a thing, of which a place says where the thing is."""

_RESTING = frozenset({"lay", "stand", "hang", "rest", "sit", "lean"})
"""Verbs that turn a clause round: *and behind that, in a row, stand your letters*."""


def _with_placed_subjects(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the placement of the spoon should be …* with the spoon as its subject."""
    for at in range(len(chunks) - 3):
        types = [type_at(chunks, at + k) for k in range(-1, 5)]
        begins = types[0] in ENDS | {"ADVERB"} and types[1:5] == ["NP", "OF", "NP", "BE"]
        if begins and types[5] in ("PREP", "ADV"):
            phrase = chunks[at].value
            plain = not (phrase.adjectives or phrase.predicates or phrase.plural or phrase.owner)
            if phrase.head in _PLACEMENTS and phrase.determiner == "the" and plain:
                return [*chunks[:at], *chunks[at + 2 :]]
    return chunks


def _with_participles_of_posture(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the candle is stood on the mat* with a participle."""
    return [
        replace(chunk, type="PART")
        if chunk.type == "VERB" and chunk.value.lemma in ("stand", "sit") and chunk.value.form == "past"
        and type_at(chunks, i - 1) == "BE" else chunk
        for i, chunk in enumerate(chunks)
    ]  # fmt: skip


def _stranded(chunks: list[Chunk], at: int) -> Run | None:
    """Find the preposition at the end of a relative clause: *the bell you were hoping for is …*."""
    chunk = chunks[at]
    bare = chunk.type in ("UNKNOWN", "ADVERB") and chunk.value in ("for", "about", "with", "of", "at", "to")
    ends = bare and type_at(chunks, at - 1) in FINITE | {"PART", "NP"} and type_at(chunks, at + 1) in FINITE
    return (at + 1, None) if ends and "REL" in [c.type for c in chunks[:at]] else None


def _without_resumed_subjects(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out the pronoun of *the capsules they are inside the tin*."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        resumes = (
            chunk.type == "NP" and chunk.value.pronoun in ("it", "they") and bool(found) and found[-1].type == "NP"
            and type_at(chunks, i + 1) in FINITE and (len(found) == 1 or found[-2].type in JOINT_TYPES | {"ADVERB"})
            and bool(found[-1].value.head) and found[-1].value.plural is (chunk.value.pronoun == "they")
        )  # fmt: skip
        if not resumes:
            found.append(chunk)
    return found


def _with_existential_have(chunks: list[Chunk]) -> list[Chunk]:
    """Return *in the room has a table* as *in the room there is a table*."""
    for i, chunk in enumerate(chunks):
        places = [c.type for c in chunks[:i] if c.type != "ADVERB"]
        turned = places[:1] == ["PREP"] and places.count("NP") == places.count("PREP") + places.count("OF")
        if chunk.type == "TVERB" and chunk.value.lemma == "have" and turned and set(places) <= {"PREP", "NP", "OF"}:
            there = Chunk("THERE", chunk.start, chunk.start, None, (chunk.span[0], chunk.span[0]))
            be = Chunk("BE", chunk.start, chunk.end, replace(chunk.value, lemma="be", kind="be"), chunk.span)
            return [*chunks[:i], there, be, *chunks[i + 1 :]]
    return chunks


def _with_objects_after_verbs(chunks: list[Chunk]) -> list[Chunk]:
    """Put an object that stands first after its verb: *the rest you'll find on the shelf*, *the bread I put it …*."""
    for i, chunk in enumerate(chunks):
        before = type_at(chunks, i - 1)
        first = chunk.type == "NP" and bool(chunk.value.head) and (before in JOINT_TYPES or not before)
        at = i + 1  # of the person
        while (
            first
            and type_at(chunks, at) in ("COMMA", "AND")
            and "NP" in (type_at(chunks, at + 1), type_at(chunks, at + 2))
        ):
            at += 2 if type_at(chunks, at + 1) == "NP" else 3
        verb = chunks[at + 1] if at + 1 < len(chunks) else None
        if not first or verb is None or verb.type not in ("VERB", "TVERB"):
            continue
        person = type_at(chunks, at) == "NP" and chunks[at].value.pronoun in ("me", "you", "we", "he", "she")
        if not person or verb.value.lemma not in _FOUND_OR_PUT:
            continue
        again = verb.type == "TVERB" and type_at(chunks, at + 2) == "NP"
        again = again and chunks[at + 2].value.pronoun in ("it", "they")
        place = at + 2 + again
        place += type_at(chunks, place) == "ADVERB"
        end = next((k for k in range(place, len(chunks)) if chunks[k].type in JOINT_TYPES), len(chunks))
        goes_on = any(c.type in FINITE for c in chunks[place:end]) or (
            "COMMA" in (c.type for c in chunks[end : end + 1]) and type_at(chunks, end + 1) in FINITE
        )
        if goes_on or type_at(chunks, place) not in ("PREP", "ADV") or (verb.type == "TVERB" and not again):
            continue
        if not again and not before and at == i + 1:
            continue  # 'the chair you see on the left' describes one thing
        if at > i + 1:  # 'soy, vinegar and oil I keep behind the tray' are behind it
            be = Chunk("BE", verb.start, verb.end, replace(verb.value, lemma="be", kind="be"), verb.span)
            return [*chunks[:at], be, *_with_objects_after_verbs(chunks[place:])]
        moved = Chunk("TVERB", verb.start, verb.end, verb.value, verb.span)
        return [*chunks[:i], chunks[at], moved, chunk, *_with_objects_after_verbs(chunks[place:])]
    return chunks


def _with_parts_after_verbs(chunks: list[Chunk]) -> list[Chunk]:
    """Move the description of a part to the end: *the tweezers, points to the left, lie along the edge*."""
    for i in range(1, len(chunks) - 3):
        subject, part = chunks[i - 1], chunks[i + 1]
        if [type_at(chunks, i + k) for k in (-1, 0, 1)] != ["NP", "COMMA", "NP"] or not subject.value.head:
            continue
        if type_at(chunks, i - 2) not in JOINT_TYPES | {"", "ADVERB"} or type_at(chunks, i + 2) not in PREDICATES:
            continue
        own = part.value.owner is not None and part.value.owner.pronoun in ("it", "they")
        if not part.value.head or not (own or (part.value.determiner is None and part.value.owner is None)):
            continue
        end = end_before(chunks, i + 2, JOINT_TYPES)
        if type_at(chunks, end) != "COMMA" or type_at(chunks, end + 1) not in FINITE:
            continue
        if any(chunk.type in FINITE | {"REL"} for chunk in chunks[i + 2 : end]):
            continue
        last = end_before(chunks, end + 1, JOINT_TYPES)
        return [*chunks[:i], *chunks[end + 1 : last], *chunks[i:end], *_with_parts_after_verbs(chunks[last:])]
    return chunks


def _with_relative_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with *on which* resolved.

    *The chair on which the coat hangs* is read as *the chair that the coat hangs on*, and *a board on which there are
    two onions* as two clauses, of which the second says *on the board there are two onions*.
    """
    found: list[Chunk] = []
    waiting: Chunk | None = None
    for i, chunk in enumerate(chunks):
        following = chunks[i + 1] if i + 1 < len(chunks) else None
        which = following is not None and following.type == "NP" and following.value.pronoun == "which"
        if chunk.type == "PREP" and which and found and i + 2 < len(chunks):
            if chunks[i + 2].type == "NP" and chunks[i + 2].value.pronoun not in ("me", "you", "we", "someone"):
                found.append(Chunk("REL", chunk.start, chunk.start + 1, None, chunk.span))
                waiting = Chunk("ADV", chunk.start, chunk.end, chunk.value, chunk.span)
                continue
            before = next((c for c in reversed(found) if c.type == "NP" and _names_thing(c.value)), None)
            if before is not None:
                found.append(Chunk("CUT", chunk.start, chunk.start, None, chunk.span))
        elif chunk.type == "NP" and chunk.value.pronoun == "which" and i and chunks[i - 1].type == "PREP":
            if waiting is not None and chunks[i - 1].span == waiting.span:
                continue
            before = next((c for c in reversed(found[:-2]) if c.type == "NP" and _names_thing(c.value)), None)
            if before is not None:
                value = NounPhrase(chunk.span, before.value.head, "the", plural=before.value.plural)
                chunk = Chunk("NP", chunk.start, chunk.end, value, chunk.span)
        found.append(chunk)
        if waiting is not None and chunk.type in ("VERB", "BE"):
            found.append(waiting)
            waiting = None
    return found


def _with_places_where(chunks: list[Chunk]) -> list[Chunk]:
    """Return *there is a box where I keep my pens* with *the pens are in the box* as a clause of its own."""
    for i, chunk in enumerate(chunks):
        if chunk.type != "REL" or chunk.value != "where":
            continue
        end = end_before(chunks, i, BREAKS)
        clause = [c for c in chunks[i + 1 : end] if c.type != "ADVERB"]
        types = [c.type for c in clause]
        verb = next((k for k, c in enumerate(clause) if c.type in FINITE), 0)
        group = clause[verb].value if clause else None
        if not verb or not isinstance(group, VerbGroup) or group.past or not group.positive:
            continue
        by_person = types[:2] == ["NP", "TVERB"] and clause[0].value.pronoun in ("me", "we", "you")
        things = clause[2:] if by_person and group.lemma in _STORING else []
        stored = types[verb:] == ["BE", "PART"] and clause[-1].value.lemma in _STORING
        things = clause[:verb] if stored else things
        holder = next((c for c in reversed(chunks[:i]) if c.type == "NP" and _holds(c.value)), None)
        if holder is None or not things or {c.type for c in things} - {"NP", "AND"} or things[-1].type != "NP":
            continue
        inner = last_word(holder.value.head) not in SURFACES or last_word(holder.value.head) == "cabinet"
        place = Preposition("in", "inside") if inner else Preposition("on", "on")
        named = NounPhrase(chunk.span, holder.value.head, "the", plural=holder.value.plural)
        span = (chunk.span[0], chunk.span[0])
        being = Chunk("BE", i, i, VerbGroup("be", "be", "finite"), span)
        where = [Chunk("PREP", i, i, Relator(place), span), Chunk("NP", chunk.start, chunk.end, named, chunk.span)]
        return [*chunks[:i], Chunk("CUT", i, i, None, span), *things, being, *where, *chunks[end:]]
    return chunks


def _holds(phrase: NounPhrase) -> bool:
    return last_word(phrase.head) in VESSELS | HOLDERS | SURFACES


def _names_thing(phrase: NounPhrase) -> bool:
    """Return True for a thing and not for its place: *a drawer at the front, in which …*."""
    return bool(phrase.head) and not is_place(phrase)


def _with_verbs_after_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with a verb of posture that looks like a plural: *in between stands the cup*."""
    for i in range(1, len(chunks) - 1):
        if [chunk.type for chunk in chunks[i - 1 : i + 2]] != ["ADV", "NP", "NP"]:
            continue
        word, subject = chunks[i].value, chunks[i + 1].value
        form = verb_forms().get(f"{word.head}s") if word.plural and chunks[i].end == chunks[i].start + 1 else None
        begins = type_at(chunks, i - 2) in JOINT_TYPES | {"", "ADVERB"}
        ends = type_at(chunks, i + 2) in JOINT_TYPES | {"", "WITH", "PREP"}
        if form is None or form.form != "s" or form.lemma not in _RESTING or not (begins and ends):
            continue
        if subject.determiner is not None or subject.owner is not None or subject.count is not None:
            chunks[i] = replace(chunks[i], type="VERB", value=VerbGroup(form.lemma, form.kind, "s"))
    return chunks


def _with_contact_clauses(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with the relative pronoun of *the book I am reading* put in."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        contact = (
            chunk.type == "NP"
            and chunk.value.pronoun in ("me", "you", "we", "he", "she", "nothing", "everyone", "someone")
            and found
            and found[-1].type == "NP"
            and bool(found[-1].value.head)
            and not (len(found) > 1 and found[-2].type in ("PREP", "OF"))
            and i + 1 < len(chunks)
            and chunks[i + 1].type in FINITE
            and not (
                chunks[i + 1].type == "TVERB" and type_at(chunks, i + 2) == "NP" and bool(chunks[i + 2].value.head)
            )
        )
        stranded = [type_at(chunks, i + k) for k in (-1, 0, 2)] == ["NP", "NP", "ADV"]  # 'the box the pens are in'
        stranded = stranded and type_at(chunks, i + 1) in ("BE", "VERB") and bool(chunks[i - 1].value.head)
        if contact or (stranded and type_at(chunks, i + 3) in FINITE | ENDS):
            found.append(put_in("REL", chunk))
        found.append(chunk)
    return found


def _with_clefts(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the last thing that goes on the tray is the jug* as *the jug goes on the tray*."""
    for i in range(len(chunks) - 4):
        general = chunks[i].type == "NP" and last_word(chunks[i].value.head) in GENERAL and not chunks[i].value.members
        if not general or type_at(chunks, i + 1) != "REL" or type_at(chunks, i - 1) not in ENDS | {"ADVERB"}:
            continue
        be = next((k for k in range(i + 3, len(chunks) - 1) if chunks[k].type in FINITE | BREAKS), len(chunks))
        end = be + 2
        while type_at(chunks, end) in ("AND", "COMMA", "OF") and type_at(chunks, end + 1) == "NP":
            end += 2
        placed = any(chunk.type in ("PREP", "ADV") for chunk in chunks[i + 2 : be])
        named = type_at(chunks, be) == "BE" and type_at(chunks, be + 1) == "NP" and type_at(chunks, end) in ENDS
        if placed and named and chunks[be].value.positive and type_at(chunks, i + 2) in FINITE:
            return [*chunks[:i], *chunks[be + 1 : end], *chunks[i + 2 : be], *chunks[end:]]
    return chunks


def _with_objects_first(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the tin with the buttons I keep at its left* as *the tin with the buttons is at its left*."""
    for i in range(len(chunks) - 4):
        if type_at(chunks, i - 1) not in ENDS or [type_at(chunks, i + k) for k in range(3)] != ["NP", "WITH", "NP"]:
            continue
        person, verb = i + 3, i + 4
        placed = [type_at(chunks, person), type_at(chunks, verb)] in (["NP", "VERB"], ["NP", "TVERB"])
        placed = placed and chunks[person].value.pronoun in ("me", "we") and not chunks[person].value.head
        if not placed or chunks[verb].value.lemma not in _FOUND_OR_PUT or type_at(chunks, verb + 1) not in PREDICATES:
            continue
        if type_at(chunks, end_before(chunks, verb + 1, FINITE | BREAKS)) in FINITE:
            continue  # 'the tin with the buttons I keep in it is red'
        being = replace(chunks[verb].value, lemma="be", kind="be")
        return [
            *chunks[:person],
            emptied(chunks[person]),
            replace(chunks[verb], type="BE", value=being),
            *chunks[verb + 1 :],
        ]
    return chunks


def _with_orders(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the order from left to right is fork, plate, knife* as *from left to right: fork, plate, knife*."""
    for i, chunk in enumerate(chunks[:-3]):
        if chunk.type != "NP" or chunk.value.head not in _ORDERS or type_at(chunks, i - 1) not in ENDS | {"COMMA"}:
            continue
        after = [type_at(chunks, i + k) for k in (1, 2, 3)] == ["ADV", "BE", "NP"]
        before = [type_at(chunks, i + k) for k in (-2, -1, 1, 2)] == ["ADV", "COMMA", "BE", "NP"]
        way = chunks[i + 1 if after else i - 2] if after or before else None
        if way is not None and way.value.preposition.relation == "row":
            verb = i + 2 if after else i + 1
            return [*chunks[: i if after else i - 2], way, put_in("COLON", chunks[verb]), *chunks[verb + 1 :]]
    return chunks


def _with_places_before_verbs(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out the comma before the verb of a turned clause: *Behind it, propped against the wall, was a portrait*."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        lay = (
            type_at(chunks, i + 1) == "PUT"
            and chunks[i + 1].value.lemma in _RESTING
            and "AND" in (c.type for c in found)
        )
        if (
            chunk.type == "COMMA"
            and (type_at(chunks, i + 1) in ("BE", "VERB") or lay)
            and type_at(chunks, i + 2) == "NP"
        ):
            first = max((k + 1 for k, c in enumerate(found) if c.type in JOINT_TYPES - {"COMMA", "AND"}), default=0)
            clause = [c.type for c in found[first:] if c.type not in ("ADVERB", "COMMA", "AND")]
            if FINITE & set(clause) or "THERE" in clause:
                first = max((k + 1 for k, c in enumerate(found) if c.type in JOINT_TYPES - {"COMMA"}), default=0)
                clause = [c.type for c in found[first:] if c.type not in ("ADVERB", "COMMA", "AND")]
            objects = sum(kind in ("PREP", "TPART", "OF") for kind in clause)
            amid = any(c.type == "PREP" and c.value.preposition.relation in ("between", "among") for c in found[first:])
            objects += amid and sum(chunk.type == "AND" for chunk in found[first:])
            places = clause[:1] in (["PREP"], ["ADV"]) and clause.count("NP") == objects
            if places and not (FINITE & set(clause)):
                if lay:
                    chunks[i + 1].type = "VERB"
                continue
        found.append(chunk)
    return found


def _with_filled_regions(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the corner of the tray holds a lamp*, *fill the corner with …* as *a lamp is in the corner of the tray*.

    A region is where a thing is, and has nothing itself.
    """
    for i, chunk in enumerate(chunks):
        if (
            chunk.type != "NP"
            or chunk.value.head not in _REGIONS
            or type_at(chunks, i - 1) not in ENDS | {"AND", "PUT"}
        ):
            continue
        verb = i + 1 + 2 * ([type_at(chunks, i + 1), type_at(chunks, i + 2)] == ["OF", "NP"])
        if chunk.value.head == "side" and verb > i + 1:
            continue  # 'the left side of the jar has a label'
        group = chunks[verb].value if type_at(chunks, verb) in FINITE else None
        first, being = verb + 1, None
        if type_at(chunks, i - 1) == "PUT" and chunks[i - 1].value.lemma == "fill" and type_at(chunks, verb) == "WITH":
            being = replace(chunks[i - 1], value=replace(chunks[i - 1].value, lemma="place", kind="posture"))
        elif isinstance(group, VerbGroup) and type_at(chunks, verb) == "TVERB" and group.lemma in _HOLDING:
            being = replace(chunks[verb], type="BE", value=replace(group, lemma="be", kind="be"))
        elif isinstance(group, VerbGroup) and type_at(chunks, verb) == "BE":
            done = type_at(chunks, first) == "PART" and type_at(chunks, first + 1) in ("PREP", "WITH")
            done = done and word_of(chunks[first + 1]) in ("by", "with") and chunks[first].value.lemma in _FILLING
            first += 2 if done else type_at(chunks, first) == "WITH"
            being = chunks[verb] if first > verb + 1 else None
        end = end_before(chunks, first, BREAKS)
        things = chunks[first:end]
        if being is None or not things or {c.type for c in things} - {"NP", "AND"} or things[0].type != "NP":
            continue
        inner = Relator(Preposition(*("on", "on") if chunk.value.head == "side" else ("in", "inside")))
        place = [Chunk("PREP", chunk.start, chunk.start, inner, (chunk.span[0], chunk.span[0])), *chunks[i:verb]]
        if being.type == "PUT":
            return [*chunks[: i - 1], being, *things, *place, *chunks[end:]]
        return [*chunks[:i], *things, being, *place, *chunks[end:]]
    return chunks


REWRITES = (
    _with_clefts, _with_orders, _with_filled_regions, _with_places_where, _with_placed_subjects,
    _with_verbs_after_places,
    _with_participles_of_posture, _without_resumed_subjects, _with_existential_have, _with_parts_after_verbs,
    _with_relative_places, _with_objects_after_verbs, _with_objects_first, _with_contact_clauses, without(_stranded),
    _with_places_before_verbs,
)  # fmt: skip
"""Rewritings that put clauses into plain order, one after the other."""
