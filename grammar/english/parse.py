"""Parse English: sentences to clauses with their predicates; what is not understood is left out and reported."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.deadline import Deadline
from deixis.grammar.english.chunking.chunk import JOINT_TYPES, Chunk, VerbGroup
from deixis.grammar.english.chunking.chunker import Chunker
from deixis.grammar.english.chunking.shared_heads import with_shared_heads
from deixis.grammar.english.clauses.assemble import Assembly, Found
from deixis.grammar.english.clauses.build import Builder
from deixis.grammar.english.clauses.built import Built, notes
from deixis.grammar.english.clauses.joints import Segment, classify, segments
from deixis.grammar.english.clauses.readings import other_joints, settled
from deixis.grammar.english.clauses.rewriting.ellipses import with_pairs_apart
from deixis.grammar.english.clauses.rewriting.rewrite import rewritten
from deixis.grammar.english.confidence import Guess
from deixis.grammar.english.rewording import without_request, words_of
from deixis.grammar.english.sentences import MAX_SENTENCE_WORDS, RawSentence, sentences
from deixis.grammar.english.tagging.tagger import Tagger, Tagging
from deixis.grammar.english.tagging.word_classes import is_known
from deixis.grammar.english.tokens import Word
from deixis.grammar.english.tree import Misunderstood, Predicate, Sentence
from deixis.grammar.english.vocabulary.function_words import APPROXIMATE, HEDGES
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns, known_nouns
from deixis.grammar.english.vocabulary.nouns import GENERAL, HOLDERS, SURFACES, VESSELS, last_word
from deixis.grammar.english.vocabulary.relation_words import prepositions
from deixis.grammar.english.vocabulary.tables import LITERAL
from deixis.grammar.english.vocabulary.verbs import verb_forms
from deixis.grammar.errors import ScriptTimeError
from deixis.grammar.parsers import ParsedGrammar
from deixis.ontology.tbox import Ontology, default_ontology

if TYPE_CHECKING:
    from lark import Lark

    from deixis.grammar.script import Script


MIN_GAIN = 2
"""Number of words that a second reading of a sentence must understand beyond those of the first."""
MAX_WORDS_OF_ALTERNATIVES = 60
"""Number of words up to which a doubtful sentence is read in several ways."""
LAST_LATIN_LETTER = "\u024f"
MIN_KNOWN_SHARE = 0.16
"""Smallest share of function words, adjectives and verbs in a sentence of English."""


def parse_english(
    text: str, ontology: Ontology | None = None, deadline: Deadline = Deadline.never()
) -> tuple[Sentence, ...]:
    """Parse an English text into its sentences.

    Parameters
    ----------
    text
        One description, or paragraphs with headings and numbered steps.
    ontology
        Nouns that are known: they decide the singular of open cases and compounds such as *light switch*. An unknown
        word is a noun by its place. By default :func:`default_ontology`.
    deadline
        Time limit.

    Returns
    -------
    The sentences in order. A phrase that is not understood is in ``Sentence.misunderstood`` and in nothing else.

    Raises
    ------
    ScriptTimeError
        If the time limit is reached.

    Notes
    -----
    Chunks of words (noun phrases, verb groups, prepositions) are the terminals of an LALR(1) grammar, as in Abney's
    chunk parser ("Parsing by chunks", 1991). A phrase is attached to the nearest noun before it.

    Examples
    --------
    >>> sentence, = parse_english("The fork is to the left of the plate.")
    >>> clause, = sentence.clauses
    >>> clause.subject.head, clause.predicates[0].relation, clause.predicates[0].arguments[0].head
    ('fork', 'left', 'plate')
    """
    found, is_whole = parse_until(text, ontology, deadline)
    if not is_whole:
        raise late(found)
    return found


def parse_until(text: str, ontology: Ontology | None, deadline: Deadline) -> tuple[tuple[Sentence, ...], bool]:
    """Parse the sentences of an English text until a time limit is reached.

    Parameters
    ----------
    text
        The text.
    ontology
        Nouns that are known. By default :func:`default_ontology`.
    deadline
        Time limit.

    Returns
    -------
    tuple
        The sentences in order, and whether they are all of the text.
    """
    nouns = known_nouns((ontology or default_ontology()).kinds)
    found: list[Sentence] = []
    lead: tuple[Predicate, ...] = ()
    for raw in sentences(text):
        if raw.step is None:
            lead = ()
        if deadline.passed:
            return tuple(found), False
        words = with_shared_heads(words_of(text, (raw.start, raw.end)), nouns)
        first = 0
        while first < len(words):
            if deadline.passed:
                return tuple(found), False
            last = min(len(words), first + MAX_SENTENCE_WORDS)
            while last < len(words) and words[last].start < words[last - 1].end:
                last -= 1  # keep the parts of a contraction together
            part, first = words[first:last], last
            whole = len(words) <= MAX_SENTENCE_WORDS
            place = raw if whole else replace(raw, start=part[0].start, end=part[-1].end)
            found.append(_sentence(text, place, part, nouns, () if raw.step is None else lead))
            if raw.step is None:
                lead = _place_of_list(text, place, part, nouns, found[-1])
            if found[-1].heading:
                named = _sentence(text, replace(place, heading=False), part, nouns, ())
                found[-1] = replace(found[-1], place=lead or _place_of_list(text, place, part, nouns, named, True))
                lead = lead or (found[-1].place if part[0].norm in prepositions() else ())
    return tuple(found), True


def late(found: Sequence[Sentence], read: Script | None = None) -> ScriptTimeError:
    """Return the error of a time limit that was reached before the end of a text.

    Parameters
    ----------
    found
        Sentences that were parsed.
    read
        Script of these sentences, or None if they state nothing.

    Returns
    -------
    ScriptTimeError
        Error with the number of sentences, and the script.
    """
    message = f"time limit reached after {count(len(found), 'sentence')}; raise the time limit, or shorten the text"
    return ScriptTimeError(message, read)


def _place_of_list(
    text: str, raw: RawSentence, words: list[Word], nouns: KnownNouns, sentence: Sentence, titles: bool = False
) -> tuple[Predicate, ...]:
    """Return the place that a line before a list gives to its items: *On the left:*, *Top drawer:*.

    With ``titles`` the line is a heading, which has no colon.
    """
    ends = words[-1].norm == ":" or sentence.heading or titles
    if sentence.heading and words[-1].norm == ":":
        sentence = _sentence(text, replace(raw, heading=False), words, nouns, ())
    whole = sentence.fragment is None and len(sentence.clauses) == 1 and sentence.clauses[0].subject is None
    if whole and sentence.clauses[0].span[0] == sentence.span[0]:
        return sentence.clauses[0].predicates
    told = sentence.clauses[0].subject if len(sentence.clauses) == 1 and ends else None
    if told is not None and told.head in GENERAL and told.plural and told.determiner in ("the", "these"):
        return sentence.clauses[0].predicates  # 'place the following items on the tray:'
    phrase = sentence.fragment
    if not ends or phrase is None or sentence.clauses or phrase.predicates or phrase.members:
        return ()
    noun = last_word(phrase.head)
    relation = "inside" if noun in VESSELS | HOLDERS else "on" if noun in SURFACES - {"top"} else None
    return () if relation is None else (Predicate(relation, (phrase,), phrase.span),)


def _sentence(
    text: str, raw: RawSentence, words: list[Word], nouns: KnownNouns, lead: tuple[Predicate, ...]
) -> Sentence:
    """Parse a sentence in several ways: by the second best classes of its words, then each joint read otherwise."""
    if not any(any(c.isalpha() for c in word.norm) for word in words):
        unplaced = Misunderstood((raw.start, raw.end), "numbers alone say nothing about where a thing is")
        numbers = sum(word.is_word for word in words)
        return Sentence(text[raw.start : raw.end], unplaced.span, (), None, numbers, 0, (unplaced,), raw.heading)
    asks = text[raw.start : raw.end].rstrip(" \n\"'\u201d)").endswith("?")
    asks = not without_request(words) and asks
    tagger = Tagger(words, nouns)
    tagging = tagger.best()
    best, chunks = _parsed(text, raw, words, nouns, lead, asks, tagging)
    cost = _cost(best)
    note = best.fragment is not None
    if cost and not best.heading and len(words) <= MAX_WORDS_OF_ALTERNATIVES:
        for second in tagger.second_best(tagging):
            other, other_chunks = _parsed(text, raw, words, nouns, lead, asks, second)
            clause = note and other.fragment is None and any(said.predicates for said in other.clauses)
            acts = clause and all(_is_only_verb(words[at].norm, nouns) for at in second.tried)
            if _cost(other) + MIN_GAIN <= cost or (clause and _cost(other) < cost + acts * (1 + MIN_GAIN)):
                best, chunks, cost = other, other_chunks, _cost(other)
    if not best.heading and len(words) <= MAX_WORDS_OF_ALTERNATIVES:
        others = (
            (_parsed(text, raw, words, nouns, lead, asks, tagging, joined)[0], in_conjunction)
            for joined, in_conjunction in other_joints(chunks)
        )
        best = settled(best, (other for other in others if _cost(other[0]) <= cost))
    return best


def _is_only_verb(word: str, nouns: KnownNouns) -> bool:
    """Return True for a verb in the third person that is not the plural of a noun: *burns* of *incense burns in it*."""
    form = verb_forms().get(word)
    return form is not None and form.form == "s" and not nouns.knows(nouns.singular(word)[0])


def _cost(sentence: Sentence) -> int:
    """Return how much of a sentence is not understood, or understood by guesses: words and doubtful steps."""
    guesses = sum(len(clause.guesses) for clause in sentence.clauses) + len(sentence.guesses)
    note = sentence.fragment is not None
    return sentence.words - sentence.words_understood + 2 * guesses + note


def _parsed(
    text: str, raw: RawSentence, words: list[Word], nouns: KnownNouns, lead: tuple[Predicate, ...],
    asks: bool, tagging: Tagging, joined: list[Chunk] | None = None,
) -> tuple[Sentence, list[Chunk]]:  # fmt: skip
    """Parse a sentence by the classes of its words, or one with given chunks; return its chunks as well."""
    unknown: list[Misunderstood] = []
    foreign = False
    found_chunks: list[Chunk] = []
    before = notes.set(unknown)
    try:
        assembly = Assembly(text, raw, asks=asks)
        assembly.front = lead
        if not raw.heading and _is_foreign(words):
            foreign = True
            unknown.append(
                Misunderstood((raw.start, raw.end), "none of these words is known as English", "write it in English")
            )
        elif not raw.heading:
            found_chunks = with_pairs_apart(Chunker(words, nouns, tagging).run()) if joined is None else joined
            chunks = rewritten([replace(chunk) for chunk in found_chunks], text)
            assembly.hedges = [
                (chunk.span[0], chunk.value)
                for chunk in chunks
                if chunk.type == "ADVERB" and chunk.value in HEDGES - APPROXIMATE
            ]
            parts = segments([chunk for chunk in chunks if chunk.type != "ADVERB"])
            for i, segment in enumerate(parts):
                following = parts[i + 1] if i + 1 < len(parts) else None
                assembly.opens_list = following is not None and following.link == ":"
                commanded = following is not None and following.chunks[0].type == "PUT"
                assembly.leads = commanded and following is not None and following.link in (",", "")
                _parse_segment(segment, assembly)
        found = Found((), None, None) if raw.heading or foreign else assembly.finish()
    finally:
        notes.reset(before)
    total = [word for word in words if word.is_word]
    notes_of_words = [note for note in unknown if note.span[0] < note.span[1]]  # no words that were put in
    spans = sorted({(note.span, note.reason): note for note in notes_of_words}.values(), key=lambda note: note.span)
    missed = sum(any(note.span[0] <= word.start < note.span[1] for note in spans) for word in total)
    sentence = Sentence(
        text=text[raw.start : raw.end],
        span=(raw.start, raw.end),
        clauses=found.clauses,
        fragment=found.fragment,
        words=len(total),
        words_understood=len(total) - missed,
        misunderstood=tuple(spans),
        heading=raw.heading,
        viewpoint=found.viewpoint,
        guesses=found.guesses,
    )
    return sentence, found_chunks


def _is_foreign(words: list[Word]) -> bool:
    """Return True for a run of words of which almost none is a function word, an adjective or a verb of the tables."""
    longest = run = known = 0
    for word in words:
        run = run + 1 if word.norm[:1].isalpha() else 0
        known += is_known(word.norm) or word.norm.startswith(LITERAL)
        longest = max(longest, run)
    letters = [c for word in words if not word.norm.startswith(LITERAL) for c in word.norm if c.isalpha()]
    if sum(c > LAST_LATIN_LETTER for c in letters) > len(letters) / 2:
        return True
    return longest >= 4 and known < MIN_KNOWN_SHARE * len(words)


def _parse_segment(segment: Segment, assembly: Assembly) -> None:
    """Parse one clause; at a chunk that does not fit, end the clause there and begin another one, or leave it out."""
    hedge, segment = assembly.without_frame(segment)
    assembly.is_coordinated = segment.is_coordinated
    assembly.named = [chunk.value for chunk in segment.chunks if chunk.type == "NP" and chunk.value.head]
    chunks = classify(segment)
    if not chunks:
        return
    first = chunks[0]
    if (
        (first.type == "BE" or (isinstance(first.value, VerbGroup) and first.value.lemma == "do" and assembly.asks))
        and len(chunks) > 1
        and chunks[1].type in ("NP", "THERE")
        and (assembly.asks or (not segment.link and assembly.viewpoint is None))
    ):
        chunks[0] = Chunk("ASK", first.start, first.end, first.value, first.span)
    pieces: list[tuple[int, int, Built]] = []
    skipped: list[Chunk] = []
    at = 0
    while at < len(chunks):
        built, end = _longest(chunks, at)
        if built is None:
            if chunks[at].type not in JOINT_TYPES and chunks[at].type not in ("NJ", "PJ", "VJ", "FJ"):
                skipped.append(chunks[at])
            at += 1
            continue
        pieces.append((at, end, built))
        at = end
    for i, (at, end, built) in enumerate(pieces):
        led = any(_is_verb(chunk) and chunk.span[1] <= chunks[at].span[0] for chunk in skipped)
        before = [other for _, last, other in pieces if last == at and not _ORDERS & {built.shape, other.shape}]
        after = [other for first, _, other in pieces if first == end and not _ORDERS & {built.shape, other.shape}]
        taken = any(other.shape == "said" and other.verbs for other in after)  # the last noun can be its subject
        guesses = {Guess.RUN_ON} if led or before or taken else {Guess.CUT_SHORT} if after else set()
        if built.shape == "said" and (segment.link == "and" or built.verbs):
            guesses.add(Guess.NO_SUBJECT)
        assembly.guesses = frozenset(guesses)
        span = chunks[at].span[0], chunks[end - 1].span[1]
        if span[1] <= span[0]:  # of an inversion, which was undone
            places = [place for chunk in chunks[at:end] for place in chunk.span]
            span = min(places), max(places)
        assembly.add(built, segment.link if i == 0 else ",", *span, hedge)
    for chunk in skipped:
        notes.get().append(Misunderstood(chunk.span, "this does not fit the rest of the sentence"))


_JOINTS = JOINT_TYPES | {"NJ", "PJ", "VJ", "FJ", "OJ", "LJ"}
_ORDERS = frozenset({"command", "search", "other"})
"""Shapes of commands, which show by their verb where they begin."""


def _is_verb(chunk: Chunk) -> bool:
    """Return True for a word that was left out, and that looks like a verb: *tired of putting …*."""
    return chunk.type == "UNKNOWN" and isinstance(chunk.value, str) and chunk.value.endswith("ing")


def _longest(chunks: list[Chunk], at: int) -> tuple[Built | None, int]:
    """Return the clause that begins at a place, and its end; None if none begins there."""
    lark = _parser()
    whole, ends = _feed(lark, chunks, at, len(chunks))
    if whole is not None:
        return whole, len(chunks)
    joined = [end for end in ends if _ends_list(chunks, at, end)]
    for end in (*(e for e in reversed(ends) if e not in joined), *reversed(joined)):
        before = len(notes.get())
        built, _ = _feed(lark, chunks, at, end)
        if built is not None:
            return built, end
        del notes.get()[before:]
    return None, at


def _ends_list(chunks: list[Chunk], at: int, end: int) -> bool:
    """Return True if a clause would end with the last noun of a list, which can be the subject of what follows."""
    if [chunk.type for chunk in chunks[end - 2 : end]] != ["NJ", "NP"] or chunks[end].type in _JOINTS:
        return False
    if all(chunk.type == "UNKNOWN" and chunk.end - chunk.start > 1 for chunk in chunks[end:]):
        return False  # 'on coasters or small plates to protect the cloth'
    relators = [chunk.value for chunk in chunks[at:end] if chunk.type == "PREP"]
    return not relators or relators[-1].preposition.relation not in ("between", "among")


def _feed(lark: Lark, chunks: list[Chunk], at: int, end: int) -> tuple[Built | None, list[int]]:
    """Feed chunks to the parser; return the clause, or None and the places before ``end`` at which one may end."""
    from lark import Token
    from lark.exceptions import UnexpectedToken

    state: Any = lark.parse_interactive().parser_state
    before = len(notes.get())
    ends: list[int] = []
    try:
        for i in range(at, end):
            if i > at and "$END" in state.parse_conf.states[state.position]:
                ends.append(i)
            state.feed_token(chunks[i])
        return state.feed_token(Token("$END", ""), True), ends
    except UnexpectedToken:
        del notes.get()[before:]
        return None, ends


@cache
def _parser() -> Lark:
    return ENGLISH.parser()


ENGLISH = ParsedGrammar(Path(__file__).with_name("english.lark"), start="clause", transformer=Builder())
"""The grammar of clauses."""
