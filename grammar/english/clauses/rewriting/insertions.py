"""Take out what stands apart from the clauses: parentheses, forms of address, insertions, openings."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, VerbGroup
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.clauses.rewriting.editing import (
    ENDS,
    PREDICATES,
    apart,
    emptied,
    leave_out,
    type_at,
    with_last,
)
from deixis.grammar.english.tree import Degree, NounPhrase
from deixis.grammar.english.vocabulary.function_words import READY
from deixis.grammar.english.vocabulary.nouns import PEOPLE, VIEWER_WORDS, last_word
from deixis.grammar.english.vocabulary.tables import word_set

_CALLING = frozenset({"call", "name", "know", "mark", "label", "refer", "title", "term"})
"""Participles in parentheses before another name of a thing."""

_NAMES = frozenset({"NP", "ADVERB", "ADJP", "CUT", "NOT", "UNKNOWN"})
"""Chunks in parentheses that say no place: *(A)*, *(mice!)*, *(not the blue one)*."""

_SHOWN = word_set(
    "see fig figure figures page pages pp photo photos picture pictures diagram illustration shown pictured"
)
"""First words in parentheses that send the reader elsewhere: *(see photo)*, *(Figure 2)*."""

_BESIDE_THE_TEXT = word_set("above below left right inset opposite overleaf top bottom")
"""Single words in parentheses that tell where a picture stands beside the text."""

_ENDEARMENTS = word_set(
    "darling dear dearest love sweetheart honey mum mom mummy mommy dad daddy gran grandma grandpa son daughter mate"
    " buddy guys folks everyone all team sir madam ladies gentlemen kids boys girls class students colleagues friends"
)
"""Nouns by which a person is spoken to."""


def without_parentheses(chunks: list[Chunk], text: str) -> list[Chunk]:
    """Return the chunks with what parentheses say about the noun before them at the end, as a phrase of its own.

    *Set the knife (with its blade to the left) beside the plate* is read as *set the knife beside the plate; the knife
    with its blade to the left*. A name in parentheses, or a word said in passing, is left out.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    text
        The whole text.

    Returns
    -------
    list of Chunk
        Chunks without the parentheses; what they say about a thing comes after them.
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
            leave_out(inside, "what parentheses say under a condition is not read")
            i = (closing or i) + 1
            continue
        if opened and _is_reference(inside, text) and len(_directions_apart(chunks, text)) < 2:
            leave_out(inside, "this tells where a picture shows it")
            i = (closing or i) + 1  # 'bolt the legs to the top (left)'
            continue
        if opened and _says_place_again(kept[-1], inside):
            leave_out(inside, "this says the place before in other words")
            i = (closing or i) + 1  # 'to its left (your right as you face it), place a cup'
            continue
        if opened and _is_clause(inside) and type_at(chunks, (closing or i) + 1) not in ENDS:
            after += [Chunk("CUT", inside[0].start, inside[0].start, None, chunk.span), *inside]
            i = (closing or i) + 1  # 'put the basket (mine is from a market) on the shelf'
            continue
        follows_noun = opened and kept[-1].type == "NP"
        doing = inside[1:] if opened and inside[0].type == "ADVERB" else inside
        called = doing[0].value if follows_noun and doing and doing[0].type in ("PART", "TPART") else None
        if isinstance(called, VerbGroup) and called.lemma.removesuffix("ed") in _CALLING:
            leave_out(inside, "another name of a thing does not say where it is")
            i = (closing or i) + 1  # 'the lower drawer (sometimes marked crisper)'
            continue
        done = [c.type for c in inside] == ["NP", "PART"] and inside[0].value.determiner is None
        if follows_noun and done:
            leave_out(inside, "how a thing is meanwhile is not where it is")
            i = (closing or i) + 1  # 'place the sofa (cushions removed) in the truck'
            continue
        if follows_noun and _is_definition(inside):
            leave_out(inside, "this says what the thing before is, not where it is")
            i = (closing or i) + 1
            continue
        if (
            follows_noun
            and inside[0].type in ("WITH", "PREP", "ADV", "PART", "TPART")
            and "NP" in [c.type for c in inside]
        ):
            aimed = inside[0].type == "PREP" and inside[0].value.preposition.degree is Degree.SUPERLATIVE
            subjects = [k for k in range(len(kept) - 1) if kept[k].type == "NP" and kept[k + 1].type in FINITE]
            of = kept[subjects[-1]] if aimed and subjects else kept[-1]  # 'A is on the left of B (farthest from C)'
            after += apart([of], inside, chunk.span)
            i = (closing or i) + 1
            continue
        if follows_noun and [c.type for c in inside[:2]] == ["NP", "REL"] and "COMMA" not in [c.type for c in inside]:
            leave_out(inside, "this says what the thing before is, not where it is")
            i = (closing or i) + 1  # 'the rooks (the pieces that look like towers) go …'
            continue
        if follows_noun and {c.type for c in inside} <= _NAMES and sum(c.type == "NP" for c in inside) == 1:
            i = (closing or i) + 1  # 'the long panels (A) go …', 'under a tea towel (mice!)'
            continue
        kept.append(chunk)
        i += 1
    return with_last(kept, after)


def _is_reference(inside: list[Chunk], text: str) -> bool:
    """Return True for words that send the reader to a picture or to a page: *(above)*, *(inset)*, *(see page 65)*."""
    words = text[inside[0].span[0] : inside[-1].span[1]].casefold().replace(".", " ").split()
    return words[0] in _SHOWN or (len(words) == 1 and words[0] in _BESIDE_THE_TEXT)


def _directions_apart(chunks: list[Chunk], text: str) -> list[str]:
    """Return the directions that stand alone in parentheses, of which several tell things apart."""
    inner = zip(chunks, chunks[1:], chunks[2:], strict=False)
    words = (
        text[slice(*b.span)].casefold() for a, b, c in inner if text[slice(*a.span)] + text[slice(*c.span)] == "()"
    )
    return [word for word in words if word in _BESIDE_THE_TEXT]


def _says_place_again(before: Chunk, inside: list[Chunk]) -> bool:
    """Return True for another name of the place before, as a person sees it: *(your right as you face it)*."""
    place = before.type in ("NP", "ADV") and (before.type == "ADV" or is_place(before.value))
    mine = inside[0].type == "NP" and is_place(inside[0].value) and inside[0].value.owner is not None
    return place and mine and inside[0].value.owner.pronoun in VIEWER_WORDS


def _is_clause(inside: list[Chunk]) -> bool:
    """Return True for a clause with a noun as its subject: *(mine is from a market)*, but not *(which is red)*."""
    types = [chunk.type for chunk in inside if chunk.type != "ADVERB"]
    verb = next((k for k, kind in enumerate(types) if kind in FINITE), 0)
    return types[:1] == ["NP"] and verb > 0 and "COMMA" not in types[:verb]


def _is_conditional(inside: list[Chunk]) -> bool:
    """Return True for words in parentheses that have a condition of their own: *(and drinks, if you serve any)*."""
    types = [chunk.type for chunk in inside]
    limited = "SUB" in types and not FINITE.isdisjoint(types)
    if types[0] == "SUB":
        limited = "COMMA" in types and not FINITE.isdisjoint(types[types.index("COMMA") :])
    return limited and types[0] in ("SUB", "AND", "OR", "BUT")


def _is_definition(inside: list[Chunk]) -> bool:
    """Return True for what a thing is made of or how it is made: *(rice boiled in broth)*, *(pickled plums)*."""
    things = [i for i, chunk in enumerate(inside[:2]) if chunk.type == "NP"]
    made = [chunk.value for chunk in inside[:2] if chunk.type in ("PART", "TPART")]
    if len(things) != 1 or not made or not isinstance(made[0], VerbGroup):
        return False
    phrase = inside[things[0]].value
    return made[0].kind in ("other", "unknown") and phrase.determiner in (None, "a", "an") and phrase.owner is None


def _without_second_names(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out the first of two names of one thing with a slash between them: *my cutting/work table*.

    Two names of known things (*the table/desk*) stay a choice.
    """
    for i in range(1, len(chunks) - 1):
        first, slash, second = chunks[i - 1 : i + 2]
        joined = slash.type == "OR" and first.span[1] == slash.span[0] == slash.span[1] - 1 == second.span[0] - 1
        if not joined or first.type != "NP" or second.type != "NP" or slash.value is not None:
            continue
        one, other = first.value, second.value
        single = bool(one.head and other.head) and not (one.plural or other.plural or one.members or other.members)
        named = single and (one.determiner in ("the", "a", "an") or one.owner is not None) and other.determiner is None
        longer = len(other.head.split()) > len(one.head.split())
        same = longer and (not one.known or last_word(one.head) == last_word(other.head))  # 'a cutting/work table'
        if named and same and other.owner is None:
            kept = replace(one, head=other.head, known=other.known)
            first = Chunk("NP", first.start, second.end, kept, (first.span[0], second.span[1]))
            return _without_second_names([*chunks[: i - 1], first, *chunks[i + 2 :]])
    return chunks


def _without_vocatives(chunks: list[Chunk]) -> list[Chunk]:
    """Leave out who is spoken to, and interjections: *My dear boy, the soup is …*, *No, look again*, *Right, …*."""
    found: list[Chunk] = []
    for i, chunk in enumerate(chunks):
        starts = all(c.type == "ADVERB" or (c.type in ENDS and k) for k, c in enumerate(found))
        closed = type_at(chunks, i + 1) in ("COMMA", "CUT") and (starts or type_at(chunks, i - 1) == "COMMA")
        spoken_to = chunk.type == "NP" and _names_listener(chunk.value) and (starts or type_at(chunks, i + 2) in ENDS)
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
    """Leave out the time at the beginning of a sentence: *Before the run, …*, *Once set, …*, *Once in the hall, …*."""
    start = next((i for i, chunk in enumerate(chunks) if chunk.type != "ADVERB"), 0)
    if [type_at(chunks, start), type_at(chunks, start + 2)] == ["SUB", "COMMA"] and chunks[start].value == "once":
        done = chunks[start + 1]
        bare = done.type in ("ADJP", "PART") or (done.type == "NP" and done.end == done.start + 1)
        if bare:
            return [*chunks[:start], *(emptied(c) for c in chunks[start : start + 3]), *chunks[start + 3 :]]
    if [type_at(chunks, start + k) for k in range(4)] == ["SUB", "PREP", "NP", "COMMA"] and chunks[
        start
    ].value == "once":
        return [*chunks[:start], *(emptied(c) for c in chunks[start : start + 4]), *chunks[start + 4 :]]
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
    inverted = type_at(chunks, start + 3) in FINITE | PREDICATES
    if not before or phrase.pronoun is not None or not phrase.head or inverted:
        return chunks
    return [*chunks[:start], emptied(chunks[start]), *chunks[start + 3 :]]


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
    placed = any(chunk.type in PREDICATES for chunk in chunks[first + 3 :])
    command = VerbGroup("place", "posture", "base") if placed else VerbGroup("take", "other", "base")
    return [Chunk("PUT" if placed else "DO", opening.start, verb.end, command, opening.span), *chunks[first + 2 :]]


def _without_insertions_between_dashes(chunks: list[Chunk]) -> list[Chunk]:
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


REWRITES = (
    _without_second_names, _without_vocatives, _without_adverbs_apart, _without_insertions_between_dashes,
    _without_openings, _without_times,
)  # fmt: skip
"""Rewritings that take out what stands apart, in their order."""
