"""Fill in clauses that share words with the one before, and undo clefts: *so is the cup*, *one of which …*."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.clauses.rewriting.editing import ENDS, cut, end_before, put_in, type_at
from deixis.grammar.english.tree import NounPhrase
from deixis.grammar.english.vocabulary.adjectives import EMPTY
from deixis.grammar.english.vocabulary.nouns import PARTS
from deixis.grammar.english.vocabulary.tables import word_set

_LOOKING = word_set("look peek peep peer search check open lift")
"""Verbs of a sentence that sends the reader to a place."""
_SEEING = word_set("see find notice discover spot")
"""Verbs of a sentence that says what is there."""
_NOT_THERE = word_set("facing pointing to at from through")
"""Relations of *look* that do not say where the thing is that one sees."""


def with_pairs_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Return *A and B go in the first and the second drawer* as one clause for each thing and its place.

    Parameters
    ----------
    chunks
        Chunks of a sentence in the order of the text.

    Returns
    -------
    list of Chunk
        Chunks in which the verb is repeated for each pair, if the places are numbered or *respectively* follows.
    """
    for i, chunk in enumerate(chunks):
        if type_at(chunks, i - 1) not in JOINT_TYPES | {"", "PUT"} or chunk.type != "NP":
            continue
        things, end = _listed(chunks, i)
        placed = type_at(chunks, i - 1) == "PUT"
        verb = end
        while type_at(chunks, end) in FINITE | {"PART"}:
            end += 1
        if len(things) < 2 or type_at(chunks, end) != "PREP" or (placed is (end > verb)):
            continue
        places, after = _listed(chunks, end + 1)
        stop = end_before(chunks, after, JOINT_TYPES - {"COMMA"})
        respective = [k for k in range(after, stop) if _is_respective(chunks[k])]
        ordered = all(place.value.adjectives and place.value.adjectives[0].rank for place in places)
        if len(places) != len(things) or not (respective or ordered) or not places[-1].value.head:
            continue
        of = [c for c in chunks[after : respective[0] if respective else stop] if c.type != "COMMA"]
        begin, found = (i - 1 if placed else i), list(chunks[: i - 1 if placed else i])
        for thing, place in zip(things, places, strict=True):
            value = place.value if place.value.head else replace(place.value, head=places[-1].value.head)
            here = replace(place, value=replace(value, determiner=value.determiner or "the"))
            found += [*chunks[begin:i], thing, *chunks[verb:end], chunks[end], here, *of, cut(place)]
        return [*found, *with_pairs_apart(chunks[stop:])]
    return chunks


def _listed(chunks: list[Chunk], at: int) -> tuple[list[Chunk], int]:
    """Return the noun phrases of a list with *and* before the last, and the place after it."""
    found, joined, i = [], False, at
    while type_at(chunks, i) == "NP":
        found.append(chunks[i])
        i += 1
        if joined or type_at(chunks, i) not in ("COMMA", "AND"):
            break
        joined = "AND" in (type_at(chunks, i), type_at(chunks, i + 1))
        i += 1 + (type_at(chunks, i + 1) == "AND" and type_at(chunks, i) == "COMMA")
    return (found, i) if joined else ([], at)


def _with_listed_places_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Return *jars on the top shelf, cups and mugs in the middle, pans at the bottom* as one note for each place."""
    if any(chunk.type in FINITE | {"REL", "SUB", "COLON"} for chunk in chunks) or type_at(chunks, 0) not in (
        "NP",
        "PUT",
    ):
        return chunks
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        after = i + 1 + (type_at(chunks, i + 1) == "AND")
        things = [c.value for c in chunks[after : after + 3 : 2] if c.type == "NP"]
        listed = [type_at(chunks, after + k) for k in range(3)] == ["NP", "AND", "NP"] and len(things) == 2
        placed = type_at(chunks, i - 2) == "PREP" and type_at(chunks, i - 1) == "NP"
        own = type_at(chunks, after + 3) in ("PREP", "ADV") and type_at(chunks, after + 4) in ("NP", "COMMA", "CUT", "")
        if chunk.type != "COMMA" or not (listed and placed and own):
            found.append(chunk)
            continue
        landmark, relation = chunks[i - 1].value, chunks[i - 2].value.preposition.relation
        bare = all(t.determiner is None and t.owner is None and t.plural and not t.pronoun for t in things)
        apart = bare and landmark.determiner is not None and relation not in ("between", "among")
        found.append(cut(chunk) if apart else chunk)
    return found


def _without_one_of_each_side(chunks: list[Chunk]) -> list[Chunk]:
    """Return *two lamps, one either side of it* as *two lamps either side of it*."""
    for i in range(1, len(chunks)):
        types = [type_at(chunks, i + k) for k in range(-1, 3)]
        if types != ["NP", "COMMA", "NP", "PREP"]:
            continue
        group, each = chunks[i - 1].value, chunks[i + 1].value
        half = each.count is not None and not each.head and 2 * each.count == group.count
        if (
            (each.pronoun == "one" or half)
            and chunks[i + 2].value.preposition.relation == "each_side"
            and chunks[i - 1].value.plural
        ):
            return [*chunks[:i], *_without_one_of_each_side(chunks[i + 2 :])]
    return chunks


def _with_own_parts_after(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the bucket, tongs hooked over its rim, is in front* with the aside at the end of the clause."""
    for i in range(1, len(chunks)):
        types = [type_at(chunks, i + k) for k in range(-1, 6)]
        aside = types[:3] == ["NP", "COMMA", "NP"] and types[3] in ("PART", "PREP") and types[0] not in JOINT_TYPES
        part = types[:5] == ["NP", "COMMA", "NP", "ADV", "COMMA"] and chunks[i + 1].value.determiner is None
        if part and chunks[i + 1].value.head in PARTS and type_at(chunks, i + 4) == "PREP":
            stop = end_before(chunks, i + 4, JOINT_TYPES)  # 'top hat, brim up, in the middle of the table'
            return [*chunks[:i], *chunks[i + 4 : stop], chunks[i], *chunks[i + 1 : i + 3], *chunks[stop:]]
        end = i + 3 + (types[3] == "PART" and types[4] == "PREP")
        own = aside and type_at(chunks, end) == "NP" and type_at(chunks, end + 1) == "COMMA"
        if not own or type_at(chunks, i - 2) not in JOINT_TYPES | {""} or chunks[i + 1].value.head == "":
            continue
        owner = chunks[end].value.owner
        if owner is None or owner.pronoun not in ("it", "they") or type_at(chunks, end + 2) not in FINITE | {"PREP"}:
            continue
        stop = end_before(chunks, end + 2, JOINT_TYPES)
        return [*chunks[:i], *chunks[end + 2 : stop], cut(chunks[i]), *chunks[i + 1 : end + 1], *chunks[stop:]]
    return chunks


def _without_verbs_of_comparison(chunks: list[Chunk]) -> list[Chunk]:
    """Return *closer to the jug than the cup is* without the verb at the end."""
    return [
        chunk
        for i, chunk in enumerate(chunks)
        if not (
            [type_at(chunks, i - 2), type_at(chunks, i - 1)] == ["THAN", "NP"]
            and chunk.type in FINITE and type_at(chunks, i + 1) in ENDS
        )
    ]  # fmt: skip


def _with_shared_references(chunks: list[Chunk]) -> list[Chunk]:
    """Return *one on the left and the other on the right of it* with *of it* after both sides."""
    for i, chunk in enumerate(chunks):
        types = [type_at(chunks, i + k) for k in range(-2, 6)]
        joined = types[:3] == ["NP", "PREP", "NP"] and types[3] in ("AND", "CUT")
        pair = joined and types[4:] == ["NP", "PREP", "NP", "OF"] and chunks[i - 2].value.pronoun == "one"
        if pair and {chunk.value.head, chunks[i + 4].value.head} == {"left", "right"} and chunk.value.of is None:
            return [*chunks[: i + 1], *chunks[i + 5 : i + 7], *chunks[i + 1 :]]
    return chunks


def _without_order_in_lists(chunks: list[Chunk]) -> list[Chunk]:
    """Return *on the left there is a cup, then a jug* without *then*, which is the order of the list.

    After an inversion, *then* joins two subjects: *next to it lies a fork, then a spoon*.
    """
    for i, chunk in enumerate(chunks):
        if chunk.type != "THEN" or type_at(chunks, i - 1) not in ("AND", "COMMA") or type_at(chunks, i + 1) != "NP":
            continue
        listed = [c.type for c in chunks[i + 2 :] if c.type not in ("COMMA", "AND", "THEN", "NP", "CUT")]
        verbs = [k for k in range(i) if chunks[k].type in FINITE]
        inverted = bool(verbs) and [type_at(chunks, k) for k in (0, verbs[-1], verbs[-1] + 1)] == ["PREP", "VERB", "NP"]
        if inverted and verbs[-1] + 3 == i and not listed:
            return [*chunks[: i - 1], replace(chunks[i], type="AND"), *chunks[i + 1 :]]
        verb = max((k for k in verbs if chunks[k].type in ("TVERB", "BE")), default=i)
        begins = [k + 1 for k in range(verb, i) if chunks[k].type in ("TVERB", "BE", "COMMA", "AND", "THEN")]
        if not listed and begins and all(type_at(chunks, k) in ("NP", "WITH", "AND", "THEN") for k in begins):
            return _without_order_in_lists([*chunks[:i], *chunks[i + 1 :]])
    return chunks


def _without_colons_before_verbs(chunks: list[Chunk]) -> list[Chunk]:
    """Return *Bin: should be under the sink* as *bin should be under the sink*."""
    labelled = [type_at(chunks, k) for k in range(2)] == ["NP", "COLON"] and type_at(chunks, 2) in FINITE
    return [chunks[0], *chunks[2:]] if labelled else chunks


def _without_kinds_of_members(chunks: list[Chunk]) -> list[Chunk]:
    """Return *three cups, one red and two white, stand …* without what its members are like."""
    for i in range(1, len(chunks)):
        group = chunks[i - 1].value if type_at(chunks, i - 1) == "NP" and chunks[i].type in ("COMMA", "CUT") else None
        if group is None or (group.count or 0) < 2 or not group.head:
            continue
        end = i + 1
        while type_at(chunks, end) in ("AND", "CUT", "ADJP") or (
            type_at(chunks, end) == "NP"
            and not chunks[end].value.head
            and bool(chunks[end].value.count or chunks[end].value.pronoun == "one")
        ):
            end += 1
        kinds = [c for c in chunks[i + 1 : end] if c.type == "NP"]
        if len(kinds) > 1 and type_at(chunks, end) in ("COMMA", "CUT") and type_at(chunks, end + 1) in FINITE:
            return [*chunks[:i], *chunks[end + 1 :]]
    return chunks


def _with_denied_participles_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Return *it lies left of the plate without touching it* with a comma, so that it describes the subject."""
    for i in range(len(chunks) - 1, 0, -1):
        if chunks[i].type == "NOT" and chunks[i].value == "without" and chunks[i - 1].type == "NP":
            chunks = [*chunks[:i], put_in("COMMA", chunks[i]), *chunks[i:]]
    return chunks


def _with_rows_after_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *on the shelf, from left to right, stand the cups* with the order first."""
    for i in range(1, len(chunks) - 1):
        order = chunks[i].type == "ADV" and chunks[i].value.preposition.relation == "row"
        aside = {type_at(chunks, i - 1), type_at(chunks, i + 1)} <= {"COMMA", "CUT"}
        if order and aside and type_at(chunks, i + 2) in FINITE | {"PUT"} and chunks[0].type == "PREP":
            return [chunks[i], *chunks[: i - 1], *chunks[i + 2 :]]
    return chunks


def _without_ends_of_the_past(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the radio, which stood on it until it hummed, is …* without the clause of *until*."""
    for i, chunk in enumerate(chunks):
        until = chunk.type == "SUB" and chunk.value == "until" and "REL" in [c.type for c in chunks[:i]]
        end = end_before(chunks, i + 1, frozenset({"COMMA", "CUT"}))
        if until and type_at(chunks, end) == "COMMA" and type_at(chunks, end + 1) in FINITE:
            return [*chunks[:i], *chunks[end:]]
    return chunks


def _with_denied_predicates(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the pens are in the box; the ruler isn't* with what the ruler is denied."""
    for i in range(4, len(chunks)):
        verb = chunks[i]
        denies = verb.type in FINITE and verb.value.lemma in ("do", "be") and not verb.value.positive
        bare = denies and verb.value.modal is None and type_at(chunks, i + 1) in JOINT_TYPES | {""}
        if not bare or type_at(chunks, i - 1) != "NP" or type_at(chunks, i - 2) not in JOINT_TYPES:
            continue
        first = max((k + 1 for k in range(i - 2) if chunks[k].type in JOINT_TYPES), default=0)
        types = [c.type for c in chunks[first : i - 2]]
        if types[:3] in (["NP", "VERB", "PREP"], ["NP", "BE", "PREP"]) and chunks[first + 1].value.positive:
            denied_verb = replace(chunks[first + 1], value=replace(chunks[first + 1].value, positive=False))
            predicate = [denied_verb, *chunks[first + 2 : i - 2]]
            return [*chunks[:i], *predicate, cut(verb), *_with_denied_predicates(chunks[i + 1 :])]
    return chunks


def _is_respective(chunk: Chunk) -> bool:
    """Return True for *respectively* and *in that order*."""
    if chunk.type == "ADV":
        relator: Relator = chunk.value
        return relator.preposition.phrase == "respectively"
    return chunk.type == "ADVERB" and chunk.value in ("in that order", "in this order", "in order")


def _with_there_as_being(chunks: list[Chunk]) -> list[Chunk]:
    """Return *there stands a clock in the corner* and *first comes a clock …* as *there is a clock in the corner*."""
    found = list(chunks)
    begins = type_at(found, 0) == "ADVERB" or (
        type_at(found, 0) == "NP" and not found[0].value.head and any(a.rank for a in found[0].value.adjectives)
    )
    comes = begins and type_at(found, 1) == "VERB" and found[1].value.lemma in ("come", "go", "follow")
    if comes and type_at(found, 2) == "NP" and found[2].value.determiner in ("a", "an", None):
        verb = found[1]
        be = Chunk("BE", verb.start, verb.end, replace(verb.value, lemma="be", kind="be"), verb.span)
        found[:2] = [replace(found[0], type="THERE", value=None), be]
    for i in range(1, len(found)):
        verb = found[i]
        if found[i - 1].type == "THERE" and verb.type in ("VERB", "TVERB", "PUT") and verb.value.kind == "posture":
            found[i] = Chunk("BE", verb.start, verb.end, replace(verb.value, lemma="be", kind="be"), verb.span)
    return found


def _with_repeated_predicates(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the ruler is in the case, and so is the pen* with the predicate of the ruler repeated for the pen."""
    for i, chunk in enumerate(chunks):
        if chunk.type not in JOINT_TYPES | {"UNKNOWN"}:
            continue
        end = i
        while type_at(chunks, end) in JOINT_TYPES - {"SUB"}:
            end += 1
        thing = _subject_of_ellipsis(chunks, end)
        if thing is None:
            continue
        start = max((k + 1 for k in range(i) if chunks[k].type in JOINT_TYPES - {"COMMA"}), default=0)
        verb = end_before(chunks[:i], start, FINITE)
        if verb >= i or not {"PREP", "ADV"} & {c.type for c in chunks[verb:i]}:
            continue
        stop = end_before(chunks, end + 2, JOINT_TYPES)
        return [*chunks[:i], cut(chunk), thing, *chunks[verb:i], *_with_repeated_predicates(chunks[stop:])]
    return chunks


def _subject_of_ellipsis(chunks: list[Chunk], at: int) -> Chunk | None:
    """Return the subject of *so is X*, *as does X*, *neither is X* and *X is too*; None for another clause."""
    first, types = chunks[at : at + 1], [type_at(chunks, at + k) for k in range(4)]
    if not first or types[3] not in JOINT_TYPES | {""}:
        return None
    word = first[0].value if types[0] in ("UNKNOWN", "SUB", "ADVERB") else None
    negated = types[0] == "NP" and first[0].value.pronoun == "neither" and not first[0].value.head
    if types[1] in FINITE and types[2] == "NP" and (word in ("so", "as") or negated) and _is_auxiliary(chunks[at + 1]):
        return chunks[at + 2]
    too = types[:3] == ["NP", types[1], "ADVERB"] and chunks[at + 2].value in ("too", "as well")
    return first[0] if too and types[1] in FINITE and _is_auxiliary(chunks[at + 1]) else None


def _is_auxiliary(verb: Chunk) -> bool:
    return verb.value.lemma in ("be", "do", "have") and verb.value.modal is None


def _without_clefts(chunks: list[Chunk]) -> list[Chunk]:
    """Return *it is the fork that lies on the left* as *the fork lies on the left*."""
    for i, chunk in enumerate(chunks):
        begins = chunk.type == "NP" and chunk.value.pronoun == "it" and type_at(chunks, i - 1) in JOINT_TYPES | {""}
        if not begins:
            continue
        rel = end_before(chunks, i, frozenset({"REL", "CUT", "SUB"}))
        if type_at(chunks, i + 1) == "BE" and type_at(chunks, i + 2) == "PREP" and type_at(chunks, rel) == "REL":
            seen = [type_at(chunks, rel + k) for k in (1, 2)] in (["NP", "TVERB"], ["NP", "VERB"])
            if seen and chunks[i + 1].value.positive:  # 'it is on the dresser that you will find the corkscrew'
                return [*chunks[:i], *chunks[i + 2 : rel], *chunks[rel + 1 :]]
        if [type_at(chunks, i + k) for k in (1, 2)] != ["BE", "NP"]:
            continue
        be, thing = chunks[i + 1].value, chunks[i + 2].value
        end = i + 3
        while [type_at(chunks, end), type_at(chunks, end + 1)] == ["OF", "NP"]:
            end += 2
        definite = bool(thing.head) and (thing.determiner in ("the", "this", "that") or thing.owner is not None)
        plain = be.positive and be.modal is None and not be.adverbs and not be.past
        if definite and plain and type_at(chunks, end) == "REL" and type_at(chunks, end + 1) in FINITE:
            return [*chunks[:i], *chunks[i + 2 : end], *_without_clefts(chunks[end + 1 :])]
    return chunks


def _with_ordinals_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the first holds rice, the second salt* with the verb for the second, whose noun is what it holds."""
    for i in range(len(chunks) - 4):
        if chunks[i].type != "NP" or chunks[i + 1].type != "TVERB":
            continue
        types = [type_at(chunks, i + k) for k in range(5)]
        if types[:3] != ["NP", "TVERB", "NP"] or types[3] not in ("COMMA", "CUT") or types[4] != "NP":
            continue
        first, verb, second = chunks[i], chunks[i + 1], chunks[i + 4]
        counted = [c.value.adjectives[0] if c.value.adjectives else None for c in (first, second)]
        ranked = [a is not None and a.rank is not None for a in counted]
        bare = not first.value.head and len(second.value.adjectives) == 1 and " " not in second.value.head
        if not all(ranked) or not bare or not second.value.head or type_at(chunks, i + 5) not in JOINT_TYPES | {""}:
            continue
        rank = second.value.adjectives[0]
        place = rank.span[1] + 1
        owner = Chunk(
            "NP", second.start, second.end, replace(second.value, head="", span=(second.span[0], rank.span[1]))
        )
        owner.span = owner.value.span
        held = replace(second.value, determiner=None, adjectives=(), span=(place, second.span[1]))
        again = replace(verb, span=(place, place))
        thing = Chunk("NP", second.start, second.end, held, held.span)
        return [*chunks[: i + 3], cut(chunks[i + 3]), *_with_ordinals_apart([owner, again, thing, *chunks[i + 5 :]])]
    return chunks


def _without_clefts_of_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *next to the stove is where the bin goes* as *the bin goes next to the stove*."""
    for i, chunk in enumerate(chunks):
        if chunk.type != "SUB" or chunk.value != "where" or type_at(chunks, i - 1) != "BE":
            continue
        first = max((k + 1 for k in range(i) if chunks[k].type in JOINT_TYPES), default=0)
        place, be, end = chunks[first : i - 1], chunks[i - 1].value, end_before(chunks, i + 1, JOINT_TYPES)
        plain = be.positive and be.modal is None and not be.past
        has_clause = type_at(chunks, i + 1) == "NP" and any(c.type in FINITE for c in chunks[i + 1 : end])
        if plain and has_clause and [c.type for c in place[:2]] == ["PREP", "NP"]:
            return [*chunks[:first], *chunks[i + 1 : end], *place, *chunks[end:]]
    return chunks


def _with_contrasts_at_subjects(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the fork lies on the left, not the knife* with what is denied beside the subject."""
    for i in range(2, len(chunks)):
        denied = chunks[i]
        if denied.type != "NP" or not denied.value.negated or type_at(chunks, i + 1) not in JOINT_TYPES | {""}:
            continue
        at_place = (
            type_at(chunks, i - 1) == "COMMA" and type_at(chunks, i - 2) == "NP" and is_place(chunks[i - 2].value)
        )
        first = max((k + 1 for k in range(i - 1) if chunks[k].type in JOINT_TYPES), default=0)
        begins_clause = type_at(chunks, first) == "NP" and type_at(chunks, first + 1) in FINITE
        if at_place and begins_clause and denied.value.head and not is_place(denied.value):
            comma = chunks[i - 1]
            moved = [chunks[first], comma, denied, replace(comma), *chunks[first + 1 : i - 1]]
            return [*chunks[:first], *moved, *chunks[i + 1 :]]
    return chunks


def _with_places_looked_at(chunks: list[Chunk]) -> list[Chunk]:
    """Return *if you look behind it, you will see a box* as *behind it, you will see a box*."""
    for i, chunk in enumerate(chunks):
        start = i - 1 if type_at(chunks, i - 1) == "SUB" else i
        begins = (
            chunk.type == "NP" and chunk.value.pronoun == "you" and type_at(chunks, start - 1) in JOINT_TYPES | {""}
        )
        if not begins or type_at(chunks, i + 1) not in ("VERB", "TVERB") or chunks[i + 1].value.lemma not in _LOOKING:
            continue
        if start < i and chunks[start].value not in ("if", "when", "once"):
            continue
        end = end_before(chunks, i + 2, JOINT_TYPES)
        seen = end + 1 + (type_at(chunks, end + 1) == "ADVERB")
        sees = [type_at(chunks, seen + k) for k in range(3)] == ["NP", "TVERB", "NP"] and (
            chunks[seen].value.pronoun in ("you", "we", "one")
        )
        if type_at(chunks, end) not in ("COMMA", "AND") or not sees or chunks[seen + 1].value.lemma not in _SEEING:
            continue
        last = end_before(chunks, seen + 3, JOINT_TYPES)
        if type_at(chunks, i + 2) == "PREP" and chunks[i + 2].value.preposition.relation not in _NOT_THERE:
            if {"PREP", "ADV"} & {c.type for c in chunks[seen + 3 : last]}:
                continue
            comma = Chunk("COMMA", chunks[end].start, chunks[end].end, None, chunks[end].span)
            return [*chunks[:start], *chunks[i + 2 : end], comma, *chunks[end + 1 :]]
        if type_at(chunks, i + 2) == "NP" and "PREP" in [c.type for c in chunks[seen + 3 : last]]:
            return [*chunks[:start], *chunks[i:end], cut(chunks[end]), *chunks[end + 1 :]]  # 'if you open the box, …'
    return chunks


def _with_exceptions(chunks: list[Chunk]) -> list[Chunk]:
    """Return *all but one clause* as two: *all spoons are in it except the ladle, which is in the sink*.

    *It is empty except for a spoon* is *it holds a spoon*.
    """
    for i, chunk in enumerate(chunks):
        excepts = chunk.type == "PREP" and chunk.value.preposition.phrase in ("except", "except for", "besides")
        comma = end_before(chunks, i, frozenset({"COMMA"}))
        for place, things in ((i - 3, chunks[i + 1 :]), (comma + 1, chunks[i + 1 : comma])):
            empty = excepts and [type_at(chunks, place + k) for k in range(3)] == ["NP", "BE", "ADJP"]
            if empty and chunks[place + 2].value[-1].word in EMPTY and chunks[place + 1].value.positive:
                be = chunks[place + 1]
                holds = replace(be, type="TVERB", value=replace(be.value, lemma="hold", kind="transitive", form="s"))
                rest = [] if place < i else chunks[place + 3 :]
                return [*chunks[: min(place, i)], chunks[place], holds, *_with_exceptions([*things, *rest])]
        bare = type_at(chunks, i + 1) == "NP" and type_at(chunks, i + 2) in JOINT_TYPES | {""}
        bare = bare and (excepts or chunk.type == "BUT")  # 'nothing is on it but the clock'
        first = max((k + 1 for k in range(i) if chunks[k].type in JOINT_TYPES), default=0)
        nothing = type_at(chunks, first) == "NP" and chunks[first].value.pronoun == "nothing"
        if bare and nothing and type_at(chunks, first + 1) in FINITE and chunks[first + 1].value.modal is None:
            denial = [c for c in chunks[first + 1 : i] if c.type != "ADVERB"]  # 'nothing is on it except the clock'
            thing, rest = chunks[i + 1], chunks[i + 2 :]
            if [type_at(rest, k) for k in (0, 1)] == ["COMMA", "REL"]:
                rest = [cut(rest[0]), replace(thing), *rest[2:]]  # '…, which must be 1 m from the wall'
            return [*chunks[:i], cut(chunk), thing, *denial, *_with_exceptions(rest)]
        if excepts and type_at(chunks, i + 1) == "NP" and type_at(chunks, i + 2) in ("BE", "PART", "TPART", "ADJP"):
            end = end_before(chunks, i + 2, JOINT_TYPES)  # 'all bottles except the one being poured'
            return [*chunks[:i], *_with_exceptions(chunks[end:])]
        if excepts and [type_at(chunks, i + k) for k in (1, 2, 3)] == ["NP", "COMMA", "REL"]:
            return [*chunks[:i], cut(chunk), chunks[i + 1], *_with_exceptions(chunks[i + 3 :])]
    return chunks


def _with_members_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Return *three cups, one of which is on the tray* and *…, of whom the child sits …* as two clauses."""
    found: list[Chunk] = []
    at = 0
    while at < len(chunks):
        types = [type_at(chunks, at + k) for k in range(4)]
        after = chunks[at + 1 : at + 4]
        among = types[:3] == ["COMMA", "PREP", "NP"] and after[0].value.preposition.relation == "among"
        if among and after[1].value.pronoun == "which":
            found.append(cut(chunks[at]))
            at += 3
        elif types == ["COMMA", "NP", "OF", "NP"] and not after[0].value.head and after[2].value.pronoun == "which":
            they = NounPhrase(after[2].span, pronoun="they", plural=True)
            found += [cut(chunks[at]), *after[:2], replace(after[2], value=they)]
            at += 4
        else:
            found.append(chunks[at])
            at += 1
    return found


REWRITES = (
    _with_denied_predicates, _without_ends_of_the_past, _without_one_of_each_side, _with_own_parts_after,
    _with_there_as_being, _with_repeated_predicates, _with_ordinals_apart, _without_clefts,
    _without_clefts_of_places,
    _with_places_looked_at, _with_exceptions, _without_verbs_of_comparison, _with_shared_references,
    _without_order_in_lists, _without_colons_before_verbs, _without_kinds_of_members, _with_rows_after_places,
    _with_denied_participles_apart,
    _with_members_apart, _with_contrasts_at_subjects, _with_listed_places_apart,
)  # fmt: skip
"""Rewritings that fill in what clauses share, in their order."""
