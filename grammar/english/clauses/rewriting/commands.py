"""Rewrite participles, means and second verbs as commands of their own."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses.rewriting.editing import (
    BREAKS,
    ENDS,
    HANDS,
    Run,
    cut,
    emptied,
    end_before,
    leave_out,
    put_in,
    type_at,
    without,
    word_of,
)
from deixis.grammar.english.vocabulary.nouns import PARTS, SUBSTANCES, last_word
from deixis.grammar.english.vocabulary.relation_words import Preposition
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import NAMED_LIKE_THINGS, PLACING_VERBS, PUT_VERBS, verb_forms

_UNSURE = frozenset({"can", "could", "may", "might", "would"})
"""Modals of what need not be done."""

_UNCONDITIONAL = frozenset({"before", "after", "because", "as", "so"})
"""Conjunctions of clauses that are not conditions."""

_TIMES = word_set("before after while")
"""Conjunctions whose participle has the subject of the main clause, or the reader."""

_SERVING = word_set(
    "ensure allow help save keep simplify reduce minimize minimise protect improve free facilitate maximize maximise"
)
"""Verbs of what a placement is good for."""

_MEANS = (PLACING_VERBS | PUT_VERBS) - word_set("start finish turn top cover fill flank surround dot add press")
"""Verbs of means that say where their object comes to be: *by burying the roots in the soil*."""

_PARTICLES = frozenset({"in", "on", "up", "down", "back", "over", "out"})
"""Particles of verbs, after which their object or a place follows."""

_GATHERING = word_set("put place store stow stash file group keep")
"""Verbs after which *with* can be a place: *store the lids with the pots*."""

_GOOD = word_set(
    "good great best better ideal important helpful useful convenient safest easiest key essential perfect"
)


def _with_denied_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *never, I repeat never, set the lamp on it* with the command denied."""
    first = chunks[0] if chunks else None
    denies = first is not None and (first.type == "NOT" or first.value == "never") and type_at(chunks, 1) == "COMMA"
    for i, chunk in enumerate(chunks if denies else ()):
        if chunk.type in ("PUT", "DO"):
            return [*chunks[:i], replace(chunk, value=replace(chunk.value, positive=False)), *chunks[i + 1 :]]
    return chunks


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


def _with_participles_of_times(chunks: list[Chunk]) -> list[Chunk]:
    """Return *after covering the plate, put the lid on it* with a command: the things of the text do not cover it."""
    for i in range(len(chunks) - 2):
        group = chunks[i + 1].value
        timed = chunks[i].type == "SUB" and chunks[i].value in _TIMES and chunks[i + 1].type == "TPART"
        if timed and isinstance(group, VerbGroup) and group.form == "ing" and chunks[i + 2].type == "NP":
            places = group.lemma in PLACING_VERBS | PUT_VERBS
            chunks[i + 1] = replace(chunks[i + 1], type="PUT" if places else "DO", value=replace(group, form="base"))
    return chunks


def _second_verb(chunks: list[Chunk], at: int) -> Run | None:
    """Find the second verb of *she sits or kneels to the left of it*, which looks like a plural."""
    types = [type_at(chunks, at + k) for k in range(-1, 3)]
    if types not in (["VERB", "OR", "NP", "PREP"], ["VERB", "AND", "NP", "PREP"], ["VERB", "OR", "NP", "ADV"]):
        return None
    phrase = chunks[at + 1].value
    form = verb_forms().get(phrase.head) if phrase.plural and phrase.determiner is None else None
    is_posture = form is not None and form.form == "base" and form.kind in ("posture", "lean")
    return (at + 2, None) if is_posture and not phrase.adjectives and phrase.head not in NAMED_LIKE_THINGS else None


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
    verb = end_before(chunks, first + 2, FINITE | BREAKS)
    placed = any(chunk.type in ("PREP", "ADV") for chunk in chunks[first + 2 : verb])
    if not placed or type_at(chunks, verb) not in FINITE or not _approves(chunks, verb):
        return chunks
    end = end_before(chunks, verb, frozenset({"CUT"}))
    leave_out(chunks[verb:end], "what a step is good for does not say where something is")
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


def _with_means_as_commands(chunks: list[Chunk]) -> list[Chunk]:
    """Return *protect it by putting it in the box* and *by putting it there, you …* with a second command.

    A placement is a means only where its clause is neither under a condition, nor denied, nor past.
    """
    groups = [chunk.value for chunk in chunks if isinstance(chunk.value, VerbGroup)]
    is_asserted = not any(group.past or not group.positive or group.modal in _UNSURE for group in groups)
    limited = any(
        chunk.type in ("REL", "COMPLEMENT") or (chunk.type == "SUB" and chunk.value not in _UNCONDITIONAL)
        for chunk in chunks
    )
    if limited or not is_asserted:
        return chunks
    for at, chunk in enumerate(chunks[:-3]):
        named = chunk.type == "UNKNOWN" and chunk.value == "by" and chunk.end == chunk.start + 1
        group = chunks[at + 1].value if named and chunks[at + 1].type == "TPART" else None
        if not isinstance(group, VerbGroup) or group.form != "ing" or group.lemma not in _MEANS:
            continue
        end = end_before(chunks, at + 2, BREAKS)
        thing = chunks[at + 2].value if chunks[at + 2].type == "NP" else None
        place = at + 3 + 2 * ([type_at(chunks, at + k) for k in (3, 4)] == ["OF", "NP"])
        place += type_at(chunks, place) == "ADVERB"
        placed = place < end and type_at(chunks, place) in ("PREP", "ADV")
        if not placed or thing is None or last_word(thing.head) in HANDS:
            continue
        command = replace(chunks[at + 1], type="PUT", value=replace(group, form="base"))
        treated = chunks[at - 1].value if thing.pronoun == "it" and type_at(chunks, at - 1) == "NP" else None
        if treated is not None and not (treated.plural or treated.pronoun):  # 'boil the egg by placing it in …'
            chunks[at + 2] = replace(chunks[at + 2], value=replace(treated, determiner="the", count=None))
        ends = [cut(chunks[end])] if type_at(chunks, end) == "COMMA" else chunks[end : end + 1]
        return [*chunks[:at], cut(chunk), command, *chunks[at + 2 : end], *ends, *chunks[end + 1 :]]
    return chunks


def _accompaniment(chunks: list[Chunk], at: int) -> Run | None:
    """Find what tells the object of a command from others, before its goal: *slide the box with the lid onto it*.

    *Into* and *onto* go with the verb and never with the noun before them, so that the object moves, not what it has.
    """
    first = chunks[at]
    named = first.type == "WITH" or (first.type == "UNKNOWN" and first.value == "with")
    moved = at - 1
    while type_at(chunks, moved - 1) == "OF" and type_at(chunks, moved) == "NP":
        moved -= 2
    ordered = [type_at(chunks, moved - 1), type_at(chunks, moved)] == ["PUT", "NP"] and bool(chunks[moved].value.head)
    if not named or not ordered or type_at(chunks, at + 1) != "NP":
        return None
    end = at + 2
    while [type_at(chunks, end), type_at(chunks, end + 1)] == ["OF", "NP"]:
        end += 2
    if type_at(chunks, end) != "PREP" or word_of(chunks[end]) not in ("into", "onto"):
        return None
    leave_out(chunks[at:end], "'with' says which thing is meant, not where it is")
    return end, None


def _with_objects_after_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *place on the tray the cup* and *slide into the slot, the panel* with the object before its place."""
    for i in range(len(chunks) - 4):
        if [type_at(chunks, i + k) for k in range(4)] != ["PUT", "NP", "PREP", "NP"] or chunks[i + 1].value.head:
            continue
        place = i + 4
        while [type_at(chunks, place), type_at(chunks, place + 1)] == ["OF", "NP"]:
            place += 2
        thing = place + (type_at(chunks, place) == "COMMA")
        end = thing + 1
        while [type_at(chunks, end), type_at(chunks, end + 1)] == ["OF", "NP"]:
            end += 2
        whole = type_at(chunks, thing) == "NP" and type_at(chunks, end) in ENDS
        if not whole or word_of(chunks[i + 2]) == "in" or chunks[thing].value.determiner is None:
            continue  # 'put in a cup, a spoon and a knife'
        return [*chunks[: i + 1], *chunks[thing:end], *chunks[i + 2 : place], *chunks[end:]]
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


def _with_companions_as_places(chunks: list[Chunk]) -> list[Chunk]:
    """Return *store the lids with the pots, the cups with the mugs* as commands that put the first near the second.

    A command that puts a thing and names no other place needs *with* for it.
    """
    if [type_at(chunks, k) for k in range(3)] != ["PUT", "NP", "WITH"] or chunks[0].value.lemma not in _GATHERING:
        return chunks
    pairs, at = [], 1
    while [type_at(chunks, at + k) for k in range(3)] == ["NP", "WITH", "NP"]:
        pairs.append(chunks[at : at + 3])
        at += 4
        if type_at(chunks, at - 1) in ("CUT", ""):
            break
        at += type_at(chunks, at) == "AND"
    if not pairs or type_at(chunks, at - 1) not in ("CUT", "") or not all(_are_companions(p[0], p[2]) for p in pairs):
        return chunks
    found: list[Chunk] = []
    for thing, joint, other in pairs:
        command = put_in("PUT", thing)
        command.value = chunks[0].value
        near = Relator(Preposition("with", "near"))
        first = not found
        found += [chunks[0]] if first else [put_in("CUT", thing), command]
        found += [thing, replace(joint, type="PREP", value=near), other]
    return [*found, *chunks[at - 1 :]]


def _are_companions(thing: Chunk, other: Chunk) -> bool:
    """Return True for two things that can be kept together, and not for a thing with what belongs to it."""
    one, beside = thing.value, other.value
    known = beside.determiner in ("the", "this", "that", "these", "those") or beside.owner is not None
    both = beside.plural and one.plural and beside.determiner is None
    named = bool(beside.head) or beside.pronoun == "one"
    return named and (known or both) and not beside.members and last_word(beside.head) not in PARTS | SUBSTANCES | HANDS


def _with_aligned_parts(chunks: list[Chunk]) -> list[Chunk]:
    """Return *align the holes on the legs with the pegs* with a comma before *in line with*, which is of the holes."""
    for i, chunk in enumerate(chunks[:-4]):
        if chunk.type != "PUT" or chunk.value.lemma != "align" or type_at(chunks, i + 2) != "PREP":
            continue
        with_ = next((k for k in range(i + 3, end_before(chunks, i, BREAKS)) if chunks[k].type == "WITH"), 0)
        if with_ and type_at(chunks, with_ + 1) == "NP":
            beside = replace(chunks[with_], type="PREP", value=Relator(Preposition("in line with", "aligned")))
            return [*chunks[:with_], put_in("COMMA", chunks[with_]), beside, *chunks[with_ + 1 :]]
    return chunks


def _particle(chunks: list[Chunk], at: int) -> Run | None:
    """Find a particle of a verb before a place: *drop it in near the middle*, *put in two cups next to the jar*."""
    types = [type_at(chunks, at + k) for k in range(-2, 4)]
    if types[2] == "UNKNOWN" and chunks[at].value in _PARTICLES:
        moved = types[0] in ("PUT", "TPART", "TVERB") and types[1] == "NP" and types[3] in ("PREP", "ADV")
        return (at + 1, None) if moved else None
    if types[1:5] != ["PUT", "PREP", "NP", "PREP"] or word_of(chunks[at]) != "in":
        return None
    return (at + 1, None) if (chunks[at + 1].value.count or 1) > 1 else None


def _origin(chunks: list[Chunk], at: int) -> Run | None:
    """Find where a thing was before it is moved: *move the cup from the mat to the tray*."""
    types = [type_at(chunks, at + k) for k in range(-2, 3)]
    if types != ["PUT", "NP", "PREP", "NP", "PREP"] or word_of(chunks[at]) != "from":
        return None
    if word_of(chunks[at + 2]) not in ("to", "into", "onto"):
        return None
    leave_out(chunks[at : at + 2], "where a thing was before does not say where it is")
    return at + 2, None


def _with_wishes_as_statements(chunks: list[Chunk]) -> list[Chunk]:
    """Return *you want the lamp to be on the left* as *the lamp is on the left*: what the reader wants is advice."""
    if any(chunk.type == "SUB" for chunk in chunks):
        return chunks
    for i in range(len(chunks) - 4):
        types = [type_at(chunks, i + k) for k in range(4)]
        wished = types == ["CUT", "NP", "UNKNOWN", "BE"] and chunks[i].end - chunks[i].start > 1
        if wished and chunks[i + 2].value == "to" and type_at(chunks, i + 4) in ("PREP", "ADV"):
            being = replace(chunks[i + 3], value=VerbGroup("be", "be", "finite"))
            return [*chunks[: i + 2], emptied(chunks[i + 2]), being, *chunks[i + 4 :]]
    return chunks


REWRITES = (
    without(_particle), without(_origin), _with_wishes_as_statements, _with_companions_as_places, _with_aligned_parts,
    _with_denied_commands, _with_objects_after_places, without(_accompaniment), _with_participles_of_commands,
    _with_participles_of_times, without(_second_verb), _with_verbs_of_one_person, _with_means_as_commands,
    _with_placements_as_commands,
)  # fmt: skip
"""Rewritings of commands, in their order."""
