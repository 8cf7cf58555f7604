"""Find phrases beside the statement of a clause: what it is about, how it is done, what follows, what is compared."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, VerbGroup
from deixis.grammar.english.clauses.built import misunderstood
from deixis.grammar.english.clauses.editing import end_before, type_at
from deixis.grammar.english.tree import Degree
from deixis.grammar.english.vocabulary.function_words import PERSONS
from deixis.grammar.english.vocabulary.nouns import GENERAL, last_word
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import verb_forms

Run = tuple[int, Chunk | None]
"""End of a run of chunks, and the chunk that is put in its place, if any."""

_CASES = frozenset({"case", "event"})
_COMMANDS = frozenset({"PUT", "DO", "FIND", "GO"})
_BREAKS = frozenset({"COMMA", "CUT", "BUT"})
_CAUSING = word_set("ensure allow let make cause enable help prevent avoid give create provide leave keep")
"""Verbs of a participle after a comma that tells what a step is good for: *…, ensuring the lid closes*."""
_PLACING = word_set("leave keep")
"""Such verbs that place a thing where a preposition follows their object: *…, leaving the lid on the tray*."""


def framing(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a sentence is about: *in the case of small jars, …*, *broadly speaking, …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index at which the phrase may begin.

    Returns
    -------
    tuple or None
        End of the phrase with its comma, and None; None if no such phrase begins here.
    """
    if any(chunk.type != "ADVERB" for chunk in chunks[:at]):
        return None
    types = [type_at(chunks, at + k) for k in range(5)]
    if types[:2] == ["UNKNOWN", "COMMA"] and chunks[at].value == "speaking" and at:
        return at + 2, None
    doing = types[0] == "UNKNOWN" and types[1] in ("TPART", "PART") and chunks[at].value in ("in", "by")
    end = end_before(chunks, at + 1, _BREAKS) if doing else at
    if doing and type_at(chunks, end) == "COMMA" and chunks[at + 1].value.form == "ing":
        _leave_out(chunks[at:end], "how something is done is not where it is")
        return end + 1, None
    case = types == ["PREP", "NP", "OF", "NP", "COMMA"] and chunks[at].value.preposition.relation == "inside"
    clause = case and any(chunk.type in FINITE | _COMMANDS for chunk in chunks[at + 5 :])
    if not clause or chunks[at + 1].value.head not in _CASES or chunks[at + 1].value.adjectives:
        return None
    _leave_out(chunks[at : at + 4], "this says what the sentence is about, not where something is")
    return at + 5, None


def manner(chunks: list[Chunk], at: int) -> Run | None:
    """Find a participle between commas before a command: *and, working clockwise, lay the knives …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index at which the phrase may begin.

    Returns
    -------
    tuple or None
        End of the phrase with its commas, and None; None if no such phrase begins here.
    """
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at - 1) not in ("AND", "THEN"):
        return None
    end = end_before(chunks, at + 1, JOINT_TYPES)
    inside = chunks[at + 1 : end]
    if type_at(chunks, end) != "COMMA" or type_at(chunks, end + 1) not in _COMMANDS or not inside:
        return None
    first = inside[0].value
    word = first.head.partition(" ")[0] if inside[0].type == "NP" and first.determiner is None else ""
    participle = isinstance(first, VerbGroup) and first.form == "ing"
    if not (participle or word.endswith("ing")):
        return None
    _leave_out(inside, "how something is done is not where it is")
    return end + 1, None


def consequence(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a step is good for: *put the cloth on the tray, ensuring the edges hang down*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the comma before the phrase.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None if no such phrase begins here.
    """
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at + 1) not in ("PART", "TPART") or not at:
        return None
    group = chunks[at + 1].value
    if not isinstance(group, VerbGroup) or group.form != "ing" or group.lemma.removesuffix("ing") not in _STEMS:
        return None
    end = end_before(chunks, at + 1, _BREAKS)
    places = any(chunk.type in ("PREP", "ADV") for chunk in chunks[at + 2 : end])
    if not FINITE.isdisjoint(chunk.type for chunk in chunks[at + 2 : end]):
        places = False
    if places and group.lemma in _PLACING:
        return None
    _leave_out(chunks[at + 1 : end], "what a step is good for does not say where something is")
    return end, None


def compared_quality(chunks: list[Chunk], at: int) -> Run | None:
    """Find a comparison of a quality that has no place: *and lower in pitch than the bell*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the adjective.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None if no such phrase begins here.
    """
    types = [type_at(chunks, at + k) for k in range(5)]
    if types[:3] != ["ADJP", "PREP", "NP"] or chunks[at].value[-1].degree is not Degree.COMPARATIVE:
        return None
    quality = chunks[at + 2].value
    bare = quality.determiner is None and quality.owner is None and bool(quality.head) and not quality.plural
    if not bare or chunks[at + 1].value.preposition.phrase != "in" or types[3] not in ("THAN", *JOINT_TYPES, ""):
        return None
    end = at + 3 + 2 * (types[3:] == ["THAN", "NP"])
    _leave_out(chunks[at:end], "a comparison of a quality does not say where something is")
    return end, None


def examples(chunks: list[Chunk], at: int) -> Run | None:
    """Find examples of the things before: *small tools, such as files and awls, …*, *tins including cans …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the preposition, or of the comma before it.

    Returns
    -------
    tuple or None
        End of the phrase, with the comma after one in commas, and None; None if no such phrase begins here.
    """
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
    if word != "such as" and not (word == "like" and (general or (apart and type_at(chunks, 0) in _COMMANDS))):
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
    closed = apart and type_at(chunks, last) == "COMMA" and type_at(chunks, last + 1) not in _COMMANDS | {"AND"}
    _leave_out(chunks[first:last], "examples say what the things before can be")
    return last + closed, None


def first_of_two_commands(chunks: list[Chunk], at: int) -> Run | None:
    """Find the first of two verbs with one object, which looks like a noun: *and pull and fold the corners …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the verb.

    Returns
    -------
    tuple or None
        End of the verb with its conjunction, and None; None if no such verb stands here.
    """
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
    return any(chunk.type in _COMMANDS for chunk in chunks[:at]) and type_at(chunks, at - 2) == "COMMA"


def _end_of_list(chunks: list[Chunk], first: int, last: int) -> int:
    """Return the end of a list of which the last noun is not the subject of a verb: *such as awls, and files lie …*."""
    joints = [k for k in range(first, last) if chunks[k].type in ("COMMA", "AND", "OR")]
    if joints and type_at(chunks, last) in FINITE:
        closing = [k for k in joints if chunks[k].type == "COMMA"]
        return next((k for k in closing if chunks[k + 1].type != "AND"), joints[-1]) if closing else last
    return last


def used_things(chunks: list[Chunk], at: int) -> Run | None:
    """Find which things a command is about, by their use: *put the tools that you use the most in the drawer*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the relative pronoun.

    Returns
    -------
    tuple or None
        End of the relative clause before the place, and None; None for another clause.
    """
    command = [type_at(chunks, at + k) for k in (-2, -1, 0, 1)] == ["PUT", "NP", "REL", "NP"]
    group = chunks[at + 2].value if command and at + 2 < len(chunks) else None
    if not isinstance(group, VerbGroup) or group.lemma not in _USING or chunks[at + 1].value.pronoun not in PERSONS:
        return None
    end = at + 3
    while type_at(chunks, end) == "ADVERB" or (type_at(chunks, end) == "NP" and _is_degree(chunks[end])):
        end += 1
    if type_at(chunks, end) not in ("PREP", "ADV"):
        return None
    _leave_out(chunks[at:end], "this says which things are meant")
    return end, None


def _is_degree(chunk: Chunk) -> bool:
    """Return True for *the most* and *least*, which look like noun phrases."""
    phrase = chunk.value
    return not phrase.head and not phrase.pronoun and (phrase.determiner in ("most", "the") or bool(phrase.adjectives))


def followers(chunks: list[Chunk], at: int) -> Run | None:
    """Find a comma in a list of what follows a thing: *the king, followed by the queen, bishop and rook*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the comma.

    Returns
    -------
    tuple or None
        End of the joints, and *and* instead of them; None for another comma.
    """
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


def side_up(chunks: list[Chunk], at: int) -> Run | None:
    """Find which side is up: *the tokens go beside the board, letter side up*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the comma before the phrase.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None if no such phrase begins here.
    """
    types = [type_at(chunks, at + k) for k in range(3)]
    if types[:2] != ["COMMA", "NP"] or types[2] not in ("ADVERB", "ADV"):
        return None
    side = chunks[at + 1].value
    direction = chunks[at + 2].value if types[2] == "ADVERB" else chunks[at + 2].value.preposition.phrase
    bare = side.determiner is None and side.owner is None and " " in side.head and last_word(side.head) == "side"
    if not bare or str(direction).split()[-1:] not in (["up"], ["down"], ["upward"], ["downward"], ["upwards"]):
        return None
    _leave_out(chunks[at + 1 : at + 3], "which side is up does not say where something is")
    return at + 3, None


def agent(chunks: list[Chunk], at: int) -> Run | None:
    """Find by whom or by what something is done: *it is fixed to the frame by a bolt*, but not *placed by the door*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the preposition.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None for another phrase.
    """
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
    _leave_out(chunks[at:end], "by whom or by what something is done is not where it is")
    return end, None


def naming(chunks: list[Chunk], at: int) -> Run | None:
    """Find another name of a thing: *a large plate, known as a charger, …*, *a plate called a side plate …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the participle, or of the comma before it.

    Returns
    -------
    tuple or None
        End of the name, with the comma after one in commas, and None; None if no name follows.
    """
    apart = type_at(chunks, at) == "COMMA"
    first = at + apart
    if type_at(chunks, at - 1) != "NP" or type_at(chunks, first) not in ("PART", "TPART"):
        return None
    group = chunks[first].value
    if not isinstance(group, VerbGroup) or group.lemma not in _NAMING or group.form == "ing":
        return None
    named = first + 1
    while type_at(chunks, named) in ("PREP", "UNKNOWN", "ADVERB") and named < first + 3:
        named += 1
    if type_at(chunks, named) != "NP" or (named > first + 1) != (group.lemma in ("know", "refer")):
        return None
    _leave_out(chunks[first : named + 1], "another name of a thing does not say where it is")
    return named + 1 + (apart and type_at(chunks, named + 1) == "COMMA"), None


_NAMING = frozenset({"know", "call", "refer", "name", "term", "dub"})
"""Verbs before another name of a thing."""


def omission(chunks: list[Chunk], at: int) -> Run | None:
    """Find what is not done: *slide the poles in without attaching them to the base*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of *without*.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None if no participle follows.
    """
    named = chunks[at].type == "UNKNOWN" and chunks[at].value == "without" and at > 0
    group = chunks[at + 1].value if named and type_at(chunks, at + 1) in ("TPART", "PART") else None
    if not isinstance(group, VerbGroup) or group.form != "ing":
        return None
    end = end_before(chunks, at + 1, _BREAKS)
    _leave_out(chunks[at:end], "what is not done does not say where something is")
    return end, None


def layer(chunks: list[Chunk], at: int) -> Run | None:
    """Find a command to make a layer or a group somewhere, which is put there: *make a thin layer on the gravel*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the verb.

    Returns
    -------
    tuple or None
        End of the verb, and a command to put its object; None for another verb, or without a place.
    """
    types = [type_at(chunks, at + k) for k in range(3)]
    group = chunks[at].value
    made = types[:2] in (["DO", "NP"], ["PUT", "NP"]) and isinstance(group, VerbGroup) and group.lemma in _MAKING
    end = at + 2 + 2 * ([type_at(chunks, at + k) for k in (2, 3)] == ["OF", "NP"])
    if not made or last_word(chunks[at + 1].value.head) not in _LAYERS or type_at(chunks, end) != "PREP":
        return None
    put = replace(group, lemma="put", kind="posture")
    return at + 1, replace(chunks[at], type="PUT", value=put)


def replacement(chunks: list[Chunk], at: int) -> Run | None:
    """Find a command to put something back: *replace the lid on the jar*, but not *replace the cup with a glass*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the verb.

    Returns
    -------
    tuple or None
        End of the verb, and a command to put its object; None for another verb, or without a place.
    """
    group = chunks[at].value
    back = chunks[at].type == "DO" and isinstance(group, VerbGroup) and group.lemma == "replace"
    if not back or [type_at(chunks, at + k) for k in (1, 2, 3)] != ["NP", "PREP", "NP"]:
        return None
    if chunks[at + 2].value.preposition.relation not in ("on", "inside", "under", "above", "behind"):
        return None
    return at + 1, replace(chunks[at], type="PUT", value=replace(group, lemma="put", kind="posture"))


def _leave_out(chunks: list[Chunk], reason: str) -> None:
    """Report chunks that are left out."""
    misunderstood((chunks[0].span[0], chunks[-1].span[1]), reason)


_MAKING = frozenset({"make", "create", "form", "build"})
_LAYERS = word_set("layer bed row line ring circle pile heap mound stack border coat coating")
"""Nouns of what is made at its place."""
_USING = word_set("use need want like access reach handle")
"""Verbs of a person that tell things apart, and not where they are."""
_DONE_BY_MEANS = word_set(
    "attach connect fix fasten secure join link tie bolt screw nail glue tape strap clip clamp pin hook tuck roll fold"
    " wrap cover spread pour lower raise lift pull push insert install mount suspend"
)
"""Verbs of actions after whose participles *by* names an agent or a tool."""
_STEMS = _CAUSING | {lemma.removesuffix("e") for lemma in _CAUSING}
"""Such verbs, and their stems before *-ing* where no table has the verb."""

FINDERS = (
    framing, manner, consequence, compared_quality, examples, side_up, first_of_two_commands, used_things, followers,
    agent, naming, omission, layer, replacement,
)  # fmt: skip
"""Finders of phrases beside the statement, in the order in which they are used."""
