"""Leave out phrases beside the statement of a clause: what it is about, how it is done, for whom it is."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import COMMANDS, FINITE, JOINT_TYPES, Chunk, VerbGroup
from deixis.grammar.english.clauses.rewriting.editing import (
    BREAKS,
    ENDS,
    HANDS,
    Run,
    end_before,
    leave_out,
    type_at,
    unknown,
    without,
    word_of,
)
from deixis.grammar.english.tree import Degree
from deixis.grammar.english.vocabulary.function_words import PERSONS, UNITS
from deixis.grammar.english.vocabulary.nouns import GENERAL, last_word
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import FIND_VERBS, PLACING_VERBS, TRANSITIVE_RELATIONS, verb_forms

_SIZES = frozenset({"size", "height", "length", "width", "shape", "colour", "color", "thickness", "weight"})

_LENGTHS = UNITS.keys() - HANDS | {"inche", "square"}
"""Words of the measure of a thing."""

_COMMENTING = frozenset({"make", "mean", "let", "allow", "cause", "give", "prevent", "explain", "save", "help", "seem"})
"""Verbs of *which* that comment on a whole clause."""

_ABOVE_ALL = frozenset({"particularly", "especially", "mainly", "notably", "chiefly", "primarily"})
"""Adverbs before a circumstance in which a statement holds above all."""

_CASES = frozenset({"case", "event"})

_CAUSING = word_set("ensure allow let make cause enable help prevent avoid give create provide leave keep")
"""Verbs of a participle after a comma that tells what a step is good for: *…, ensuring the lid closes*."""

_PLACING = word_set("leave keep")
"""Such verbs that place a thing where a preposition follows their object: *…, leaving the lid on the tray*."""

_NAMING = frozenset({"know", "call", "refer", "name", "term", "dub"})
"""Verbs before another name of a thing."""

_OCCASIONS = word_set("time room space place reason need use search request call plan table seat")
"""Nouns with which *for* says more than what a thing is used for."""

_MAKING = frozenset({"make", "create", "form", "build"})

_LAYERS = word_set("layer bed row line ring circle pile heap mound stack border coat coating")
"""Nouns of what is made at its place."""

_USING = word_set("use need want like access reach handle")
"""Verbs of a person that tell things apart, and not where they are."""

_PLACES_OF_AIMS = word_set("on inside under above behind in_front beside next_to near at around between left right")
"""Relations after an infinitive of placing that are those of the thing before it."""

_DONE_BY_MEANS = word_set(
    "attach connect fix fasten secure join link tie bolt screw nail glue tape strap clip clamp pin hook tuck roll fold"
    " wrap cover spread pour lower raise lift pull push insert install mount suspend"
)
"""Verbs of actions after whose participles *by* names an agent or a tool."""

_STEMS = _CAUSING | {lemma.removesuffix("e") for lemma in _CAUSING}
"""Such verbs, and their stems before *-ing* where no table has the verb."""


def _prevented(chunks: list[Chunk], at: int) -> Run | None:
    """Find what is prevented: *to keep it from sliding on the counter*."""
    away = chunks[at].type in ("UNKNOWN", "PREP") and word_of(chunks[at]) == "from" and at > 0
    group = chunks[at + 1].value if away and type_at(chunks, at + 1) in ("TPART", "PART") else None
    if not isinstance(group, VerbGroup) or group.form != "ing" or chunks[at].end - chunks[at].start > 1:
        return None
    end = end_before(chunks, at + 1, BREAKS)
    leave_out(chunks[at:end], "what is prevented does not say where something is")
    return end, None


def _means(chunks: list[Chunk], at: int) -> Run | None:
    """Find the phrase that says how something is done and gives no place: *by keeping both hands on it*."""
    named = chunks[at].type == "UNKNOWN" and chunks[at].value == "by" and at > 0
    doing = type_at(chunks, at + 1) in ("TPART", "PART")
    group = chunks[at + 1].value if doing else None
    form = group.form if isinstance(group, VerbGroup) else ""
    if not (named and doing and form == "ing" and chunks[at].end == chunks[at].start + 1):
        return None
    end = end_before(chunks, at + 1, BREAKS)
    leave_out(chunks[at:end], "how something is done is not where it is")
    return end, None


def _beneficiary(chunks: list[Chunk], at: int) -> Run | None:
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


def _purpose(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a thing is for, between its name and its place: *the dishes for screws are behind the mat*."""
    types = [type_at(chunks, at + k) for k in range(-2, 3)]
    named = types[1:4] == ["NP", "PREP", "NP"] and types[0] in JOINT_TYPES | {"", "ADVERB"}
    placed = types[4] in FINITE | {"PREP", "ADV"}
    if not named or not placed or chunks[at].value.preposition.phrase != "for":
        return None
    thing, use = chunks[at - 1].value, chunks[at + 1].value
    if (
        not thing.head
        or not thing.known
        or thing.pronoun
        or not use.head
        or use.pronoun
        or last_word(thing.head) in _OCCASIONS
    ):
        return None
    leave_out(chunks[at : at + 2], "what a thing is for does not say where it is")
    return at + 2, None


def _free_place(chunks: list[Chunk], at: int) -> Run | None:
    """Find *where it (always) is*: what follows after the comma says where the thing is."""
    thing = type_at(chunks, at + 1) == "NP"
    there = (
        chunks[at].type == "REL" and thing and chunks[at + 1].value.pronoun in ("it", "they")
        and type_at(chunks, at + 2) == "BE" and type_at(chunks, at + 3) in ENDS
    )  # fmt: skip
    free = (
        chunks[at].type == "SUB" and chunks[at].value == "where" and type_at(chunks, at - 1) in ("BE", "VERB")
        and thing and type_at(chunks, at + 2) in FINITE
    )  # fmt: skip
    named = thing and chunks[at].value == "where" and bool(chunks[at + 1].value.head)
    aside = (
        chunks[at].type in ("SUB", "REL") and chunks[at].value in ("where", None) and thing and not there
        and (chunks[at + 1].value.pronoun in ("it", "they", "you") or named)
        and [type_at(chunks, at - k) for k in (2, 1)] == ["PUT", "NP"]
    )  # 'put it where it cannot fall, between the boxes'  # fmt: skip
    if not there and not free and not aside:
        return None
    end = end_before(chunks, at + 3, JOINT_TYPES)
    after = next((k for k in range(end + 1, len(chunks)) if chunks[k].type != "ADVERB"), len(chunks))
    if aside and [type_at(chunks, end), type_at(chunks, after)] != ["COMMA", "PREP"]:
        return None
    return end + ((free or aside) and type_at(chunks, end) in ("COMMA", "COLON")), None


def _search(chunks: list[Chunk], at: int) -> Run | None:
    """Find a command to look somewhere: *look behind the bandages*."""
    verb = chunks[at].value
    looks = (
        isinstance(verb, VerbGroup) and verb.lemma in ("look", "search", "check", "peek")
        and verb.form == "base" and type_at(chunks, at - 1) in JOINT_TYPES | {"", "ADVERB"}
        and type_at(chunks, at + 1) == "PREP"
        and chunks[at + 1].value.preposition.relation not in ("to", "at", "facing", "pointing", "from", "through")
    )  # fmt: skip
    return unknown(chunks, at, end_before(chunks, at, JOINT_TYPES)) if looks else None


def _sought_in_vain(chunks: list[Chunk], at: int) -> Run | None:
    """Find where someone looks for a thing that stands first: *the spoon you will look for in vain on the tray*."""
    person = chunks[at].type == "NP" and chunks[at].value.pronoun in PERSONS and type_at(chunks, at - 1) == "NP"
    verb = chunks[at + 1].value if person and type_at(chunks, at + 1) in FINITE else None
    looks = verb is not None and verb.lemma in ("look", "search", "hunt") and type_at(chunks, at + 2) == "UNKNOWN"
    return unknown(chunks, at, end_before(chunks, at, JOINT_TYPES)) if looks else None


def _caused(chunks: list[Chunk], at: int) -> Run | None:
    """Find what someone lets others do: *the owner had it moved*, which states the place of no thing."""
    if chunks[at].type != "NP" or type_at(chunks, at + 1) != "TVERB":
        return None
    types = [type_at(chunks, at + k) for k in range(4)]
    caused = types == ["NP", "TVERB", "NP", "PART"] and chunks[at + 1].value.lemma in ("have", "get")
    if not caused or type_at(chunks, at + 4) not in JOINT_TYPES | {""} or not chunks[at].value.head:
        return None
    return unknown(chunks, at, at + 4) if chunks[at + 2].value.pronoun in ("it", "they") else None


def _intended_place(chunks: list[Chunk], at: int) -> Run | None:
    """Find the infinitive before the place that a thing is meant for: *a rug to put under the table*."""
    named = at > 0 and chunks[at - 1].type == "NP" and bool(chunks[at - 1].value.head)
    if not named or [type_at(chunks, at + k) for k in range(4)] != ["UNKNOWN", "UNKNOWN", "PREP", "NP"]:
        return None
    verb = next((k for k in range(at - 1, 0, -1) if chunks[k].type in FINITE), 0)
    planned = verb and chunks[verb - 1].type == "NP" and chunks[verb - 1].value.pronoun in PERSONS - {"you"}
    said = chunks[at].value == "to" and chunks[at + 1].value in PLACING_VERBS and not planned  # 'I have cups to put …'
    return (at + 2, None) if said and chunks[at + 2].value.preposition.relation in _PLACES_OF_AIMS else None


def _infinitive(chunks: list[Chunk], at: int) -> Run | None:
    """Find an infinitive with what belongs to it: *the bottle is too tall to stand on the shelf*."""
    chunk = chunks[at]
    to = chunk.type == "UNKNOWN" and chunk.value == "to" and type_at(chunks, at + 1) in ("UNKNOWN", "VERB", "TVERB")
    end = end_before(chunks, at, JOINT_TYPES | {"REL"})
    while to and [type_at(chunks, end + k) for k in (-1, 0, 1)] == ["NP", "OR", "NP"] and _is_bare(chunks[end + 1]):
        end = end_before(chunks, end + 1, JOINT_TYPES | {"REL"})  # 'to spread jam or butter on bread'
    return unknown(chunks, at, end) if to else None


def _is_bare(chunk: Chunk) -> bool:
    """Return True for a noun phrase without an article, an owner and a number."""
    phrase = chunk.value
    return bool(phrase.head) and phrase.determiner is None and phrase.owner is None and phrase.count is None


def _depicted(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a picture *is of*: *the painting is of a boat under a bridge*."""
    shown = chunks[at].type == "OF" and type_at(chunks, at - 1) == "BE" and type_at(chunks, at + 1) == "NP"
    return unknown(chunks, at, end_before(chunks, at, JOINT_TYPES)) if shown else None


def _apposition_of_object(chunks: list[Chunk], at: int) -> Run | None:
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


def _relative_aside(chunks: list[Chunk], at: int) -> Run | None:
    """Find a relative clause after a comma whose verb says no place: *the candle, which represents fire, is …*."""
    verb = next((k for k in range(at + 2, len(chunks)) if chunks[k].type != "ADVERB"), len(chunks))
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at + 1) != "REL" or verb == len(chunks):
        return None
    end = end_before(chunks, verb + 1, BREAKS)
    goes_on = type_at(chunks, end) == "COMMA" and type_at(chunks, end + 1) in FINITE
    lost = chunks[verb].type == "NP" and goes_on and end == verb + 1 and chunks[verb].value.determiner is None
    group = chunks[verb].value if chunks[verb].type in ("VERB", "TVERB") else None
    says_nothing = group is not None and group.kind in ("other", "unknown") and group.lemma not in TRANSITIVE_RELATIONS
    if not (lost or says_nothing):
        return None
    leave_out(chunks[at + 1 : end], "this clause does not say where something is")
    return end + 1 if goes_on else end, None


def _restriction_of_object(chunks: list[Chunk], at: int) -> Run | None:
    """Find which things a command is about, before their place: *put the fruits that spoil quickly on the shelf*.

    The clause can have a subject of its own: *put the napkin that you folded on the plate*.
    """
    if [type_at(chunks, k) for k in (at - 2, at - 1)] != ["PUT", "NP"]:
        return None
    at -= type_at(chunks, at) == "NP"  # 'put the napkin you folded on the plate'
    by_person = type_at(chunks, at + 1) == "NP" and chunks[at + 1].value.pronoun in PERSONS
    if type_at(chunks, at) != "REL" and not by_person:
        return None
    at += by_person
    verb = chunks[at + 1] if type_at(chunks, at + 1) == "VERB" else None
    group = verb.value if verb is not None else None
    placeless = isinstance(group, VerbGroup) and group.kind in ("other", "unknown", "transitive")
    if not isinstance(group, VerbGroup) or group.lemma in PLACING_VERBS | FIND_VERBS:
        return None
    if not by_person and (not placeless or group.lemma in TRANSITIVE_RELATIONS):
        return None
    end = next((k for k in range(at + 2, len(chunks)) if chunks[k].type != "ADVERB"), len(chunks))
    return (end, None) if type_at(chunks, end) in ("PREP", "ADV") else None


def _measures_apart(chunks: list[Chunk], at: int) -> Run | None:
    """Find how large the subject is, between commas: *a small tray, about a foot square, stands …*."""
    if at != 1 or type_at(chunks, 0) != "NP" or type_at(chunks, at) != "COMMA":
        return None
    end = end_before(chunks, at + 1, BREAKS)
    inner = [chunk for chunk in chunks[at + 1 : end] if chunk.type != "ADVERB"]
    sizes = {chunk.type for chunk in inner} <= {"NP", "ADJP", "AND", "MEASURE"} and bool(inner)
    if not sizes or type_at(chunks, end) != "COMMA" or type_at(chunks, end + 1) not in FINITE:
        return None
    has_length = all(not _LENGTHS.isdisjoint(c.value.head.split()) for c in inner if c.type == "NP")
    if not has_length:
        return None
    leave_out(chunks[at + 1 : end], "a measure without 'is' is not read here")
    return end + 1, None


def _posture_of_the_person(chunks: list[Chunk], at: int) -> Run | None:
    """Find how the person is who has things somewhere: *sitting at the desk I have the lamp on my left*."""
    sits = at == 0 and chunks[0].type == "PART" and chunks[0].value.form == "ing" and chunks[0].value.kind == "posture"
    end = end_before(chunks, 1, frozenset({"NP"}))
    while type_at(chunks, end) == "NP" and type_at(chunks, end + 1) in ("OF", "PREP"):
        end += 2
    after = end + 1 + (type_at(chunks, end + 1) == "COMMA")
    person = type_at(chunks, after) == "NP" and chunks[after].value.pronoun in PERSONS and not chunks[after].value.head
    return (after, None) if sits and person and type_at(chunks, 1) == "PREP" else None


def _comparison_of_size(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a thing is compared with: *a globe the size of a pumpkin*."""
    compared = [type_at(chunks, at + k) for k in (-1, 0, 1, 2)] == ["NP", "NP", "OF", "NP"]
    sized = compared and chunks[at].value.determiner == "the" and chunks[at].value.head in _SIZES
    return (at + 3, None) if sized else None


def _without_comments(chunks: list[Chunk]) -> list[Chunk]:
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
            return _without_comments([*chunks[: i - 1], *chunks[comma + 1 :]])
        comment = chunk.type == "REL" and after in ("VERB", "TVERB") and chunks[i + 1].value.lemma in _COMMENTING
        if type_at(chunks, i - 1) == "COMMA" and comment:  # '…, which made everyone laugh'
            return _without_comments([*chunks[: i - 1], *chunks[end_before(chunks, i + 2, BREAKS) :]])
        if type_at(chunks, i - 1) != "COMMA" or not (manner or compared or so or searched):
            continue
        end = next((k for k in range(i + 2, len(chunks)) if chunks[k].type in ("COMMA", "CUT")), None)
        if end is not None and manner and type_at(chunks, i - 2) == "NOT":
            return _without_comments([*chunks[: i - 1], *chunks[end + 1 :]])
        if end is not None:
            return _without_comments([*chunks[: i - 1], *chunks[end:]])
    return chunks


def _framing(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a sentence is about: *in the case of small jars, …*, *broadly speaking, …*."""
    if any(chunk.type != "ADVERB" for chunk in chunks[:at]):
        return None
    types = [type_at(chunks, at + k) for k in range(5)]
    if types[:2] == ["UNKNOWN", "COMMA"] and chunks[at].value == "speaking" and at:
        return at + 2, None
    doing = types[0] == "UNKNOWN" and types[1] in ("TPART", "PART") and chunks[at].value in ("in", "by")
    end = end_before(chunks, at + 1, BREAKS) if doing else at
    if doing and type_at(chunks, end) == "COMMA" and chunks[at + 1].value.form == "ing":
        leave_out(chunks[at:end], "how something is done is not where it is")
        return end + 1, None
    case = types == ["PREP", "NP", "OF", "NP", "COMMA"] and chunks[at].value.preposition.relation == "inside"
    clause = case and any(chunk.type in FINITE | COMMANDS for chunk in chunks[at + 5 :])
    if not clause or chunks[at + 1].value.head not in _CASES or chunks[at + 1].value.adjectives:
        return None
    leave_out(chunks[at : at + 4], "this says what the sentence is about, not where something is")
    return at + 5, None


def _manner(chunks: list[Chunk], at: int) -> Run | None:
    """Find a participle between commas before a command: *and, working clockwise, lay the knives …*."""
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at - 1) not in ("AND", "THEN"):
        return None
    end = end_before(chunks, at + 1, JOINT_TYPES)
    inside = chunks[at + 1 : end]
    if type_at(chunks, end) != "COMMA" or type_at(chunks, end + 1) not in COMMANDS or not inside:
        return None
    first = inside[0].value
    word = first.head.partition(" ")[0] if inside[0].type == "NP" and first.determiner is None else ""
    participle = isinstance(first, VerbGroup) and first.form == "ing"
    if not (participle or word.endswith("ing")):
        return None
    leave_out(inside, "how something is done is not where it is")
    return end + 1, None


def _consequence(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a step is good for: *put the cloth on the tray, ensuring the edges hang down*."""
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at + 1) not in ("PART", "TPART") or not at:
        return None
    group = chunks[at + 1].value
    if not isinstance(group, VerbGroup) or group.form != "ing" or group.lemma.removesuffix("ing") not in _STEMS:
        return None
    end = end_before(chunks, at + 1, BREAKS)
    places = any(chunk.type in ("PREP", "ADV") for chunk in chunks[at + 2 : end])
    if not FINITE.isdisjoint(chunk.type for chunk in chunks[at + 2 : end]):
        places = False
    if places and group.lemma in _PLACING:
        return None
    leave_out(chunks[at + 1 : end], "what a step is good for does not say where something is")
    return end, None


def _compared_quality(chunks: list[Chunk], at: int) -> Run | None:
    """Find a comparison of a quality that has no place: *and lower in pitch than the bell*."""
    types = [type_at(chunks, at + k) for k in range(5)]
    if types[:3] != ["ADJP", "PREP", "NP"] or chunks[at].value[-1].degree is not Degree.COMPARATIVE:
        return None
    quality = chunks[at + 2].value
    bare = quality.determiner is None and quality.owner is None and bool(quality.head) and not quality.plural
    if not bare or chunks[at + 1].value.preposition.phrase != "in" or types[3] not in ("THAN", *JOINT_TYPES, ""):
        return None
    end = at + 3 + 2 * (types[3:] == ["THAN", "NP"])
    leave_out(chunks[at:end], "a comparison of a quality does not say where something is")
    return end, None


def _examples(chunks: list[Chunk], at: int) -> Run | None:
    """Find examples of the things before: *small tools, such as files and awls, …*, *tins including cans …*."""
    apart = type_at(chunks, at) == "COMMA"
    first = at + apart
    before = chunks[at - 1] if at else None
    group = chunks[first].value if type_at(chunks, first) == "TPART" else None
    including = isinstance(group, VerbGroup) and group.lemma == "include" and group.form == "ing"
    if before is None or before.type != "NP" or not (including or type_at(chunks, first) == "PREP"):
        return None
    word = "such as" if including else chunks[first].value.preposition.phrase
    if not before.value.plural and not (word == "such as" and (apart or including)):
        return None
    general = last_word(before.value.head) in GENERAL
    named = type_at(chunks, at - 2) in COMMANDS | {"AND", "COMMA"} and type_at(chunks, 0) in COMMANDS
    bare = type_at(chunks, first + 1) == "NP" and chunks[first + 1].value.determiner is None
    general = general or (named and bare and before.value.determiner is None and type_at(chunks, first + 2) == "PREP")
    if word != "such as" and not (word == "like" and (general or (apart and type_at(chunks, 0) in COMMANDS))):
        return None
    end, last = first + 1, 0
    while type_at(chunks, end) == "NP":
        end += 1
        while [type_at(chunks, end), type_at(chunks, end + 1)] == ["OF", "NP"]:
            end += 2
        last = end
        while type_at(chunks, end) in ("COMMA", "AND", "OR"):
            end += 1
    if not last or any(chunk.type == "NP" and chunk.value.pronoun for chunk in chunks[first:last]):
        return None
    last = _end_of_list(chunks, first, last)
    closed = apart and type_at(chunks, last) == "COMMA" and type_at(chunks, last + 1) not in COMMANDS | {"AND"}
    leave_out(chunks[first:last], "examples say what the things before can be")
    return last + closed, None


def _comparison_apart(chunks: list[Chunk], at: int) -> Run | None:
    """Find a comparison between commas that has no thing of its own: *the menu, such as often seen in cafés, …*."""
    words = [c.value for c in chunks[at + 1 : at + 3] if c.type == "UNKNOWN"]
    if type_at(chunks, at) != "COMMA" or words != ["such", "as"]:
        return None
    end = next((k for k in range(at + 3, len(chunks)) if chunks[k].type == "COMMA"), None)
    if end is None:
        return None
    leave_out(chunks[at + 1 : end], "a comparison does not say where something is")
    return end + 1, None


def _emphasis(chunks: list[Chunk], at: int) -> Run | None:
    """Find where something holds above all, at the end of a clause: *…, particularly in large rooms*."""
    emphasized = type_at(chunks, at) == "ADVERB" and chunks[at].value in _ABOVE_ALL
    if not emphasized or [type_at(chunks, at + k) for k in (-1, 1, 2)] not in (
        ["COMMA", "PREP", "NP"], ["CUT", "PREP", "NP"],
    ):  # fmt: skip
        return None
    if type_at(chunks, at + 3) not in ("", "CUT") or chunks[at + 2].value.determiner is not None:
        return None
    leave_out(chunks[at : at + 3], "where something holds above all does not say where it is")
    return at + 3, None


def _first_of_two_commands(chunks: list[Chunk], at: int) -> Run | None:
    """Find the first of two verbs with one object, which looks like a noun: *and pull and fold the corners …*."""
    types = [type_at(chunks, at + k) for k in range(-1, 4)]
    if types[1:3] not in (["NP", "AND"], ["NP", "OR"]) or types[3] not in ("PUT", "DO") or types[4] != "NP":
        return None
    phrase = chunks[at].value
    bare = phrase.determiner is None and phrase.owner is None and phrase.count is None and not phrase.adjectives
    form = verb_forms().get(phrase.head) if bare and not phrase.plural else None
    begins = types[0] in ("", "ADVERB", "AND", "THEN", "CUT") and (types[0] == "" or _commands_before(chunks, at))
    return (at + 2, None) if begins and form is not None and form.form == "base" else None


def _commands_before(chunks: list[Chunk], at: int) -> bool:
    """Return True after a command whose place ends with a noun, so that a noun after *and* would be another place."""
    return any(chunk.type in COMMANDS for chunk in chunks[:at]) and type_at(chunks, at - 2) == "COMMA"


def _end_of_list(chunks: list[Chunk], first: int, last: int) -> int:
    """Return the end of a list of which the last noun is not the subject of a verb: *such as awls, and files lie …*."""
    joints = [k for k in range(first, last) if chunks[k].type in ("COMMA", "AND", "OR")]
    if joints and type_at(chunks, last) in FINITE:
        closing = [k for k in joints if chunks[k].type == "COMMA"]
        return next((k for k in closing if chunks[k + 1].type != "AND"), joints[-1]) if closing else last
    return last


def _used_things(chunks: list[Chunk], at: int) -> Run | None:
    """Find which things a command is about, by their use: *put the tools that you use the most in the drawer*."""
    command = [type_at(chunks, at + k) for k in (-2, -1, 0, 1)] == ["PUT", "NP", "REL", "NP"]
    group = chunks[at + 2].value if command and at + 2 < len(chunks) else None
    if not isinstance(group, VerbGroup) or group.lemma not in _USING or chunks[at + 1].value.pronoun not in PERSONS:
        return None
    end = at + 3
    while type_at(chunks, end) == "ADVERB" or (type_at(chunks, end) == "NP" and _is_degree(chunks[end])):
        end += 1
    if type_at(chunks, end) not in ("PREP", "ADV"):
        return None
    leave_out(chunks[at:end], "this says which things are meant")
    return end, None


def _is_degree(chunk: Chunk) -> bool:
    """Return True for *the most* and *least*, which look like noun phrases."""
    phrase = chunk.value
    return not phrase.head and not phrase.pronoun and (phrase.determiner in ("most", "the") or bool(phrase.adjectives))


def _followers(chunks: list[Chunk], at: int) -> Run | None:
    """Find a comma in a list of what follows a thing: *the king, followed by the queen, bishop and rook*."""
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at - 1) != "NP":
        return None
    first = at - 1
    while first > 1 and type_at(chunks, first - 1) in ("COMMA", "AND") and type_at(chunks, first - 2) in ("NP", "AND"):
        first -= 1 + (type_at(chunks, first - 1) in ("COMMA", "AND"))
    led = type_at(chunks, first - 1) == "PREP" and type_at(chunks, first - 2) == "PART"
    follows = led and chunks[first - 2].value.lemma == "follow"
    end = at + 1 + (type_at(chunks, at + 1) == "AND")
    ends = type_at(chunks, end) == "NP" and type_at(chunks, end + 1) in ("COMMA", "AND", "CUT", "")
    if not follows or not ends:
        return None
    return end, replace(chunks[at], type="AND", value="and")


def _agent(chunks: list[Chunk], at: int) -> Run | None:
    """Find by whom or by what something is done: *it is fixed to the frame by a bolt*, but not *placed by the door*."""
    by = chunks[at].type == "PREP" and chunks[at].value.preposition.phrase == "by"
    if not by or type_at(chunks, at + 1) != "NP":
        return None
    first = max((k + 1 for k in range(at) if chunks[k].type in JOINT_TYPES), default=0)
    verbs = [chunk.value for chunk in chunks[first:at] if chunk.type in FINITE | {"PART", "TPART", "PUT"}]
    done = bool(verbs) and isinstance(verbs[-1], VerbGroup) and verbs[-1].form in ("past", "participle")
    placed = type_at(chunks, at - 1) in ("NP", "ADV") and done and verbs[-1].lemma in _DONE_BY_MEANS
    if not placed or not any(chunk.type == "PREP" for chunk in chunks[first:at]):
        return None
    end = at + 2
    while [type_at(chunks, end), type_at(chunks, end + 1)] == ["OF", "NP"]:
        end += 2
    leave_out(chunks[at:end], "by whom or by what something is done is not where it is")
    return end, None


def _base(group: VerbGroup) -> str:
    """Return the plain form of a participle, also of a verb that the tables lack: *refer* of *referred*."""
    return group.lemma.removesuffix("red") if group.lemma.endswith("rred") else group.lemma.removesuffix("ed")


def _naming(chunks: list[Chunk], at: int) -> Run | None:
    """Find another name of a thing: *a large plate, known as a charger, …*, *a plate called a side plate …*.

    *It is known as a charger and* goes before another verb.
    """
    apart = type_at(chunks, at) == "COMMA"
    said = type_at(chunks, at) == "BE"
    first = at + (apart or said)
    follows = type_at(chunks, at - 1) == "NP" or (said and type_at(chunks, at - 1) == "COMMA")
    if not follows or type_at(chunks, first) not in ("PART", "TPART"):
        return None
    group = chunks[first].value
    if not isinstance(group, VerbGroup) or _base(group) not in _NAMING or group.form == "ing":
        return None
    named = first + 1
    while type_at(chunks, named) in ("PREP", "UNKNOWN", "ADVERB") and named < first + 3:
        named += 1
    if type_at(chunks, named) != "NP" or (named > first + 1) != (_base(group) in ("know", "refer")):
        return None
    if said and not (type_at(chunks, named + 1) == "AND" and type_at(chunks, named + 2) in FINITE):
        return None
    leave_out(chunks[first : named + 1], "another name of a thing does not say where it is")
    return named + 1 + said + (apart and type_at(chunks, named + 1) == "COMMA"), None


def _omission(chunks: list[Chunk], at: int) -> Run | None:
    """Find what is not done: *slide the poles in without attaching them to the base*."""
    named = chunks[at].type == "UNKNOWN" and chunks[at].value == "without" and at > 0
    group = chunks[at + 1].value if named and type_at(chunks, at + 1) in ("TPART", "PART") else None
    if not isinstance(group, VerbGroup) or group.form != "ing":
        return None
    end = end_before(chunks, at + 1, BREAKS)
    leave_out(chunks[at:end], "what is not done does not say where something is")
    return end, None


def _layer(chunks: list[Chunk], at: int) -> Run | None:
    """Find a command to make a layer or a group somewhere, which is put there: *make a thin layer on the gravel*."""
    types = [type_at(chunks, at + k) for k in range(3)]
    group = chunks[at].value
    made = types[:2] in (["DO", "NP"], ["PUT", "NP"]) and isinstance(group, VerbGroup) and group.lemma in _MAKING
    end = at + 2 + 2 * ([type_at(chunks, at + k) for k in (2, 3)] == ["OF", "NP"])
    if not made or last_word(chunks[at + 1].value.head) not in _LAYERS or type_at(chunks, end) != "PREP":
        return None
    put = replace(group, lemma="put", kind="posture")
    return at + 1, replace(chunks[at], type="PUT", value=put)


def _replacement(chunks: list[Chunk], at: int) -> Run | None:
    """Find a command to put something back: *replace the lid on the jar*, but not *replace the cup with a glass*."""
    group = chunks[at].value
    back = chunks[at].type == "DO" and isinstance(group, VerbGroup) and group.lemma == "replace"
    if not back or [type_at(chunks, at + k) for k in (1, 2, 3)] != ["NP", "PREP", "NP"]:
        return None
    if chunks[at + 2].value.preposition.relation not in ("on", "inside", "under", "above", "behind"):
        return None
    return at + 1, replace(chunks[at], type="PUT", value=replace(group, lemma="put", kind="posture"))


def _serving(chunks: list[Chunk], at: int) -> Run | None:
    """Find a command to serve something somewhere, which puts it there: *serve the sauce on the left of the rice*."""
    group = chunks[at].value
    serves = chunks[at].type == "DO" and isinstance(group, VerbGroup) and group.lemma == "serve"
    if not serves or type_at(chunks, at + 1) != "NP":
        return None
    end = at + 2
    while type_at(chunks, end) in ("AND", "OR", "COMMA", "OF") and type_at(chunks, end + 1) == "NP":
        end += 2
    here = type_at(chunks, end) == "PREP" and chunks[end].value.preposition.relation in _SERVED
    fronted = type_at(chunks, at - 1) == "COMMA" and chunks[0].type == "PREP" and type_at(chunks, end) in ENDS
    if not here and not fronted:
        return None
    return at + 1, replace(chunks[at], type="PUT", value=replace(group, lemma="put", kind="posture"))


_SERVED = frozenset({"on", "inside", "left", "right", "in_front", "behind", "next_to", "near", "above", "below"})
"""Relations that tell where something is served."""

REWRITES = (
    without(_framing), without(_manner), without(_consequence), without(_compared_quality), without(_examples),
    without(_comparison_apart), without(_emphasis),
    without(_first_of_two_commands), without(_used_things), without(_followers),
    without(_agent), without(_naming), without(_omission), without(_layer), without(_replacement), without(_serving),
    without(_means), without(_prevented), without(_relative_aside), without(_restriction_of_object),
    without(_measures_apart), without(_beneficiary), without(_purpose), without(_free_place), _without_comments,
    without(_search), without(_intended_place),
    without(_infinitive), without(_caused), without(_sought_in_vain), without(_depicted),
    without(_comparison_of_size), without(_posture_of_the_person), without(_apposition_of_object),
)  # fmt: skip
"""Rewritings that leave out what tells no place, in their order; most report it."""
