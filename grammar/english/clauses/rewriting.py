"""Rewrite the chunks of a sentence as plain clauses: fill in ellipses, undo inversions and drop asides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses import asides
from deixis.grammar.english.clauses.built import misunderstood
from deixis.grammar.english.clauses.editing import cut, emptied, end_before, put_in, type_at
from deixis.grammar.english.clauses.ellipses import filled_in
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.tree import Degree, NounPhrase, Span
from deixis.grammar.english.vocabulary.function_words import PERSONS, READY, UNITS
from deixis.grammar.english.vocabulary.nouns import (
    AIMED_PARTS,
    HEADED,
    HOLDERS,
    PARTS,
    PEOPLE,
    SURFACES,
    VESSELS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS, Preposition
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import (
    NAMED_LIKE_THINGS,
    PLACING_VERBS,
    PUT_VERBS,
    TRANSITIVE_RELATIONS,
    verb_forms,
)

_SIZES = frozenset({"size", "height", "length", "width", "shape", "colour", "color", "thickness", "weight"})
_STORING = word_set(
    "shelf drawer rack cupboard cabinet basket bin compartment crate locker tier pocket hook peg closet wardrobe"
)
"""Places of which *for* tells what is kept in them: *the top shelf is for glasses*."""
_RESERVING = frozenset({"use", "reserve", "keep", "save", "dedicate"})
"""Commands whose object with *for* tells what is kept in it."""
_RESERVED = frozenset({"dedicated", "dedicate", "reserved", "reserve", "meant", "mean", "intended", "intend"})
"""Participles before *for* and *to* that tell what a place is for."""
_BODY = word_set("hand finger thumb palm fist arm")
"""Parts of the person who does something."""
_LENGTHS = UNITS.keys() - _BODY | {"inche", "square"}
"""Words of the measure of a thing."""
_ENDS = frozenset({"COMMA", "CUT", ""})
_PREDICATES = frozenset({"PREP", "ADV", "PART", "TPART"})
_BREAKS = frozenset({"COMMA", "CUT", "BUT"})
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

_CALLING = frozenset({"call", "name", "know", "mark", "label", "refer", "title", "term"})
"""Participles in parentheses before another name of a thing."""
_NAMES = frozenset({"NP", "ADVERB", "ADJP", "CUT", "NOT", "UNKNOWN"})
"""Chunks in parentheses that say no place: *(A)*, *(mice!)*, *(not the blue one)*."""

_Run = tuple[int, Chunk | None]
"""End of a run of chunks, and the chunk that is put in its place, if any."""


def rewritten(chunks: list[Chunk], text: str) -> list[Chunk]:
    """Return the chunks of a sentence in the order and with the words of plain clauses.

    Parameters
    ----------
    chunks
        Chunks of a sentence in the order of the text.
    text
        The whole text, for its parentheses.

    Returns
    -------
    list of Chunk
        Chunks from which the clauses are cut. A chunk that was put in is empty and stands where its words would.
    """
    chunks = filled_in(_without_parentheses(chunks, text))
    for rewrite in (
        _without_vocatives, _with_accompanied_members, _with_first_of_owned, _with_things_of_several,
        _with_denied_commands, _without_adverbs_apart, _without_insertions, _with_counted_labels,
        _with_labels_of_definitions, _with_labels_of_commands, _with_participles_of_commands, _without(_second_verb),
        _without_openings, _with_placed_subjects, _with_participles_of_posture, _with_purposes_of_places,
        _with_means_as_commands, _with_placements_as_commands, *(_without(find) for find in asides.FINDERS),
        _without(_means), _without(_prevented), _with_shared_spots, _without_times, _without(_relative_aside),
        _without(_restriction_of_object),
        _without(_measures_apart), _without(_beneficiary), _without(_bare_superlative), _without(_free_place),
        _without_asides, _without_resumed_subjects, _with_existential_have, _with_verbs_of_one_person,
        _without(_search), _without(_infinitive), _without(_caused), _without(_sought_in_vain), _without(_partition),
        _without(_depicted), _without(_place_taken), _without(_count_apart), _without(_comparison_of_size),
        _without(_turn), _without(_posture_of_the_person), _without(_apposition_of_object), _with_parts_after_verbs,
        _with_relative_places, _with_measures_denied, _with_destinations, _with_objects_after_verbs,
        _with_contact_clauses, _with_label_nouns, _with_place_labels, _with_telegraphic_places, _without(_stranded),
        _with_labels_apart, _with_places_before_verbs, _with_pronouns_of_lists, _with_gaps, _with_aimed_parts,
        _with_shared_objects, _with_aims_of_subjects, _with_places_of_pairs, _with_places_of_nearest,
    ):  # fmt: skip
        chunks = rewrite(chunks)
    return chunks


def _without_parentheses(chunks: list[Chunk], text: str) -> list[Chunk]:
    """Return the chunks with what parentheses say about the noun before them at the end, as a phrase of its own.

    *Set the knife (with its blade to the left) beside the plate* is read as *set the knife beside the plate; the knife
    with its blade to the left*. A name in parentheses, or a word said in passing, is left out.
    """
    kept: list[Chunk] = []
    after: list[Chunk] = []
    i = 0
    while i < len(chunks):
        chunk = chunks[i]
        closing = next((k for k in range(i, len(chunks)) if text[slice(*chunks[k].span)] == ")"), None)
        inside = chunks[i + 1 : closing]
        opened = text[slice(*chunk.span)] == "(" and closing is not None and kept and inside
        if opened and _is_conditional(inside):
            _leave_out(inside, "what parentheses say under a condition is not read")
            i = (closing or i) + 1
            continue
        said = opened and kept[-1].type == "NP"
        doing = inside[1:] if opened and inside[0].type == "ADVERB" else inside
        called = doing[0].value if said and doing and doing[0].type in ("PART", "TPART") else None
        if isinstance(called, VerbGroup) and called.lemma.removesuffix("ed") in _CALLING:
            _leave_out(inside, "another name of a thing does not say where it is")
            i = (closing or i) + 1  # 'the lower drawer (sometimes marked crisper)'
            continue
        done = [c.type for c in inside] == ["NP", "PART"] and inside[0].value.determiner is None
        if said and done:
            _leave_out(inside, "how a thing is meanwhile is not where it is")
            i = (closing or i) + 1  # 'place the sofa (cushions removed) in the truck'
            continue
        if said and inside[0].type in ("WITH", "PREP", "ADV", "PART", "TPART") and "NP" in [c.type for c in inside]:
            aimed = inside[0].type == "PREP" and inside[0].value.preposition.degree is Degree.SUPERLATIVE
            subjects = [k for k in range(len(kept) - 1) if kept[k].type == "NP" and kept[k + 1].type in FINITE]
            of = kept[subjects[-1]] if aimed and subjects else kept[-1]  # 'A is on the left of B (farthest from C)'
            after += _apart([of], inside, chunk.span)
            i = (closing or i) + 1
            continue
        if said and [c.type for c in inside[:2]] == ["NP", "REL"] and "COMMA" not in [c.type for c in inside]:
            _leave_out(inside, "this says what the thing before is, not where it is")
            i = (closing or i) + 1  # 'the rooks (the pieces that look like towers) go …'
            continue
        if said and {c.type for c in inside} <= _NAMES and sum(c.type == "NP" for c in inside) == 1:
            i = (closing or i) + 1  # 'the long panels (A) go …', 'under a tea towel (mice!)'
            continue
        kept.append(chunk)
        i += 1
    return _with_last(kept, after)


def _apart(things: list[Chunk], said: list[Chunk], span: Span) -> list[Chunk]:
    """Return what is said about a thing, or about things with their joint, as a phrase of its own after a cut."""
    named = [
        replace(chunk, value=replace(chunk.value, determiner="the", count=None) if chunk.type == "NP" else chunk.value)
        for chunk in things
    ]
    return [Chunk("CUT", said[0].start, said[0].start, None, span), *named, *said]


def _with_last(chunks: list[Chunk], added: list[Chunk]) -> list[Chunk]:
    """Return the chunks with others at the end, before the full stop."""
    ends = len(chunks) - 1 if added and chunks and chunks[-1].type == "CUT" else len(chunks)
    return [*chunks[:ends], *added, *chunks[ends:]]


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
            after += _apart([chunks[i - 1]], chunks[i : i + 2], chunks[i].span)
            i += 2
            continue
        end = _end_of_own_part(chunks, i)
        if end is not None:  # 'you have the knife, with the blade facing the plate, and the spoon'
            after += _apart([chunks[i - 1]], chunks[i + 1 : end], chunks[i + 1].span)
            i = end
            continue
        kept.append(chunks[i])
        i += 1
    return _with_last(kept, after)


def _end_of_own_part(chunks: list[Chunk], at: int) -> int | None:
    """Return the end of *, with its blade facing the plate* between an object and *, and* with the last one."""
    aside = [type_at(chunks, at + k) for k in range(-2, 6)]
    apart = {aside[2], aside[7]} <= {"COMMA", "CUT"} and aside[0] in ("TVERB", "BE")
    if not apart or [aside[1], *aside[3:7]] != ["NP", "WITH", "NP", "PREP", "NP"]:
        return None
    listed = [type_at(chunks, at + k) for k in range(6, 9)]
    aimed = last_word(chunks[at + 2].value.head) in AIMED_PARTS
    joined = listed[0] in ("AND", "CUT") and listed[1] == "NP" and listed[2] in _ENDS
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
        end = end_before(chunks, first, _BREAKS)
        types = [chunk.type for chunk in chunks[first:end]]
        places = [chunk.value for chunk in chunks[first:end] if chunk.type == "PREP"]
        single = types[-2:] == ["PREP", "NP"] and set(types) <= {"REL", "VERB", "BE", "PART", "PREP", "NP"}
        if (
            single
            and places[-1].preposition.relation not in ("between", "among")
            and _ends_with_conjunction(chunks, end)
        ):
            places_of_first = chunks[first + 1 : end] if types[0] == "REL" else chunks[first:end]
            return _with_last([*chunks[:first], *chunks[end:]], _apart(chunks[at:first], places_of_first, thing.span))
    return chunks


_OWNING = frozenset({"have", "need", "include", "contain", "get", "bring"})
"""Verbs with lists of what one has."""


def _ends_with_conjunction(chunks: list[Chunk], at: int) -> bool:
    """Return True for commas with bare nouns, and a last noun after *and*: *, spoon, and fork*."""
    while [type_at(chunks, at), type_at(chunks, at + 1)] == ["COMMA", "NP"]:
        at += 2
    at += type_at(chunks, at) == "COMMA"
    return [type_at(chunks, at), type_at(chunks, at + 1)] == ["AND", "NP"]


def _is_conditional(inside: list[Chunk]) -> bool:
    """Return True for words in parentheses that have a condition of their own: *(and drinks, if you serve any)*."""
    types = [chunk.type for chunk in inside]
    limited = "SUB" in types and not FINITE.isdisjoint(types)
    if types[0] == "SUB":
        limited = "COMMA" in types and not FINITE.isdisjoint(types[types.index("COMMA") :])
    return limited and types[0] in ("SUB", "AND", "OR", "BUT")


def _without_vocatives(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out who is spoken to, and interjections: *My dear boy, the soup is …*, *No, look again*, *Right, …*."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        starts = all(c.type == "ADVERB" or (c.type in _ENDS and k) for k, c in enumerate(found))
        closed = type_at(chunks, i + 1) in ("COMMA", "CUT") and (starts or type_at(chunks, i - 1) == "COMMA")
        spoken_to = chunk.type == "NP" and _names_listener(chunk.value) and (starts or type_at(chunks, i + 2) in _ENDS)
        addressed = (
            starts and chunk.type == "NP" and chunk.value.determiner is None and not chunk.value.plural
            and bool(chunk.value.head) and chunk.value.owner is None and not chunk.value.adjectives
            and type_at(chunks, i + 1) == "COMMA" and type_at(chunks, i + 2) == "NP"
            and (chunks[i + 2].value.pronoun == "you" or _is_yours(chunks[i + 2].value))
        )  # fmt: skip
        spoken_to = spoken_to or addressed  # 'Lena, your bag is …'
        exclamation = (
            starts and not found and chunk.type in ("NP", "ADV", "PART") and type_at(chunks, i + 1) == "COMMA"
            and chunk.end == chunk.start + 1 and _is_exclamation(chunk)
            and any(c.type in FINITE | {"COLON", "PUT", "FIND", "TPART"} for c in chunks[i + 2 :])
        )  # fmt: skip
        found.append(emptied(chunk) if closed and (spoken_to or exclamation) else chunk)
    return found


def _with_denied_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *never, I repeat never, set the lamp on it* with the command denied."""
    first = chunks[0] if chunks else None
    denies = first is not None and (first.type == "NOT" or first.value == "never") and type_at(chunks, 1) == "COMMA"
    for i, chunk in enumerate(chunks if denies else ()):
        if chunk.type in ("PUT", "DO"):
            return [*chunks[:i], replace(chunk, value=replace(chunk.value, positive=False)), *chunks[i + 1 :]]
    return chunks


def _without_adverbs_apart(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out an adverb between commas, the commas before a verb, and what joins an adverb with one of a place.

    *The cup, in turn, stands behind the jug* is read as *the cup stands behind the jug*.
    """
    found: list[Chunk] = []
    i = 0
    while i < len(chunks):
        end = i + 1
        while type_at(chunks, end) == "ADVERB":
            end += 1
        if chunks[i].type == "COMMA" and end > i + 1 and type_at(chunks, end) == "COMMA":
            verb = type_at(chunks, i - 1) == "NP" and type_at(chunks, end + 1) in FINITE
            found += chunks[i + 1 : end] if verb else chunks[i:end]
            i = end + 1
        elif (
            chunks[i].type == "AND" and type_at(found, len(found) - 1) == "ADVERB" and type_at(chunks, i + 1) == "PREP"
        ):
            i += 1  # 'place the fork horizontally and directly above the plate'
        else:
            found.append(chunks[i])
            i += 1
    return found


def _is_yours(phrase: NounPhrase) -> bool:
    return phrase.owner is not None and phrase.owner.pronoun == "you"


def _names_listener(phrase: NounPhrase) -> bool:
    dear = any(adjective.word == "dear" for adjective in phrase.adjectives) or phrase.head.startswith("dear ")
    own = phrase.owner is not None and phrase.owner.pronoun == "me"
    if phrase.predicates or phrase.of is not None or phrase.members or phrase.count is not None:
        return False
    return (dear and (own or phrase.determiner is None)) or (
        last_word(phrase.head) in PEOPLE | _ENDEARMENTS and phrase.determiner is None and phrase.owner is None
        and not phrase.adjectives and " " not in phrase.head
    )  # fmt: skip


def _is_exclamation(chunk: Chunk) -> bool:
    if chunk.type == "ADV":
        return bool(chunk.value.preposition.phrase == "right")
    if chunk.type == "NP":
        return bool(chunk.value.determiner == "no" and not chunk.value.head)
    return False


def _without_times(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out the time at the beginning of a sentence: *Before the run, check …*, *Once set, …*."""
    start = next((i for i, chunk in enumerate(chunks) if chunk.type != "ADVERB"), 0)
    if [type_at(chunks, start), type_at(chunks, start + 2)] == ["SUB", "COMMA"] and chunks[start].value == "once":
        done = chunks[start + 1]
        bare = done.type in ("ADJP", "PART") or (done.type == "NP" and done.end == done.start + 1)
        if bare:
            return [*chunks[:start], *(emptied(c) for c in chunks[start : start + 3]), *chunks[start + 3 :]]
    types = [type_at(chunks, start + k) for k in range(4)]
    if types[0] == "SUB" and types[2:] == ["COMMA", "PUT"] and chunks[start].value in ("when", "once"):
        done = chunks[start + 1]
        bare = done.type == "NP" and done.value.determiner is None and done.value.head in READY
        bare = bare or (done.type == "ADJP" and all(a.word in READY for a in done.value))
        if bare:  # 'when cool, push the rice to one side'
            return [*chunks[:start], *chunks[start + 3 :]]
    if types[:3] != ["PREP", "NP", "COMMA"]:
        return chunks
    phrase = chunks[start + 1].value
    before = chunks[start].value.preposition.phrase == "before"
    inverted = type_at(chunks, start + 3) in FINITE | _PREDICATES
    if not before or phrase.pronoun is not None or not phrase.head or inverted:
        return chunks
    return [*chunks[:start], emptied(chunks[start]), *chunks[start + 3 :]]


def _with_labels_of_definitions(chunks: list[Chunk]) -> list[Chunk]:
    """Return *Tea pot: a vessel for tea, placed in the middle* as *tea pot placed in the middle*."""
    types = [type_at(chunks, k) for k in range(3)]
    if types != ["NP", "COLON", "NP"] or chunks[2].value.determiner not in ("a", "an") or chunks[2].value.members:
        return chunks
    end = next((k for k in range(3, len(chunks)) if chunks[k].type in ("COMMA", "CUT")), len(chunks))
    told = chunks[3:end]
    purpose = bool(told) and (told[0].type == "REL" or getattr(told[0].value, "lemma", "") == "use")
    purpose = purpose or (bool(told) and told[0].type in ("UNKNOWN", "PREP") and _word(told[0]) == "for")
    rest = [chunk for chunk in chunks[end + 1 :] if chunk.type != "ADVERB"]
    if not purpose or type_at(chunks, end) != "COMMA" or not rest or rest[0].type not in ("PART", "PREP"):
        return chunks
    _leave_out(chunks[2:end], "a definition does not say where something is")
    return [chunks[0], *chunks[end + 1 :]]


def _word(chunk: Chunk) -> str:
    """Return the preposition of a chunk, or the word of one that is not understood."""
    return chunk.value.preposition.phrase if isinstance(chunk.value, Relator) else str(chunk.value or "")


def _with_labels_of_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *Peas: plant along the wall* as *peas along the wall*: the label is the object of the command."""
    types = [chunk.type for chunk in chunks[:4]]
    if types[:3] != ["NP", "COLON", "NP"] or types[3:] not in (["PREP"], ["ADV"]) or chunks[0].value.determiner:
        return chunks
    verb = chunks[2].value
    if verb.determiner or verb.owner is not None or verb.adjectives or verb.head not in PUT_VERBS:
        return chunks
    return [chunks[0], *chunks[3:]]


def _with_participles_of_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *put the pan on the tray, placing the lid next to it* with a second command."""
    first = next((chunk.type for chunk in chunks if chunk.type != "ADVERB"), "")
    for i in range(1, len(chunks) - 2):
        chunk = chunks[i]
        led = first in ("PUT", "DO") and chunks[i - 1].type == "COMMA"
        if led and chunk.type == "TPART" and chunks[i + 1].type == "NP" and chunks[i + 2].type in ("PREP", "ADV"):
            group = chunk.value if isinstance(chunk.value, VerbGroup) else None
            if group is not None and group.lemma in PLACING_VERBS:
                command = replace(chunk, type="PUT", value=replace(group, form="base"))
                joint = replace(chunks[i - 1], type="CUT")
                return [*chunks[: i - 1], joint, command, *_with_participles_of_commands(chunks[i + 1 :])]
    return chunks


_UNSURE = frozenset({"can", "could", "may", "might", "would"})
"""Modals of what need not be done."""
_UNCONDITIONAL = frozenset({"before", "after", "because", "as", "so"})
"""Conjunctions of clauses that are not conditions."""


def _second_verb(chunks: list[Chunk], at: int) -> _Run | None:
    """Find the second verb of *she sits or kneels to the left of it*, which looks like a plural."""
    types = [type_at(chunks, at + k) for k in range(-1, 3)]
    if types not in (["VERB", "OR", "NP", "PREP"], ["VERB", "AND", "NP", "PREP"], ["VERB", "OR", "NP", "ADV"]):
        return None
    phrase = chunks[at + 1].value
    form = verb_forms().get(phrase.head) if phrase.plural and phrase.determiner is None else None
    told = form is not None and form.form == "base" and form.kind in ("posture", "lean")
    return (at + 2, None) if told and not phrase.adjectives and phrase.head not in NAMED_LIKE_THINGS else None


def _prevented(chunks: list[Chunk], at: int) -> _Run | None:
    """Find what is prevented: *to keep it from sliding on the counter*."""
    away = chunks[at].type in ("UNKNOWN", "PREP") and _word(chunks[at]) == "from" and at > 0
    group = chunks[at + 1].value if away and type_at(chunks, at + 1) in ("TPART", "PART") else None
    if not isinstance(group, VerbGroup) or group.form != "ing" or chunks[at].end - chunks[at].start > 1:
        return None
    end = end_before(chunks, at + 1, _BREAKS)
    _leave_out(chunks[at:end], "what is prevented does not say where something is")
    return end, None


def _with_shared_spots(chunks: list[Chunk]) -> list[Chunk]:
    """Return *with the flutes and clarinets on the left* with the place after both plurals."""
    found: list[Chunk] = []
    accompanied = False
    for i, chunk in enumerate(chunks):
        accompanied = chunk.type == "WITH" or (accompanied and chunk.type not in FINITE | _BREAKS | {"SUB", "REL"})
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


def _means(chunks: list[Chunk], at: int) -> _Run | None:
    """Find the phrase that says how something is done and gives no place: *by keeping both hands on it*."""
    named = chunks[at].type == "UNKNOWN" and chunks[at].value == "by" and at > 0
    doing = type_at(chunks, at + 1) in ("TPART", "PART")
    group = chunks[at + 1].value if doing else None
    form = group.form if isinstance(group, VerbGroup) else ""
    if not (named and doing and form == "ing" and chunks[at].end == chunks[at].start + 1):
        return None
    end = end_before(chunks, at + 1, _BREAKS)
    _leave_out(chunks[at:end], "how something is done is not where it is")
    return end, None


def _with_placements_as_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *storing the plates near the sink saves time* and *keeping it on a shelf is a good idea* as a command.

    Only what is good for something is advice, so that *placing it on the edge is risky* stays as it is.
    """
    first = next((i for i, chunk in enumerate(chunks) if chunk.type != "ADVERB"), 0)
    if [type_at(chunks, first), type_at(chunks, first + 1)] != ["TPART", "NP"]:
        return chunks
    group = chunks[first].value
    if not isinstance(group, VerbGroup) or group.form != "ing" or group.lemma not in PLACING_VERBS | PUT_VERBS:
        return chunks
    verb = end_before(chunks, first + 2, FINITE | _BREAKS)
    placed = any(chunk.type in ("PREP", "ADV") for chunk in chunks[first + 2 : verb])
    if not placed or type_at(chunks, verb) not in FINITE or not _approves(chunks, verb):
        return chunks
    end = end_before(chunks, verb, frozenset({"CUT"}))
    _leave_out(chunks[verb:end], "what a step is good for does not say where something is")
    command = replace(chunks[first], type="PUT", value=replace(group, form="base"))
    return [*chunks[:first], command, *chunks[first + 1 : verb], *chunks[end:]]


def _approves(chunks: list[Chunk], at: int) -> bool:
    """Return True for a verb that says what a placement is good for: *saves time*, *is a good idea*."""
    group = chunks[at].value
    if not isinstance(group, VerbGroup) or not group.positive or group.past or group.modal in _UNSURE:
        return False
    if group.lemma in _SERVING:
        return True
    after = chunks[at + 1] if at + 1 < len(chunks) else None
    if group.lemma != "be" or after is None:
        return False
    words = [a.word for a in after.value] if after.type == "ADJP" else []
    if after.type == "NP":
        words = [a.word for a in after.value.adjectives] + after.value.head.split()
    return not _GOOD.isdisjoint(words)


_SERVING = word_set(
    "ensure allow help save keep simplify reduce minimize minimise protect improve free facilitate maximize maximise"
)
"""Verbs of what a placement is good for."""
_GOOD = word_set(
    "good great best better ideal important helpful useful convenient safest easiest key essential perfect"
)


def _with_means_as_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *protect it by putting it in the box* and *by putting it there, you …* with a second command.

    A placement is a means only where its clause is neither under a condition, nor denied, nor past.
    """
    groups = [chunk.value for chunk in chunks if isinstance(chunk.value, VerbGroup)]
    told = not any(group.past or not group.positive or group.modal in _UNSURE for group in groups)
    limited = any(
        chunk.type in ("REL", "COMPLEMENT") or (chunk.type == "SUB" and chunk.value not in _UNCONDITIONAL)
        for chunk in chunks
    )
    if limited or not told:
        return chunks
    for at, chunk in enumerate(chunks[:-3]):
        named = chunk.type == "UNKNOWN" and chunk.value == "by" and chunk.end == chunk.start + 1
        group = chunks[at + 1].value if named and chunks[at + 1].type == "TPART" else None
        if not isinstance(group, VerbGroup) or group.form != "ing" or group.lemma not in PLACING_VERBS:
            continue
        end = end_before(chunks, at + 2, _BREAKS)
        thing = chunks[at + 2].value if chunks[at + 2].type == "NP" else None
        placed = any(other.type in ("PREP", "ADV") for other in chunks[at + 3 : end])
        if not placed or thing is None or last_word(thing.head) in _BODY:
            continue
        command = replace(chunks[at + 1], type="PUT", value=replace(group, form="base"))
        treated = chunks[at - 1].value if thing.pronoun == "it" and type_at(chunks, at - 1) == "NP" else None
        if treated is not None and not (treated.plural or treated.pronoun):  # 'boil the egg by placing it in …'
            chunks[at + 2] = replace(chunks[at + 2], value=replace(treated, determiner="the", count=None))
        ends = [cut(chunks[end])] if type_at(chunks, end) == "COMMA" else chunks[end : end + 1]
        return [*chunks[:at], cut(chunk), command, *chunks[at + 2 : end], *ends, *chunks[end + 1 :]]
    return chunks


def _without_openings(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out what opens a statement: *that means* before a clause, *next is* before the next thing."""
    first = next((i for i, chunk in enumerate(chunks) if chunk.type != "ADVERB"), 0)
    if len(chunks) < first + 3 or chunks[first + 2].type != "NP":
        return chunks
    opening, verb = chunks[first : first + 2]
    group = verb.value if isinstance(verb.value, VerbGroup) else None
    if group is None or not group.positive or group.past:
        return chunks
    pointed = opening.type == "NP" and opening.value.pronoun in ("this", "that", "it") and not opening.value.head
    clause = type_at(chunks, first + 3) in FINITE
    if pointed and group.lemma == "mean" and group.modal is None and clause:
        return chunks[first + 2 :]
    words = [a.word for a in opening.value] if opening.type == "ADJP" else [opening.value]
    words = [opening.value.head] if opening.type == "NP" else words
    if words != ["next"] or opening.end != opening.start + 1 or group.lemma not in ("be", "come"):
        return chunks
    placed = any(chunk.type in _PREDICATES for chunk in chunks[first + 3 :])
    command = VerbGroup("place", "posture", "base") if placed else VerbGroup("take", "other", "base")
    return [Chunk("PUT" if placed else "DO", opening.start, verb.end, command, opening.span), *chunks[first + 2 :]]


def _with_placed_subjects(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the placement of the spoon should be …* with the spoon as its subject."""
    for at in range(len(chunks) - 3):
        types = [type_at(chunks, at + k) for k in range(-1, 5)]
        begins = types[0] in _ENDS | {"ADVERB"} and types[1:5] == ["NP", "OF", "NP", "BE"]
        if begins and types[5] in ("PREP", "ADV"):
            phrase = chunks[at].value
            plain = not (phrase.adjectives or phrase.predicates or phrase.plural or phrase.owner)
            if phrase.head in _PLACEMENTS and phrase.determiner == "the" and plain:
                return [*chunks[:at], *chunks[at + 2 :]]
    return chunks


_PLACEMENTS = frozenset({"placement", "position", "location"})
"""Nouns for the place of a thing, of which a place says where the thing is."""


def _with_participles_of_posture(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the candle is stood on the mat* with a participle."""
    return [
        replace(chunk, type="PART")
        if chunk.type == "VERB" and chunk.value.lemma in ("stand", "sit") and chunk.value.form == "past"
        and type_at(chunks, i - 1) == "BE" else chunk
        for i, chunk in enumerate(chunks)
    ]  # fmt: skip


def _with_purposes_of_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *the top shelf is for glasses* as *glasses are on the top shelf*; also *is reserved for*."""
    cuts = [i for i, chunk in enumerate(chunks) if chunk.type == "CUT"]
    found: list[Chunk] = []
    for start, end in pairwise([0, *cuts, len(chunks)]):
        found += _with_purpose_of_place(chunks[start:end])
    return found


def _with_purpose_of_place(whole: list[Chunk]) -> list[Chunk]:
    chunks = [chunk for chunk in whole if chunk.type != "ADVERB"]
    first = next((i for i, chunk in enumerate(chunks) if chunk.type not in ("CUT", "COMMA")), 0)
    if chunks and chunks[first].type in ("PUT", "DO", "FIND") and chunks[first].value.lemma in _RESERVING:
        return _with_reserved_places(chunks, first) or whole
    types = [type_at(chunks, first + k) for k in range(4)]
    told = types[2] == "PART" and chunks[first + 2].value.lemma in _RESERVED
    at = first + 2 + told
    if types[:2] != ["NP", "BE"] or type_at(chunks, at) != "PREP" or type_at(chunks, at + 1) != "NP":
        return whole
    place, be, relator, thing = chunks[first], chunks[first + 1], chunks[at].value, chunks[at + 1].value
    end = at + 2
    while [type_at(chunks, end), type_at(chunks, end + 1)] == ["AND", "NP"]:
        end += 2
    noun = last_word(place.value.head)
    single = be.value.positive and (told or not place.value.plural) and be.value.modal in (None, "should", "must")
    fits = relator.preposition.phrase == "for" or (told and relator.preposition.phrase == "to")
    named = _names_things(thing)
    if not (single and fits and named and noun in _STORING and type_at(chunks, end) in _ENDS):
        return whole
    inside = noun in VESSELS | HOLDERS
    spot = Relator(Preposition("in" if inside else "on", "inside" if inside else "on"))
    return [*chunks[:first], *chunks[at + 1 : end], be, replace(chunks[at], value=spot), place, *chunks[end:]]


def _names_things(phrase: NounPhrase) -> bool:
    """Return True for *cups* and *the bread*, but not for *transport*, which may be an act, nor for persons."""
    thing = bool(phrase.head) and last_word(phrase.head) not in PEOPLE and not phrase.pronoun
    return thing and (phrase.plural or phrase.determiner == "the" or phrase.owner is not None)


def _with_reserved_places(chunks: list[Chunk], at: int) -> list[Chunk] | None:
    """Return *use the upper rack for cups and the lower rack for plates* as *put cups in the upper rack and …*."""
    if not chunks[at].value.positive:
        return None
    made: list[Chunk] = [*chunks[:at], replace(chunks[at], type="PUT", value=VerbGroup("put", "posture", "base"))]
    at += 1
    while [type_at(chunks, at + k) for k in range(3)] == ["NP", "PREP", "NP"]:
        place, relator, thing = chunks[at].value, chunks[at + 1].value, chunks[at + 2].value
        noun = last_word(place.head)
        kept = _names_things(thing) and not place.plural
        if relator.preposition.phrase != "for" or noun not in _STORING or not kept:
            return None
        inside = noun in VESSELS | HOLDERS
        spot = Relator(Preposition("in" if inside else "on", "inside" if inside else "on"))
        made += [chunks[at + 2], replace(chunks[at + 1], value=spot), chunks[at]]
        at += 3
        if type_at(chunks, at) not in ("AND", "COMMA") or type_at(chunks, at + 1) != "NP":
            return [*made, *chunks[at:]] if type_at(chunks, at) in _ENDS else None
        made.append(chunks[at])
        at += 1
    return None


def _beneficiary(chunks: list[Chunk], at: int) -> _Run | None:
    """Find for whom a thing is: *put out a bowl for you*, *left you a cake*, *the glass for the guest right of it*."""
    if type_at(chunks, at - 1) in ("TVERB", "PUT") and type_at(chunks, at + 1) == "NP" and chunks[at].type == "NP":
        return (at + 1, None) if chunks[at].value.pronoun in PERSONS and not chunks[at].value.head else None
    if not (chunks[at].type == "PREP" and chunks[at].value.preposition.phrase == "for" and at > 0):
        return None
    person = type_at(chunks, at + 1) == "NP" and chunks[at + 1].value.pronoun in PERSONS | {"everyone"}
    helped = person and type_at(chunks, at + 2) in JOINT_TYPES | {"", "PREP", "ADV"}
    types = [chunk.type for chunk in chunks[max(0, at - 2) : at + 3]]
    purpose = types == ["BE", "NP", "PREP", "NP", "PREP"] and chunks[at + 1].value.determiner is None
    if purpose and chunks[at + 1].value.owner is None and type_at(chunks, at - 3) == "THERE":
        return at + 2, None  # 'there is a tray for mail on the cabinet'
    return (at + 2, None) if helped or types == ["PUT", "NP", "PREP", "NP", "PREP"] else None


def _bare_superlative(chunks: list[Chunk], at: int) -> _Run | None:
    """Find the member of an uncounted group that is told apart: *pipettes on the stand, largest on the left*."""
    apart = (
        [type_at(chunks, at + k) for k in range(4)] == ["COMMA", "ADJP", "PREP", "NP"]
        and type_at(chunks, at + 4) in _ENDS and chunks[at + 1].value[-1].degree is Degree.SUPERLATIVE
        and chunks[at + 3].value.head in PLACE_NOUNS
    )  # fmt: skip
    nearby = (
        [type_at(chunks, at + k) for k in range(4)] == ["COMMA", "ADJP", "PREP", "NP"]
        and type_at(chunks, at + 4) in _ENDS and chunks[at + 1].value[-1].degree is Degree.SUPERLATIVE
        and chunks[at + 1].value[-1].dimension in ("size", "length", "height", "width", "thickness")
    )  # 'a rack of tubes, longest at the wall'  # fmt: skip
    above = (
        [type_at(chunks, at + k) for k in range(3)] == ["COMMA", "ADJP", "ADV"] and type_at(chunks, at + 3) in _ENDS
        and chunks[at + 1].value[-1].degree is Degree.SUPERLATIVE
        and chunks[at + 1].value[-1].dimension in ("size", "length", "height", "width", "thickness", "other")
    )  # 'pans stacked on the rack, smallest on top'  # fmt: skip
    if above:
        return at + 3, None
    apart = apart or nearby
    nearest = (
        [type_at(chunks, at + k) for k in range(3)] == ["COMMA", "ADJP", "NP"] and type_at(chunks, at + 3) in _ENDS
        and chunks[at + 1].value[-1].word in ("near", "far") and len(chunks[at + 1].value) > 1
    )  # 'ink pots in front of the lamp, black nearest the client'  # fmt: skip
    return (at + 3 + (not nearest), None) if apart or nearest else None


def _free_place(chunks: list[Chunk], at: int) -> _Run | None:
    """Find *where it (always) is*: what follows after the comma says where the thing is."""
    thing = type_at(chunks, at + 1) == "NP"
    there = (
        chunks[at].type == "REL" and thing and chunks[at + 1].value.pronoun in ("it", "they")
        and type_at(chunks, at + 2) == "BE" and type_at(chunks, at + 3) in _ENDS
    )  # fmt: skip
    free = (
        chunks[at].type == "SUB" and chunks[at].value == "where" and type_at(chunks, at - 1) in ("BE", "VERB")
        and thing and type_at(chunks, at + 2) in FINITE
    )  # fmt: skip
    aside = (
        chunks[at].type in ("SUB", "REL") and chunks[at].value in ("where", None) and thing and not there
        and chunks[at + 1].value.pronoun in ("it", "they", "you")
        and [type_at(chunks, at - k) for k in (2, 1)] == ["PUT", "NP"]
    )  # 'put it where it cannot fall, between the boxes'  # fmt: skip
    if not there and not free and not aside:
        return None
    end = end_before(chunks, at + 3, JOINT_TYPES)
    if aside and [type_at(chunks, end + k) for k in (0, 1)] != ["COMMA", "PREP"]:
        return None
    return end + ((free or aside) and type_at(chunks, end) in ("COMMA", "COLON")), None


def _search(chunks: list[Chunk], at: int) -> _Run | None:
    """Find a command to look somewhere: *look behind the bandages*."""
    verb = chunks[at].value
    looks = (
        isinstance(verb, VerbGroup) and verb.lemma in ("look", "search", "check", "peek")
        and verb.form == "base" and type_at(chunks, at - 1) in JOINT_TYPES | {"", "ADVERB"}
        and type_at(chunks, at + 1) == "PREP"
        and chunks[at + 1].value.preposition.relation not in ("to", "at", "facing", "pointing", "from", "through")
    )  # fmt: skip
    return _unknown(chunks, at, end_before(chunks, at, JOINT_TYPES)) if looks else None


def _partition(chunks: list[Chunk], at: int) -> _Run | None:
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


def _sought_in_vain(chunks: list[Chunk], at: int) -> _Run | None:
    """Find where someone looks for a thing that stands first: *the spoon you will look for in vain on the tray*."""
    person = chunks[at].type == "NP" and chunks[at].value.pronoun in PERSONS and type_at(chunks, at - 1) == "NP"
    verb = chunks[at + 1].value if person and type_at(chunks, at + 1) in FINITE else None
    looks = verb is not None and verb.lemma in ("look", "search", "hunt") and type_at(chunks, at + 2) == "UNKNOWN"
    return _unknown(chunks, at, end_before(chunks, at, JOINT_TYPES)) if looks else None


def _caused(chunks: list[Chunk], at: int) -> _Run | None:
    """Find what someone lets others do: *the owner had it moved*, which states the place of no thing."""
    if chunks[at].type != "NP" or type_at(chunks, at + 1) != "TVERB":
        return None
    types = [type_at(chunks, at + k) for k in range(4)]
    caused = types == ["NP", "TVERB", "NP", "PART"] and chunks[at + 1].value.lemma in ("have", "get")
    if not caused or type_at(chunks, at + 4) not in JOINT_TYPES | {""} or not chunks[at].value.head:
        return None
    return _unknown(chunks, at, at + 4) if chunks[at + 2].value.pronoun in ("it", "they") else None


def _infinitive(chunks: list[Chunk], at: int) -> _Run | None:
    """Find an infinitive with what belongs to it: *the bottle is too tall to stand on the shelf*."""
    chunk = chunks[at]
    to = chunk.type == "UNKNOWN" and chunk.value == "to" and type_at(chunks, at + 1) in ("UNKNOWN", "VERB", "TVERB")
    end = end_before(chunks, at, JOINT_TYPES | {"REL"})
    while to and [type_at(chunks, end + k) for k in (-1, 0, 1)] == ["NP", "OR", "NP"] and _is_bare(chunks[end + 1]):
        end = end_before(chunks, end + 1, JOINT_TYPES | {"REL"})  # 'to spread jam or butter on bread'
    return _unknown(chunks, at, end) if to else None


def _is_bare(chunk: Chunk) -> bool:
    """Return True for a noun phrase without an article, an owner and a number."""
    phrase = chunk.value
    return bool(phrase.head) and phrase.determiner is None and phrase.owner is None and phrase.count is None


def _stranded(chunks: list[Chunk], at: int) -> _Run | None:
    """Find the preposition at the end of a relative clause: *the bell you were hoping for is …*."""
    chunk = chunks[at]
    bare = chunk.type in ("UNKNOWN", "ADVERB") and chunk.value in ("for", "about", "with", "of", "at", "to")
    ends = bare and type_at(chunks, at - 1) in FINITE | {"PART", "NP"} and type_at(chunks, at + 1) in FINITE
    return (at + 1, None) if ends and "REL" in [c.type for c in chunks[:at]] else None


def _depicted(chunks: list[Chunk], at: int) -> _Run | None:
    """Find what a picture *is of*: *the painting is of a boat under a bridge*."""
    shown = chunks[at].type == "OF" and type_at(chunks, at - 1) == "BE" and type_at(chunks, at + 1) == "NP"
    return _unknown(chunks, at, end_before(chunks, at, JOINT_TYPES)) if shown else None


def _place_taken(chunks: list[Chunk], at: int) -> _Run | None:
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


def _apposition_of_object(chunks: list[Chunk], at: int) -> _Run | None:
    """Find a relative clause between the object of a command and its place: *lay the cloth, which is white, over it*.

    Such a clause says what the thing is, or compares it with another one; so does *filled with water and ice*.
    """
    types = [type_at(chunks, k) for k in range(at - 2, at + 3)]
    filled = types[3] == "WITH" and chunks[at + 1].value.preposition.phrase.endswith("filled with")
    if at < 2 or types[:3] != ["PUT", "NP", "COMMA"] or not (filled or types[3:] == ["REL", "BE"]):
        return None
    joints = JOINT_TYPES - {"AND"} if filled else JOINT_TYPES
    end = next((k for k in range(at + 1, len(chunks)) if chunks[k].type in joints), len(chunks))
    return (end + 1, None) if type_at(chunks, end) == "COMMA" and type_at(chunks, end + 1) in ("PREP", "ADV") else None


def _relative_aside(chunks: list[Chunk], at: int) -> _Run | None:
    """Find a relative clause after a comma whose verb says no place: *the candle, which represents fire, is …*."""
    verb = next((k for k in range(at + 2, len(chunks)) if chunks[k].type != "ADVERB"), len(chunks))
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at + 1) != "REL" or verb == len(chunks):
        return None
    end = end_before(chunks, verb + 1, _BREAKS)
    goes_on = type_at(chunks, end) == "COMMA" and type_at(chunks, end + 1) in FINITE
    lost = chunks[verb].type == "NP" and goes_on and end == verb + 1 and chunks[verb].value.determiner is None
    group = chunks[verb].value if chunks[verb].type in ("VERB", "TVERB") else None
    says_nothing = group is not None and group.kind in ("other", "unknown") and group.lemma not in TRANSITIVE_RELATIONS
    if not (lost or says_nothing):
        return None
    _leave_out(chunks[at + 1 : end], "this clause does not say where something is")
    return end + 1 if goes_on else end, None


def _restriction_of_object(chunks: list[Chunk], at: int) -> _Run | None:
    """Find which things a command is about, before their place: *put the fruits that spoil quickly on the shelf*."""
    if type_at(chunks, at) != "REL" or [type_at(chunks, k) for k in (at - 2, at - 1)] != ["PUT", "NP"]:
        return None
    verb = chunks[at + 1] if type_at(chunks, at + 1) == "VERB" else None
    group = verb.value if verb is not None else None
    placeless = ("other", "unknown", "transitive")
    if not isinstance(group, VerbGroup) or group.kind not in placeless or group.lemma in TRANSITIVE_RELATIONS:
        return None
    end = next((k for k in range(at + 2, len(chunks)) if chunks[k].type != "ADVERB"), len(chunks))
    return (end, None) if type_at(chunks, end) in ("PREP", "ADV") else None


def _leave_out(chunks: list[Chunk], reason: str) -> None:
    """Report chunks that are left out."""
    misunderstood((chunks[0].span[0], chunks[-1].span[1]), reason)


def _measures_apart(chunks: list[Chunk], at: int) -> _Run | None:
    """Find how large the subject is, between commas: *a small tray, about a foot square, stands …*."""
    if at != 1 or type_at(chunks, 0) != "NP" or type_at(chunks, at) != "COMMA":
        return None
    end = end_before(chunks, at + 1, _BREAKS)
    inner = [chunk for chunk in chunks[at + 1 : end] if chunk.type != "ADVERB"]
    sizes = {chunk.type for chunk in inner} <= {"NP", "ADJP", "AND", "MEASURE"} and bool(inner)
    if not sizes or type_at(chunks, end) != "COMMA" or type_at(chunks, end + 1) not in FINITE:
        return None
    told = all(not _LENGTHS.isdisjoint(c.value.head.split()) for c in inner if c.type == "NP")
    if not told:
        return None
    _leave_out(chunks[at + 1 : end], "a measure without 'is' is not read here")
    return end + 1, None


def _turn(chunks: list[Chunk], at: int) -> _Run | None:
    """Find the turn of a thing in a list of steps: *towel first: fold it*, *the guest first: a beaker …*."""
    turn = at == 1 and [type_at(chunks, k) for k in range(3)] == ["NP", "NP", "COLON"]
    ranked = turn and not chunks[at].value.head and chunks[at].value.determiner is None
    return (at + 1, None) if ranked and any(a.rank for a in chunks[at].value.adjectives) else None


def _posture_of_the_person(chunks: list[Chunk], at: int) -> _Run | None:
    """Find how the person is who has things somewhere: *sitting at the desk I have the lamp on my left*."""
    sits = at == 0 and chunks[0].type == "PART" and chunks[0].value.form == "ing" and chunks[0].value.kind == "posture"
    end = end_before(chunks, 1, frozenset({"NP"}))
    while type_at(chunks, end) == "NP" and type_at(chunks, end + 1) in ("OF", "PREP"):
        end += 2
    after = end + 1 + (type_at(chunks, end + 1) == "COMMA")
    person = type_at(chunks, after) == "NP" and chunks[after].value.pronoun in PERSONS and not chunks[after].value.head
    return (after, None) if sits and person and type_at(chunks, 1) == "PREP" else None


def _comparison_of_size(chunks: list[Chunk], at: int) -> _Run | None:
    """Find what a thing is compared with: *a globe the size of a pumpkin*."""
    compared = [type_at(chunks, at + k) for k in (-1, 0, 1, 2)] == ["NP", "NP", "OF", "NP"]
    sized = compared and chunks[at].value.determiner == "the" and chunks[at].value.head in _SIZES
    return (at + 3, None) if sized else None


def _count_apart(chunks: list[Chunk], at: int) -> _Run | None:
    """Find a number that is given apart: *the mugs hang from the hooks, five of them, and …*."""
    counts = (
        [type_at(chunks, at + k) for k in range(4)] == ["COMMA", "NP", "OF", "NP"]
        and type_at(chunks, at + 4) in _ENDS and chunks[at + 3].value.pronoun in ("they", "these", "those")
        and not chunks[at + 1].value.head and chunks[at + 1].value.count is not None
        and any(chunk.type in FINITE for chunk in chunks[:at])
    )  # fmt: skip
    return (at + 4, None) if counts else None


def _without(find: Callable[[list[Chunk], int], _Run | None]) -> Callable[[list[Chunk]], list[Chunk]]:
    """Return the rewriting that leaves out each run of chunks that ``find`` finds, or puts its chunk there."""

    def rewrite(chunks: list[Chunk]) -> list[Chunk]:
        found: list[Chunk] = []
        at = 0
        while at < len(chunks):
            end, instead = find(chunks, at) or (at + 1, chunks[at])
            found += [] if instead is None else [instead]
            at = end
        return found

    return rewrite


def _unknown(chunks: list[Chunk], at: int, end: int) -> _Run:
    """Return a run with one chunk for it that is reported as not understood."""
    return end, Chunk(
        "UNKNOWN", chunks[at].start, chunks[end - 1].end, None, (chunks[at].span[0], chunks[end - 1].span[1])
    )


def _without_asides(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out an aside after a comma: *as if someone had just put it down*, *which made everyone laugh*."""
    for i, chunk in enumerate(chunks):
        after = type_at(chunks, i + 1)
        manner = chunk.type == "UNKNOWN" and chunk.value == "as" and after in FINITE | {"PART"}
        compared = chunk.type == "SUB" and chunk.value == "as" and after == "SUB"
        so = chunk.type == "SUB" and chunk.value == "so" and after == "ADJP"
        so = so or (chunk.type == "SUB" and chunk.value == "once" and after == "PREP")  # 'once on the shelf'
        searched = (
            chunk.type in ("SUB", "REL") and chunk.value in ("where", None)
            and after == "NP" and chunks[i + 1].value.pronoun in PERSONS
            and any(c.type == "COMMA" for c in chunks[i + 1 :])
        )  # 'not in the box, where I had looked for it, but …'  # fmt: skip
        where = chunk.type in ("SUB", "REL") and chunk.value in ("where", None) and after == "NP"
        comma = next((k for k in range(i, len(chunks)) if chunks[k].type == "COMMA"), 0)
        places = {c.type for c in chunks[: i - 1]} <= {"PREP", "NP", "OF", "ADVERB", "AND"}
        where = where and places and chunks[0].type == "PREP" and type_at(chunks, i - 1) == "COMMA"
        if where and type_at(chunks, comma + 1) in ("BE", "VERB"):  # 'behind it, where only staff may go, is a safe'
            return _without_asides([*chunks[: i - 1], *chunks[comma + 1 :]])
        comment = chunk.type == "REL" and after in ("VERB", "TVERB") and chunks[i + 1].value.lemma in _COMMENTING
        if type_at(chunks, i - 1) == "COMMA" and comment:  # '…, which made everyone laugh'
            return _without_asides([*chunks[: i - 1], *chunks[end_before(chunks, i + 2, _BREAKS) :]])
        if type_at(chunks, i - 1) != "COMMA" or not (manner or compared or so or searched):
            continue
        end = next((k for k in range(i + 2, len(chunks)) if chunks[k].type in ("COMMA", "CUT")), None)
        if end is not None and manner and type_at(chunks, i - 2) == "NOT":
            return _without_asides([*chunks[: i - 1], *chunks[end + 1 :]])
        if end is not None:
            return _without_asides([*chunks[: i - 1], *chunks[end:]])
    return chunks


def _without_insertions(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out what stands between dashes, from a noun phrase to its verb: *the goblets – three of them – are …*."""
    for i, chunk in enumerate(chunks):
        first = max((k + 1 for k in range(i) if chunks[k].type in JOINT_TYPES), default=0)
        subject = [c.type for c in chunks[first:i] if c.type != "ADVERB"]
        if chunk.type not in ("CUT", "COMMA") or subject not in (["NP"], ["NP", "OF", "NP"]):
            continue
        ones = type_at(chunks, i + 1) == "NP" and chunks[i + 1].value.pronoun == "one" and chunks[i + 1].value.plural
        if chunk.type == "COMMA" and ones:  # 'bags, small ones on top, large ones below, are stored …'
            end = next((k for k in range(i, len(chunks)) if chunks[k].type in FINITE), 0) - 1
            fits = type_at(chunks, end) == "COMMA" and not {"PUT", "SUB", "REL"} & {c.type for c in chunks[i:end]}
        else:
            end = next((k for k in range(i + 1, len(chunks)) if chunks[k].type == chunk.type), 0)
            counts = {"THERE"} if chunk.type == "COMMA" else FINITE | {"OF"}
            fits = type_at(chunks, end + 1) in FINITE and not counts.isdisjoint(c.type for c in chunks[i + 1 : end])
        if fits:
            return [*chunks[:i], *(emptied(c) for c in chunks[i : end + 1]), *chunks[end + 1 :]]
    return chunks


def _with_counted_labels(chunks: list[Chunk]) -> list[Chunk]:
    """Return *forks: two, left of the plate* as *two forks, left of the plate*."""
    if [type_at(chunks, k) for k in range(3)] != ["NP", "COLON", "NP"] or type_at(chunks, 3) not in _ENDS | {
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


def _with_verbs_of_one_person(chunks: list[Chunk]) -> list[Chunk]:
    """Return the second verb of *I stood the candle on it and poured water around it* as one in the past."""
    for i, chunk in enumerate(chunks):
        if chunk.type != "TPART" or type_at(chunks, i - 1) != "AND" or chunk.value.form != "past":
            continue
        first = max((k + 1 for k in range(i - 1) if chunks[k].type in JOINT_TYPES), default=0)
        spoken = type_at(chunks, first) == "NP" and chunks[first].value.pronoun in ("me", "we")
        if spoken and type_at(chunks, first + 1) in FINITE:
            chunks[i] = Chunk("TVERB", chunk.start, chunk.end, replace(chunk.value, past=True), chunk.span)
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
        if type_at(chunks, i - 2) not in JOINT_TYPES | {"", "ADVERB"} or type_at(chunks, i + 2) not in _PREDICATES:
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


def _names_thing(phrase: NounPhrase) -> bool:
    """Return True for a thing and not for its place: *a drawer at the front, in which …*."""
    return bool(phrase.head) and not is_place(phrase)


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
        if contact or (stranded and type_at(chunks, i + 3) in FINITE | _ENDS):
            found.append(put_in("REL", chunk))
        found.append(chunk)
    return found


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
    if not is_place(place) and (not holds or place.plural or last_word(thing.head) in VESSELS | HOLDERS | SURFACES):
        return chunks
    if any(chunk.type in FINITE for chunk in chunks[colon:]) or (is_place(place) and place.plural):
        return chunks
    word = "at" if is_place(place) else "in" if noun in VESSELS | HOLDERS else "on"
    relator = Relator(Preposition(word, {"in": "inside"}.get(word, word)))
    comma = Chunk("COMMA", chunks[colon].start, chunks[colon].end, None, chunks[colon].span)
    return [put_in("PREP", chunks[0], relator), *chunks[:colon], comma, *chunks[colon + 1 :]]


def _with_telegraphic_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks with a preposition before a bare place of a note: *plate centre*, *lamp: far left corner*."""
    at = Relator(Preposition("at", "at"))
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        ends = i + 1 == len(chunks) or chunks[i + 1].type in JOINT_TYPES | {"OF"}
        aside = (
            len(found) > 1 and found[-1].type == "COMMA" and found[-2].type == "NP"
            and type_at(chunks, i + 1) in _ENDS
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
                if chunks[k].type == "COMMA" and chunks[k + 1].type == "NP" and chunks[k + 2].type in _PREDICATES:
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


def _with_labels_apart(chunks: list[Chunk]) -> list[Chunk]:
    """End the clause of a note before what is said about a part: *rear left corner, lid closed*."""
    for i, chunk in enumerate(chunks):
        before = [c.type for c in chunks[:i] if c.type != "ADVERB"][-2:]
        beside = type_at(chunks, i + 1) == "NP" and before in (["PREP", "NP"], ["OF", "NP"])
        if chunk.type != "COMMA" or not beside:
            continue
        part = chunks[i + 1].value
        described = type_at(chunks, i + 2) in ("PART", "ADJP") and type_at(chunks, i + 3) in _ENDS
        verbless = not any(c.type in FINITE | {"PUT"} for c in chunks)
        other = not part.head and (part.pronoun == "one" or part.count is not None) and type_at(chunks, i + 2) == "PART"
        hangs = [type_at(chunks, i + k) for k in (2, 3, 4)] == ["PART", "PREP", "NP"] and type_at(
            chunks, i + 5
        ) in _ENDS
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


_RESTING = frozenset({"lay", "stand", "hang", "rest", "sit", "lean"})
"""Verbs that turn a clause round: *and behind that, in a row, stand your letters*."""
_SEATS = frozenset({"place", "pride", "spot", "position", "seat"})
_COMMENTING = frozenset({"make", "mean", "let", "allow", "cause", "give", "prevent", "explain", "save", "help", "seem"})
"""Verbs of *which* that comment on a whole clause."""
_MOVING = frozenset({"move", "shift", "transfer", "relocate", "return"})
_MIDDLES = frozenset({"centre", "center", "middle"})
_ENDEARMENTS = word_set(
    "darling dear dearest love sweetheart honey mum mom mummy mommy dad daddy gran grandma grandpa son daughter mate"
    " buddy guys folks everyone all team sir madam ladies gentlemen kids boys girls"
)
"""Nouns by which a person is spoken to."""


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
            _leave_out(chunks[i + (types[3] == "AND") : end], "this does not say which of the two is where")
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


_EXACTLY = frozenset({"just", "directly", "immediately", "right", "slightly"})


def _names_place(chunks: list[Chunk], at: int) -> bool:
    return type_at(chunks, at) == "NP" and is_place(chunks[at].value)


def _is_filled(chunks: list[Chunk]) -> bool:
    """Return True for chunks that end with a thing and what it is filled with."""
    with_phrase = [chunk.type for chunk in chunks[-3:]] == ["NP", "WITH", "NP"]
    return with_phrase and chunks[-2].value.preposition.phrase.endswith("filled with")


def _with_places_of_pairs(chunks: list[Chunk]) -> list[Chunk]:
    """Return the chunks of *with A on the left and B and C on the right* with the place after *B*, too."""
    types = [chunk.type for chunk in chunks]
    for i in range(3, len(chunks) - 5):
        pair = types[i : i + 6] == ["AND", "NP", "AND", "NP", "PREP", "NP"]
        place = ["WITH", "NP", "PREP", "NP"]
        if pair and (types[i - 4 : i] == place or types[max(0, i - 6) : i] == [*place, "OF", "NP"]):
            return [*chunks[: i + 2], *chunks[i + 4 : i + 6], *chunks[i + 2 :]]
    return chunks


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


_OF_TOOLS = frozenset({"handle", "blade", "tine", "prong", "bowl", "spout"})


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


_GAPS = frozenset({"gap", "space", "distance", "clearance"})
