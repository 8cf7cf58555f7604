"""Cut the chunks of a sentence into clauses, and say what each remaining comma or conjunction joins."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses.places import arrangement_of, is_place
from deixis.grammar.english.clauses.rewriting.editing import type_at
from deixis.grammar.english.tree import Adjective, Degree
from deixis.grammar.english.vocabulary.function_words import PERSONS
from deixis.grammar.english.vocabulary.nouns import SURFACES, last_word

_WITH_LISTS = frozenset({"between", "among", "next_to", "near", "with", "from", "opposite"})
"""Relations whose object is often a list."""
_OF_ITEMS = frozenset(
    {"on", "inside", "under", "above", "below", "behind", "in_front", "left", "right", "against", "over", "touching"}
)
"""Relations of a thing in a list to another one, after which the list can go on."""
_BEFORE_OBJECTS = frozenset({"BE", "TVERB"})
_SUBORDINATE = frozenset(
    {"if", "when", "while", "as", "once", "before", "after", "unless", "whether", "whenever", "instead", "in case"}
)
PREDICATES = frozenset({"PREP", "ADV", "PART", "TPART", "ADJP", "WITH", "MEASURE"})
IMPERATIVES = frozenset({"PUT", "FIND", "DO"})


@dataclass(frozen=True, slots=True)
class Segment:
    """Chunks of one clause, and the joint before it: empty for the first, ``,``, ``and``, ``or``, ``if`` and others."""

    chunks: tuple[Chunk, ...]
    link: str
    is_coordinated: bool = False  # True after *and if*: the condition is not one of the clause before


def segments(chunks: list[Chunk]) -> list[Segment]:
    """Return the clauses of a sentence.

    Parameters
    ----------
    chunks
        Chunks of the sentence.

    Returns
    -------
    list of Segment
        Clauses in the order of the text, without the joints between them.
    """
    types = [chunk.type for chunk in chunks]
    found: list[Segment] = []
    start, link, coordinated = 0, "", False
    i = 0
    while i < len(chunks):
        if types[i] in JOINT_TYPES:
            end, kinds = _run(types, i)
            verb = _repeated_verb(types, start, i, end)
            if verb is not None:  # 'the left one holds pens, the right one pencils'
                again = replace(chunks[verb], span=(chunks[end + 1].span[0], chunks[end + 1].span[0]))
                chunks = [*chunks[: end + 1], again, *chunks[end + 1 :]]
                types.insert(end + 1, "TVERB")
            labelled = link == ":" and bool(found) and [chunk.type for chunk in found[-1].chunks] == ["NP"]
            cut = _cuts(chunks, types, start, i, end, kinds, link, labelled)
            if cut:
                if i > start:
                    found.append(Segment(tuple(chunks[start:i]), link, coordinated))
                    link = ""
                coordinated = "SUB" in kinds and not kinds.isdisjoint({"AND", "CUT"})
                words = {"COMMA": ",", "AND": "and", "OR": "or", "BUT": "but", "THEN": "then", "CUT": ";", "COLON": ":"}
                names = [words.get(types[k]) or str(chunks[k].value) for k in range(i, end)]
                link = next((n for n in reversed(names) if n not in (",", ";")), link or names[-1])
                start = end
            i = end
            continue
        if types[i] == "WITH" and i > start and _clause_of_with(types, i) and _finite_between(types, start, i):
            found.append(Segment(tuple(chunks[start:i]), link))
            start, link = i + 1, "with"
        elif i > start and _runs_on(chunks, types, start, i):
            found.append(Segment(tuple(chunks[start:i]), link))
            start, link = i, ""
        i += 1
    if len(chunks) > start:
        found.append(Segment(tuple(chunks[start:]), link, coordinated))
    return found


def _repeated_verb(types: list[str], start: int, at: int, end: int) -> int | None:
    """Return the place of the transitive verb that is left out between two noun phrases after a joint."""
    if types[end : end + 2] != ["NP", "NP"] or types[start] != "NP":
        return None
    if end + 2 < len(types) and types[end + 2] not in JOINT_TYPES | {"OF"}:
        return None
    verbs = [i for i in range(start, at) if types[i] in FINITE]
    return verbs[0] if len(verbs) == 1 and types[verbs[0]] == "TVERB" else None


def _run(types: list[str], at: int) -> tuple[int, set[str]]:
    """Return the end of a run of joints (*, and*) and their types."""
    end = at
    while end < len(types) and types[end] in JOINT_TYPES:
        end += 1
    return end, set(types[at:end])


def _finite_between(types: list[str], start: int, end: int) -> bool:
    """Return True if a main verb stands between two places: a verb that is not that of a relative clause."""
    relative = 0
    for i in range(start, end):
        if types[i] in ("REL", "WHOSE"):
            relative += 1
        elif types[i] in FINITE:
            if relative == 0:
                return True
            relative -= 1
        elif types[i] in ("PUT", "FIND", "DO", "THERE"):
            return True
    return False


def _cuts(
    chunks: list[Chunk], types: list[str], start: int, at: int, end: int, kinds: set[str], link: str, labelled: bool
) -> bool:
    """Return True if a clause begins after the joints from ``at`` to ``end``.

    ``labelled`` is True for places after the thing that they are said about, and a colon: *slippers: on the mat, …*.
    """
    if end >= len(types) or kinds & {"CUT", "SUB", "COLON"}:
        return True
    listed = "AND" in kinds and types[end] == "NP" and not _finite_between(types, end, len(types))
    if "THEN" in kinds and not (listed and (types[start:at] == ["PUT", "NP"] or types[end + 1 : end + 2] == [])):
        return True
    if at == start:
        return True
    following = types[end]
    complete = _finite_between(types, start, at) or (labelled and types[start] in PREDICATES)
    complete = complete or (link in (",", "and") and _absolute_before(types, start, at))
    if link in _SUBORDINATE and "COMMA" in kinds and following not in ("REL", "WHOSE", "TPART", "PART"):
        return True
    if following == "BE" and types[end + 1 : end + 2] == ["NP"] and not complete:
        return True
    if following in IMPERATIVES or following == "WHERE":
        return True
    if following == "THERE" or following == "COMPLEMENT":
        return complete or "AND" in kinds
    if following == "NP":
        return _subject_follows(chunks, types, start, at, end, kinds, complete)
    if following == "ADV" and types[end + 1 : end + 2] == ["THERE"] and "AND" in kinds:
        return True  # 'on the left a cup, on the right a jug, and in between there is a pot'
    if following == "MEASURE" and complete and "AND" in kinds:
        return _inversion_follows(types, end)  # 'and 10 cm behind it a bottle'
    if following == "PREP" and {"COMMA", "AND"} <= kinds and _turned_clause_follows(chunks, types, end):
        return True
    if following == "PREP" and "AND" in kinds and _fronted_command(types, end):
        return True  # 'lay a fork on the left, and to the right of it put a knife'
    if following == "PREP" and "AND" in kinds and _verbless_inversion(types, end):
        return True  # 'the brush, and behind it the cup'
    if labelled and kinds == {"COMMA"} and following in PREDICATES:
        return False  # 'toolbox: open, under the bench, hammer on top'
    if (following in ("PREP", "ADV") and complete) or (
        following == "PREP" and types[start] == "PREP" and "AND" in kinds
    ):
        return _inversion_follows(types, end)
    if following in ("TPART", "PART") and complete and "COMMA" in kinds:
        return _inversion_follows(types, end)
    return False


def _absolute_before(types: list[str], start: int, at: int) -> bool:
    """Return True for a thing with its place and no verb, as in a list of such: *A sits at X, B at Y, C at Z*."""
    return types[start] == "NP" and types[start + 1] in PREDICATES - {"WITH", "ADJP"} and at > start + 1


def _fronted_command(types: list[str], at: int) -> bool:
    """Return True for places and then a command: *in the corner next to it put …*."""
    while types[at : at + 2] in (["PREP", "NP"], ["OF", "NP"]):
        at += 2
    return types[at : at + 2] == ["PUT", "NP"]


def _verbless_inversion(types: list[str], at: int) -> bool:
    """Return True for a place and its thing without a verb: *behind it the cup*, *behind it, half hidden, a cup*."""
    objects = 0
    while types[at : at + 2] == ["PREP", "NP"] and objects == 0:
        at, objects = _after_of(types, at + 2), 1
    if types[at : at + 3] in (["COMMA", "PART", "COMMA"], ["COMMA", "ADJP", "COMMA"]):
        at += 3
    if not objects or types[at : at + 1] != ["NP"]:
        return False
    at = _after_of(types, at + 1)
    return at >= len(types) or types[at] in JOINT_TYPES


def _subject_follows(
    chunks: list[Chunk], types: list[str], start: int, at: int, end: int, kinds: set[str], complete: bool
) -> bool:
    i, seen_noun, mods = end, False, 0
    last = types[at - 2 : at] == ["PREP", "NP"] and not chunks[at - 1].value.plural
    if kinds == {"AND"} and last and chunks[at - 2].value.preposition.relation == "between":
        return False  # 'between me and the guest, and the tea is …'
    while i < len(types):
        kind = types[i]
        if kind in FINITE:
            if i == end + 1 and chunks[end].value.pronoun in ("it", "they", "he", "she") and "COMMA" in kinds:
                return complete or at > start + 1
            note = {"COMMA", "AND"} <= kinds and _note_before(types, start, at) and i == end + 1
            return complete or note or _verbless_before(types, start, at)
        if kind in ("REL", "WHOSE"):
            return complete and _main_verb_after_relative(types, i) and "OR" not in kinds
        if kind == "COMMA" and _verb_after_aside(types, i):
            return complete or _verbless_before(types, start, at)
        if kind in JOINT_TYPES:
            if not complete or not _list_then_verb(chunks, types, i):
                break
            return True
        seen_noun = seen_noun or kind == "NP"
        mods += kind in PREDICATES
        i += 1
    if kinds & {"AND", "OR"} and _lists_objects(types, start, at):
        return False
    after = _after_of(types, end + 1)
    if {"COMMA", "AND"} <= kinds and types[after : after + 2] == ["AND", "NP"]:
        after += 2  # 'the forks go on the left, and knives and spoons on the right'
    following = types[after] if after < len(types) else ""
    puts = types[start] == "PUT" or (
        types[start : start + 3] == ["NP", "TVERB", "NP"]
        and chunks[start].value.pronoun in PERSONS
        and "PREP" in types[start:at]
    )  # 'I put A on B and C on D'
    accompanied = any(  # 'the telephone is on the desk, with a pad next to it and …'
        types[k - 1 : k + 3] == ["COMMA", "WITH", "NP", "PREP"] for k in range(start + 1, at)
    )
    if {"COMMA", "AND"} == kinds and following == "PREP" and _objects_alone(chunks, types, start, at):
        return False  # 'put a mug, and a glass on the shelf'
    if kinds == {"AND"} and _list_of_with(types, start, at):
        return False
    told_apart = any(kind == "NP" and chunks[k].value.pronoun == "one" for k, kind in enumerate(types[start:at], start))
    if (
        told_apart
        and chunks[end].value.pronoun == "other"
        and types[end + 1 : end + 2] in (["PREP"], ["ADV"], ["PART"])
    ):
        return True  # 'one left of the cross, the other right of it'
    if _has_beside_it(chunks, types, start, at, end):
        return False
    if complete and kinds in ({"COMMA"}, {"AND"}) and types[end : end + 4] == ["NP", "AND", "NP", "PREP"]:
        opposite = _is_opposite(chunks, start, at, end + 3)
        if opposite or kinds == {"COMMA"}:
            return opposite
    if (
        complete
        and kinds == {"COMMA"}
        and following == "PREP"
        and is_within_list(chunks, at, start + 1, _BEFORE_OBJECTS)
    ):
        return False  # 'the shelf holds a mug, a bar on a dish and a comb'
    shared = chunks[end].value.pronoun in ("each", "both", "all") and not chunks[end].value.head
    if complete and kinds == {"COMMA"} and (following in (PREDICATES - {"WITH"}) or (shared and following == "WITH")):
        phrase = chunks[end].value
        if phrase.negated and following == "PREP" and _same_place_again(chunks, types, start, at, after):
            return True  # 'the stamp is on the letter, not the letter on the stamp'
        if (
            phrase.pronoun == "one" and phrase.determiner in ("the", "this") and not phrase.adjectives
        ) or phrase.negated:
            return False
        # an absolute construction: 'its handle pointing to the right', 'the butter next to it'
        return not (types[at - 1] == "NP" and _in_list(chunks, types, start, at, i))
    if (
        kinds == {"AND"}
        and complete
        and (following == "PREP" or (following in ("PART", "ADV") and (puts or accompanied)))
        and types[at - 1] in ("NP", "ADV")
        and (
            is_place(chunks[at - 1].value) or (puts and "PREP" in types[start:at])
            if types[at - 1] == "NP" and not accompanied
            else types[at - 1] == "NP" or puts
        )
    ):
        return not _in_list(chunks, types, start, at, i)
    if kinds == {"AND"} and complete and following == "PREP" and _same_place_again(chunks, types, start, at, after):
        return True
    if "COMMA" in kinds and complete and "AND" in kinds and following in (PREDICATES - {"WITH"}):
        return not _in_list(chunks, types, start, at, i)
    return kinds == {"AND"} and complete and _verb_left_out(chunks, types, start, at, end)


def _lists_objects(types: list[str], start: int, at: int) -> bool:
    """Return True for two or more objects of a command without a place: *put milk, eggs*, before *and butter on it*."""
    verb = next((i for i in range(start, at) if types[i] in ("PUT", "TVERB")), at)
    objects = types[verb + 1 : at]
    return objects.count("COMMA") > 0 and objects[:1] == ["NP"] and set(objects) <= {"NP", "OF", "COMMA", "AND", "OR"}


def is_within_list(chunks: list[Chunk], at: int, start: int = 0, after: frozenset[str] | None = None) -> bool:
    """Return True for a joint in a list of things of which some have places: *a mug, a bar on a dish and a comb*.

    Parameters
    ----------
    chunks
        Chunks of the sentence.
    at
        Index of the joint.
    start
        Index of the first chunk at which the list can begin.
    after
        Types of the chunks after which the list can begin; by default, any but those before the object of a phrase.

    Returns
    -------
    bool
        False where there is no such list, or where each thing has its own place.
    """
    types = [chunk.type for chunk in chunks]
    for first in range(start, at):
        before = types[first - 1] if first else ""
        begins = before not in ("PREP", "OF", "WITH") if after is None else before in after
        if types[first] == "NP" and begins and _end_of_list(chunks, types, first) > at:
            return True  # not 'between the box and the jug with a coat on it'
    return False


def _end_of_list(chunks: list[Chunk], types: list[str], at: int) -> int:
    """Return the end of a list of things that begins here; ``at`` where there is none."""
    i, bare, placed, holding, commas, conjoined = at, 0, 0, 0, 0, False
    while types[i : i + 1] == ["NP"] and not (chunks[i].value.pronoun or is_place(chunks[i].value)):
        if i > at and chunks[i].value.determiner is None and chunks[i].value.count is None:
            return at  # 'the door to the bath, basin and bin'
        i = _after_of(types, i + 1)
        is_placed = types[i : i + 2] == ["PREP", "NP"] and chunks[i].value.preposition.relation in _OF_ITEMS
        if types[i : i + 2] == ["WITH", "NP"]:
            owned = types[i + 2 : i + 4] == ["PREP", "NP"] and chunks[i + 3].value.pronoun == "it"
            i += 4 if owned else 2  # 'a plate with a napkin on it'
            holding += 2 if owned else 1
        elif is_placed and not is_place(chunks[i + 1].value):
            i, placed = _after_of(types, i + 2), placed + 1
        else:
            bare += 1
        if conjoined:  # neither 'a cup on the tray and a jug' nor 'a door with hinges and a handle'
            several = bare > 1 or commas > 1 or holding + commas > 1
            return i if placed + holding and bare and several and types[i : i + 1] in ([], ["CUT"]) else at
        joints = types[i : i + 2]
        if joints[:1] not in (["COMMA"], ["AND"]):
            return at
        conjoined, commas = "AND" in joints, commas + (joints[0] == "COMMA")
        i += 1 + (joints == ["COMMA", "AND"])
    return at


def _after_of(types: list[str], at: int) -> int:
    """Return the index after *of* phrases that begin at an index."""
    while types[at : at + 2] == ["OF", "NP"]:
        at += 2
    return at


def _objects_alone(chunks: list[Chunk], types: list[str], start: int, at: int) -> bool:
    """Return True for a command that has its objects and no place yet: *store four mugs*, not *set the table*."""
    objects = [chunk for chunk in chunks[start + 1 : at] if chunk.type == "NP"]
    alone = types[start] == "PUT" and bool(objects) and set(types[start + 1 : at]) <= {"NP", "OF", "COMMA"}
    return alone and not any(last_word(chunk.value.head) in SURFACES for chunk in objects)


def _is_opposite(chunks: list[Chunk], start: int, at: int, place: int) -> bool:
    """Return True for a place on the other side: *A go to the left of B, C and D to the right of E*."""
    sides = [last_word(c.value.head) for c in chunks[start:at] if c.type == "NP" and is_place(c.value)]
    after = chunks[place + 1].value.head if type_at(chunks, place + 1) == "NP" else ""
    return {"left": "right", "right": "left"}.get(last_word(after)) in sides


def _list_of_with(types: list[str], start: int, at: int) -> bool:
    """Return True for things with their places after *with*: 'with salt at its left and pepper at its right'."""
    withs = [i for i in range(start, at) if types[i] == "WITH"]
    return bool(withs) and not any(kind in FINITE for kind in types[withs[-1] : at])


def _has_beside_it(chunks: list[Chunk], types: list[str], start: int, at: int, end: int) -> bool:
    """Return True for things with places beside their owner: *it has a fork to its left and a knife to its right*."""
    verbs = [i for i in range(start, at) if types[i] in FINITE]
    has = bool(verbs) and types[verbs[-1]] == "TVERB" and chunks[verbs[-1]].value.lemma == "have"
    placed = types[at - 2 : at] == types[end + 1 : end + 3] == ["PREP", "NP"]
    phrases = (chunks[at - 1].value, chunks[end + 2].value) if has and placed else ()
    owners = [phrase.owner or phrase for phrase in phrases]
    return bool(owners) and all(owner.pronoun in ("it", "they") and not owner.head for owner in owners)


def _verb_left_out(chunks: list[Chunk], types: list[str], start: int, at: int, end: int) -> bool:
    """Return True if the verb is left out: *nappies are kept in the drawer and wipes on the shelf*."""
    subject = chunks[start].value if types[start] == "NP" else None
    if subject is None or not (subject.head or subject.pronoun == "one") or types[at - 1] != "NP":
        return False
    if not (chunks[end].value.head or (chunks[end].value.pronoun == "one" and chunks[end].value.adjectives)):
        return False
    while types[end + 1 : end + 3] in (["AND", "NP"], ["OF", "NP"]):
        end += 2
    if types[end + 1 : end + 2] not in (["PREP"], ["ADV"]) or is_place(chunks[end].value):
        return False
    relative = next((i for i in range(start, at) if types[i] == "REL"), at)  # 'in the tray that is farthest from you'
    verbs = [i for i in range(start, relative) if types[i] in FINITE]
    places = [i for i in range(start, relative) if types[i] == "PREP" and i > verbs[0]] if len(verbs) == 1 else []
    if len(places) != 1:
        return False
    preposition = chunks[places[0]].value.preposition
    if preposition.relation in _WITH_LISTS and preposition.degree is Degree.PLAIN:
        return False
    after = end + 2 if types[end + 1] == "ADV" else end + 3
    while after < len(types) and types[after] in ("OF", "NP", "PREP", "ADV"):
        after += 1
    return after >= len(types) or types[after] in JOINT_TYPES


def _same_place_again(chunks: list[Chunk], types: list[str], start: int, at: int, preposition: int) -> bool:
    """Return True if the verb is left out before the same preposition: 'the pan is on it and the jug on them'."""
    places = [i for i in range(start, at) if types[i] == "PREP" and types[i - 1] in FINITE | {"PART"}]
    return len(places) == 1 and (
        chunks[places[0]].value.preposition.relation == chunks[preposition].value.preposition.relation
    )


def _verb_after_aside(types: list[str], at: int) -> bool:
    """Return True if a verb follows after a phrase between commas: 'the cups, nested in one another, stood …'."""
    if at + 1 >= len(types) or types[at + 1] not in PREDICATES | {"REL", "NP"} or "COMMA" not in types[at + 1 :]:
        return False
    if types[at + 1] == "NP" and types[at + 2 : at + 3] != ["COMMA"]:
        return False  # no apposition: 'the lamp, a green one, stood …'
    end = types.index("COMMA", at + 1) + 1
    return end < len(types) and types[end] in FINITE


def _verbless_before(types: list[str], start: int, at: int) -> bool:
    """Return True if the chunks before the joint make a clause without a verb: 'on the left a lamp'."""
    if types[start] in ("PREP", "TPART", "PART"):
        return any(types[i] == "NP" and types[i + 1] == "NP" for i in range(start, at - 1)) or "FJ" in types[start:at]
    return False


def _note_before(types: list[str], start: int, at: int) -> bool:
    """Return True if a thing and its place stand before the joint, as in a note: 'sign leaning on the oil, and …'."""
    return types[start] == "NP" and types[start + 1 : start + 2] in (["PREP"], ["ADV"], ["PART"]) and at > start + 1


def _main_verb_after_relative(types: list[str], at: int) -> bool:
    pending = 0
    for kind in types[at:]:
        if kind in ("REL", "WHOSE"):
            pending += 1
        elif kind in FINITE:
            if pending == 0:
                return True
            pending -= 1
        elif kind in ("CUT", "COLON", "SUB"):
            return False
    return False


def _list_then_verb(chunks: list[Chunk], types: list[str], at: int) -> bool:
    """Return True if a list of noun phrases goes on after the joint and ends with a verb: 'A, B and C are …'."""
    i = at
    while i < len(types):
        if types[i] in FINITE:
            return True
        if types[i] in JOINT_TYPES:
            end, kinds = _run(types, i)
            if kinds & {"CUT", "COLON", "SUB"} or not kinds & {"AND", "OR"}:
                return False
            if (
                end >= len(types)
                or types[end] != "NP"
                or (chunks[end].value.pronoun in ("it", "they") and types[end + 1 : end + 2] in (["BE"], ["VERB"]))
            ):  # 'only a stool, and it is tucked underneath'
                return False
            i = end
            continue
        if types[i] in ("REL", "PUT", "FIND", "THERE", "WHOSE", "COMPLEMENT"):
            return False
        i += 1
    return False


def _in_list(chunks: list[Chunk], types: list[str], start: int, at: int, end: int) -> bool:
    """Return True if the joint is in the list of a preposition that takes one: between A, B and C."""
    for i in range(at - 1, start - 1, -1):
        if types[i] == "PREP":
            both = type_at(chunks, i + 1) == "NP" and chunks[i + 1].value.pronoun == "they"
            return chunks[i].value.preposition.relation in ("between", "among") and not both
        if types[i] in FINITE:
            return False
    return False


def _inversion_follows(types: list[str], at: int) -> bool:
    """Return True for a place with a subject after it: 'next to it a cactus', 'on top of it there is a basket'."""
    i = at
    while i < len(types):
        kind = types[i]
        if kind in ("THERE", "VERB", "BE"):
            return i > at
        if kind == "NP":
            following = types[i + 1] if i + 1 < len(types) else ""
            if following in ("NP", "THERE"):
                return True
            if following == "COMMA" and i + 2 < len(types) and types[i + 2] == "NP":
                return not _has_own_place(types, i + 2)
        if kind == "ADV" and i + 1 < len(types) and types[i + 1] in ("NP", "THERE"):
            return True
        if kind in JOINT_TYPES and not (kind in ("AND", "COMMA") and i > at and types[i + 1 : i + 2] == ["NP"]):
            return False
        if kind in ("REL", "TVERB", "PUT", "FIND", "WHOSE"):
            return False
        i += 1
    return False


def _has_own_place(types: list[str], at: int) -> bool:
    """Return True for a thing with its place and no verb to the end: *at the end of it, the safe underneath it*."""
    rest = types[at : next((k for k in range(at, len(types)) if types[k] in ("CUT", "COLON")), len(types))]
    return rest[:3] == ["NP", "PREP", "NP"] and not (FINITE | {"REL", "COMMA", "AND"}) & set(rest)


_OF_PLACES = frozenset(
    {
        ("PREP", "NP"), ("OF", "NP"), ("COMMA", "PREP"), ("COMMA", "MEASURE"), ("MEASURE", "PREP"), ("COMMA", "PART"),
        ("PART", "PREP"),
    }
)  # fmt: skip
"""Pairs of chunks in places that follow one another."""


def _turned_clause_follows(chunks: list[Chunk], types: list[str], at: int) -> bool:
    """Return True for places and then a clause: 'to the right of the plate lay a knife', 'behind it we found a cup'."""
    i = at
    while tuple(types[i : i + 2]) in _OF_PLACES:
        i += 2 if types[i] in ("PREP", "OF") else 1
        amid = types[i - 2] == "PREP" and chunks[i - 2].value.preposition.relation == "between"
        i += 2 * (amid and types[i : i + 2] == ["AND", "NP"])  # 'and between them and the brie goes a pot'
    if i == at:
        return False
    i += types[i : i + 1] == ["COMMA"]
    if types[i : i + 1] in (["VERB"], ["BE"]):
        return "NP" in types[i : i + 3]
    if types[i : i + 2] == ["PUT", "NP"]:
        return True  # 'and between that and the jug I like to put the tongs'
    if types[i : i + 1] == ["NP"] and types[i + 1 : i + 2] in (["VERB"], ["BE"]) and types[i - 1] == "NP":
        return True  # 'and behind the tent a sledge has been drawn up'
    person = types[i : i + 2] == ["NP", "TVERB"] and chunks[i].value.pronoun in ("me", "you", "we", "they", "someone")
    return person and types[i + 2 : i + 3] == ["NP"]


def _clause_of_with(types: list[str], at: int) -> bool:
    """Return True for a clause after *with*: 'with the cup is on the left'."""
    for kind in types[at + 1 :]:
        if kind in FINITE:
            return True
        if kind != "NP":
            return False
    return False


def _runs_on(chunks: list[Chunk], types: list[str], start: int, at: int) -> bool:
    """Return True if a clause begins without a joint: 'the chair is brown it is near the desk'."""
    if at + 1 >= len(types) or types[at - 1] in (
        "PREP",
        "OF",
        "REL",
        "SUB",
        "COMPLEMENT",
        "WHOSE",
        "THAN",
        "WITH",
        "TPART",
    ):
        return False
    if types[at - 1] in JOINT_TYPES:
        return False
    if types[at] == "THERE":
        return types[at - 1] not in FINITE and _finite_between(types, start, at)
    if types[at] == "NP" and types[at + 1] in FINITE and types[at - 1] not in FINITE:
        phrase = chunks[at].value
        if phrase.pronoun in ("it", "they", "this", "these", "you", "me", "we"):
            return _finite_between(types, start, at) or phrase.pronoun == "it" or types[start] == "FIND"
        return (
            _finite_between(types, start, at)
            and types[at - 1] in ("NP", "ADJP", "ADV")
            and (phrase.determiner in ("the", "this") and not _open_relative(types, start, at))
        )
    return types[at] in IMPERATIVES and types[at - 1] in ("NP", "ADV", "ADJP", "NOT", "PART", "UNKNOWN")


def _open_relative(types: list[str], start: int, at: int) -> bool:
    return any(kind in ("REL", "WHOSE") for kind in types[start:at])


def classify(segment: Segment) -> list[Chunk]:
    """Return the chunks of a clause with a type for each joint, and without empty words.

    Parameters
    ----------
    segment
        Clause with plain commas and conjunctions.

    Returns
    -------
    list of Chunk
        Terminals for the parser. The joints join noun phrases (NJ), noun phrases with their modifiers (OJ), predicates
        (PJ) or verb groups (VJ), or end what stands before the subject (FJ).
    """
    source = [chunk for chunk in segment.chunks if chunk.type not in ("ADVERB", "COMPLEMENT")]
    types = [chunk.type for chunk in source]
    found: list[Chunk] = []
    i, fronted = 0, False
    while i < len(source):
        chunk = source[i]
        if chunk.type == "OF" and (i + 1 >= len(source) or source[i + 1].type in JOINT_TYPES):
            i += 1
            continue
        if chunk.type == "NOT":
            following = source[i + 1] if i + 1 < len(source) else None
            if following is not None and following.type == "NP" and found and found[-1].type in ("NP", "ADV"):
                denied = replace(following.value, negated=True)
                source[i + 1] = Chunk("NP", following.start, following.end, denied, following.span)
                kind = _kind(source, types, found, {"COMMA"}, i + 1, "NP", fronted)
                found.append(Chunk(kind or "NJ", chunk.start, chunk.end, ",", chunk.span))
                i += 1
                continue
            if following is not None and following.type == "NP":
                source[i + 1] = Chunk(
                    "NP", following.start, following.end, replace(following.value, negated=True), following.span
                )
            elif following is not None and following.type == "ADJP":
                words = tuple(replace(a, positive=not a.positive) for a in following.value)
                source[i + 1] = Chunk("ADJP", following.start, following.end, words, following.span)
            elif following is not None and isinstance(following.value, (Relator, VerbGroup)):
                denied = replace(following.value, positive=not following.value.positive)
                source[i + 1] = Chunk(following.type, following.start, following.end, denied, following.span)
            i += 1
            continue
        if chunk.type not in JOINT_TYPES:
            if chunk.type == "NP" and found and _lists_without_joint(source, found, i):
                found.append(Chunk("OJ", chunk.start, chunk.start, ",", chunk.span))
            found.append(chunk)
            i += 1
            continue
        end = i
        while end < len(source) and source[end].type in JOINT_TYPES:
            end += 1
        if end < len(source) and found:
            kinds = set(types[i:end])
            after = types[end]
            if any(source[k].value == "nor" for k in range(i, end)) and after in PREDICATES:
                kinds = {"AND"}
                denied = [c for c in found if isinstance(c.value, Relator) and not c.value.positive]
                denied += [c for c in found if c.type == "ADJP" and any(not a.positive for a in c.value)]
                if denied and types[end] == "ADJP":
                    words = tuple(replace(a, positive=False) for a in source[end].value)
                    source[end] = replace(source[end], value=words)
                if denied and isinstance(source[end].value, Relator):
                    now = replace(source[end].value, positive=False)
                    source[end] = Chunk(source[end].type, source[end].start, source[end].end, now, source[end].span)
            if after == "NOT" and end + 1 < len(source):
                after = types[end + 1]
                if after == "NP":
                    following = source[end + 1]
                    source[end] = source[end + 1] = Chunk(
                        "NP", following.start, following.end, replace(following.value, negated=True), following.span
                    )
                    types[end] = "NP"
                    del source[end], types[end]
            if (
                after == "NP"
                and found[-1].type == "ADJP"
                and "COMPLEMENT" not in kinds
                and (bare := _unknown_adjective(source[end]))
            ):
                source[end] = bare
                types[end] = after = "ADJP"
            kind = _kind(source, types, found, kinds, end, after, fronted)
            both = [c.type for c in found[-2:]] == ["PREP", "NP"] and found[-1].value.pronoun == "they"
            if kind == "NJ" and both and found[-2].value.preposition.relation == "between" and after == "NP":
                kind = "OJ"  # 'a candle between them, and a bottle …'
            if kind == "NJ" and _lists_places(source, found, kinds, end, segment.link):
                kind = "OJ"
            if kind == "NJ" and found[0].type != "PUT" and is_within_list(source, i):
                kind = "LJ"
            if (
                kind == "NJ"
                and segment.link == ":"
                and "COMMA" in kinds
                and "PREP" in types
                and (not any(c.type == "PREP" and c.value.preposition.relation in ("between", "among") for c in found))
            ):
                kind = "OJ"  # a list after a colon
            placed = [chunk.type for chunk in found[-2:]] == ["TVERB", "NP"] and after == "WITH" and kinds == {"COMMA"}
            if kind == "PJ" and (found[-1].type in FINITE or placed):
                kind = None
            if kind is not None:
                fronted = fronted or kind == "FJ"
                value = "or" if "OR" in kinds else "but" if "BUT" in kinds else "and" if "AND" in kinds else ","
                found.append(Chunk(kind, chunk.start, source[end - 1].end, value, chunk.span))
        i = end
    return found


def _lists_places(source: list[Chunk], found: list[Chunk], kinds: set[str], at: int, link: str) -> bool:
    """Return True for things with a place each: *garlic in the first bowl, onion in the second, and celery …*."""
    types = [chunk.type for chunk in found]
    if "FJ" in types:  # 'in front of it the board, knives on the right, …'
        found = found[types.index("FJ") + 1 :]
        types = types[types.index("FJ") + 1 :]
    if not types:
        return False
    if (
        {"PREP", "ADV"}.isdisjoint(types)
        or types[0] != "NP"
        or any(kind in FINITE or kind in ("REL", "WITH") for kind in types)
    ):
        return False
    after = _after_of([chunk.type for chunk in source], at + 1)
    tucked = [c.type for c in source[after : after + 2]] == ["PART", "PREP"] and source[after].value.kind == "posture"
    if not tucked and [chunk.type for chunk in source[after : after + 1]] not in (["PREP"], ["ADV"]):
        return False
    first, second = found[0].value, source[at].value
    last = max(i for i, kind in enumerate(types) if kind in ("PREP", "ADV"))
    other = second.pronoun == "one" or second.count is not None  # 'two chairs by the window, one at the desk'
    ends_list = found[last].value.preposition.relation not in _WITH_LISTS or tucked
    if not first.head or not (second.head or other) or not ends_list:
        return False
    listing = "COMMA" in kinds or "OJ" in types or link in (",", ":", ";")
    return listing or (first.determiner is None and second.determiner is None)


def _lists_without_joint(source: list[Chunk], found: list[Chunk], at: int) -> bool:
    """Return True for the second of two places without a joint: 'with B at the bottom A on the top'."""
    return (
        found[-1].type == "NP"
        and is_place(found[-1].value)
        and any(chunk.type == "WITH" for chunk in found)
        and at + 1 < len(source)
        and source[at + 1].type == "PREP"
    )


def _unknown_adjective(chunk: Chunk) -> Chunk | None:
    """Return a bare unknown word after an adjective as an adjective: *white and wavy*."""
    phrase = chunk.value
    if (
        phrase.determiner
        or phrase.plural
        or phrase.pronoun
        or phrase.owner
        or phrase.adjectives
        or not phrase.head
        or (phrase.count is not None or " " in phrase.head)
    ):
        return None
    return Chunk(
        "ADJP", chunk.start, chunk.end, (Adjective(phrase.head, "other", Degree.PLAIN, chunk.span),), chunk.span
    )


def _kind(
    source: list[Chunk], types: list[str], found: list[Chunk], kinds: set[str], end: int, after: str, fronted: bool
) -> str | None:
    """Return the type of a joint; None for one that can be left out."""
    before = [chunk.type for chunk in found]
    if after in FINITE:
        return "VJ" if _finite_between(before, 0, len(before)) else None
    if after in ("REL", "WHOSE", "THAN", "OF"):
        return None
    place_first = before[0] in ("PREP", "ADV", "TPART", "PART", "WITH") and not _finite_between(before, 0, len(before))
    if after == "NP":
        if place_first and not fronted and "COMMA" in kinds and not _list_goes_on(types, found, end):
            return "FJ"
        if source[end].value.negated:
            nominal = any(a == "BE" and b == "NP" for a, b in pairwise(before))
            return "OJ" if nominal or not any(k in FINITE or k == "PUT" for k in before) else "NJ"
        placed = _after_of(types, end + 1)
        owner = source[end].value.owner
        own = owner is not None and owner.pronoun in ("it", "they") and kinds == {"COMMA"}
        if own and not PREDICATES.isdisjoint(types[placed : placed + 1]):
            return "OJ"  # 'a lamp clamped to the edge, its arm bent over the towel'
        introduced = source[end].value.determiner in ("a", "an", "some") or source[end].value.count is not None
        between = any(c.type == "PREP" and c.value.preposition.relation in ("between", "among") for c in found)
        known = found[-1].type == "NP" and found[-1].value.determiner == "the" and bool(found[-1].value.head)
        if (
            "THERE" in before
            and "PREP" in before
            and introduced
            and not between
            and (types[placed : placed + 1] == ["PREP"] or (known and bool(source[end].value.head)))
        ):
            return "OJ"  # 'there is a hole in the middle of the board and a peg in the hole'
        if (
            found[-1].type == "NP"
            and found[-1].value.pronoun in ("it", "they")
            and types[placed : placed + 1] in (["PREP"], ["ADV"])
            and ("TVERB" in before or "WITH" in before or "THERE" in before)
        ):
            return "OJ"
        if (
            found[-1].type == "NP"
            and len(found) > 1
            and found[-2].type == "PREP"
            and is_place(found[-1].value)
            and (not is_place(source[end].value) or _is_group(source, end))
        ):
            return "OJ"
        return "NJ"
    if after == "THERE":
        return None
    if place_first and not fronted and kinds == {"COMMA"} and after in PREDICATES and _subject_later(types, end):
        return "PJ"
    return "PJ"


def _is_group(source: list[Chunk], at: int) -> bool:
    """Return True for *a stack of books* and *a row of cups*, which name things and not their place."""
    named = arrangement_of(source[at].value) is not None and source[at].value.determiner is not None
    return named and [chunk.type for chunk in source[at + 1 : at + 3]] == ["OF", "NP"]


def _subject_later(types: list[str], at: int) -> bool:
    return "NP" in types[at:]


def _list_goes_on(types: list[str], found: list[Chunk], at: int) -> bool:
    """Return True if the comma after a fronted place is in its list: 'between a cup, a jug and a pot stands …'."""
    relators = [chunk.value for chunk in found if isinstance(chunk.value, Relator)]
    if not relators or relators[0].preposition.relation not in ("between", "among"):
        return False
    later = types[at:]
    return "AND" in later and any(kind in FINITE or kind == "COMMA" for kind in later[later.index("AND") :])
