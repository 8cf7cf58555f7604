"""Any text: the parser answers in bounded time, with spans inside the text and counts that add up."""

from __future__ import annotations

from collections.abc import Iterator
from typing import cast

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.grammar.english.discourse.discourse import Discourse
from deixis.grammar.english.parse import parse_english
from deixis.grammar.english.reader import read_english
from deixis.grammar.english.rewording import _CONTRASTS, _DENIALS, _RARELY, words_of
from deixis.grammar.english.sentences import MAX_SENTENCE_LENGTH, sentences
from deixis.grammar.english.tree import NounPhrase, Predicate, Sentence
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.errors import ScriptError, ScriptTimeError
from deixis.ontology.tbox import default_ontology

WORDS = st.sampled_from(
    [
        "the",
        "a",
        "fork",
        "plates",
        "cup",
        "left",
        "right",
        "of",
        "to",
        "on",
        "in",
        "not",
        "isn't",
        "is",
        "are",
        "and",
        "or",
        "but",
        ",",
        ".",
        ";",
        ":",
        "?",
        "that",
        "which",
        "with",
        "it",
        "its",
        "one",
        "ones",
        "two",
        "second",
        "closest",
        "taller",
        "than",
        "between",
        "there",
        "if",
        "you",
        "facing",
        "from",
        "put",
        "choose",
        "stands",
        "corner",
        "10",
        "cm",
        "'s",
        "next",
        "blue",
        "each",
        "no",
        "only",
        "so",
        "at",
        "most",
        "12",
        "o'clock",
        "left-hand",
        "A",
        "B",
        "\n",
        "(",
        ")",
        "never",
        "either",
        "both",
        "nor",
    ]
)
SENTENCES = st.lists(WORDS, max_size=40).map(" ".join)


def nouns(phrase: NounPhrase | None) -> Iterator[NounPhrase]:
    """Yield a noun phrase and all phrases in it."""
    if phrase is None:
        return
    yield phrase
    for inner in (phrase.of, phrase.owner, *phrase.members):
        yield from nouns(inner)
    for predicate in phrase.predicates:
        for argument in predicate.arguments:
            yield from nouns(argument)


def predicates(sentence: Sentence) -> Iterator[Predicate]:
    """Yield the predicates of all clauses."""
    for clause in sentence.clauses:
        yield from clause.predicates


def check(text: str) -> None:
    assert all(word.norm for word in words_of(text, (0, len(text))))
    end = 0
    for sentence in parse_english(text):
        assert end <= sentence.span[0] < sentence.span[1] <= len(text)
        end = sentence.span[1]
        assert sentence.text == text[slice(*sentence.span)]
        assert 0 <= sentence.words_understood <= sentence.words
        assert 0 <= sentence.understood <= 1
        spans = [predicate.span for predicate in predicates(sentence)]
        spans += [phrase.span for phrase in nouns(sentence.fragment)]
        spans += [clause.span for clause in sentence.clauses]
        spans += [note.span for note in sentence.misunderstood]
        for start, stop in spans:
            assert sentence.span[0] <= start < stop <= sentence.span[1]
        for clause in sentence.clauses:
            assert all(len(phrase.head) < 200 for phrase in nouns(clause.subject))
            assert all(predicate.relation.isidentifier() for predicate in clause.predicates)


@given(st.text(max_size=200))
@settings(max_examples=60, deadline=None)
def test_any_text(text: str) -> None:
    check(text)


@given(SENTENCES)
@settings(max_examples=125, deadline=None)
@example("with no")
@example("n't")
@example("stands you left the")
@example("a cup ) beyond the plate, its handle towards the empty chair")
@example("the the the and so")
def test_any_words(text: str) -> None:
    check(text)


def test_a_phrase_may_end_the_text_anywhere() -> None:
    for phrase in (*_DENIALS, *_CONTRASTS, *_RARELY):
        for end in range(1, len(phrase) + 1):
            check(" ".join(phrase[:end]))
            check("the cup is on the tray, " + " ".join(phrase[:end]))


@given(SENTENCES)
@settings(max_examples=50, deadline=None)
def test_parsing_twice_gives_the_same(text: str) -> None:
    assert parse_english(text) == parse_english(text)


@pytest.mark.parametrize(
    "text",
    ["x" * 100_000, "the cup on " * 1000 + "the plate", "the cup that is on the plate " * 300, "the cup and " * 1000,
     "the cup's " * 1000 + "handle", "not " * 3000, "the end of " * 1000 + "it", "." * 100_000, "(" * 10_000,
     "very " * 2000 + "red", "\n" * 100_000, "1 " * 3000],
    ids=lambda text: text[:12],
)  # fmt: skip
def test_long_texts_end_soon(text: str) -> None:
    with processor_time_below(10):
        check(text)


def test_a_time_limit_holds() -> None:
    with pytest.raises(ScriptTimeError, match="time limit reached"):
        parse_english("The cup is on the tray. " * 10, deadline=Deadline.after(-1))


class PassingDeadline:
    """Deadline that passes after a number of questions."""

    def __init__(self, questions: int) -> None:
        self.questions = questions

    @property
    def passed(self) -> bool:
        """Count a question."""
        self.questions -= 1
        return self.questions < 0

    def share(self, fraction: float) -> PassingDeadline:
        """Return a deadline that passes after as many questions."""
        return PassingDeadline(self.questions)


def test_what_was_read_at_a_time_limit_is_kept() -> None:
    text = "The cup is on the tray. The fork is left of the cup. " * 3
    with pytest.raises(ScriptTimeError, match="after 2 sentences") as late:
        read_english(text, deadline=cast("Deadline", PassingDeadline(4)))
    assert late.value.read is not None
    assert [str(fact) for fact in late.value.read.facts] == ["left(fork, cup)"]


def test_reading_facts_ends_at_the_time_limit() -> None:
    text = "The cup is on the mat. The fork is left of the cup. The jug is behind the cup."
    discourse = Discourse(text, parse_english(text), {}, known_nouns(default_ontology().kinds))
    drafts = discourse.read(cast("Deadline", PassingDeadline(2)))
    assert [draft.relation for draft in drafts] == ["on", "left"] and len(discourse.sentences) == 2


def test_a_time_limit_before_the_first_fact_keeps_nothing() -> None:
    with pytest.raises(ScriptTimeError) as late:
        read_english("Wash your hands. The fork is left of the cup.", deadline=cast("Deadline", PassingDeadline(2)))
    assert late.value.read is None


@pytest.mark.parametrize("text", ["1 2 3 4 5 " * 4000, "(1) " * 10_000, "12. 34. " * 4000])
def test_numbers_alone_end_soon(text: str) -> None:
    with processor_time_below(10), pytest.raises(ScriptError):
        read_english(text)


def test_a_text_without_a_full_stop_is_cut() -> None:
    cut = list(sentences("the cup is on the tray and " * 3000))
    assert len(cut) > 1 and max(raw.end - raw.start for raw in cut) <= MAX_SENTENCE_LENGTH


@pytest.mark.parametrize("text", ["", " \n\t ", "...", "?!"])
def test_a_text_without_words_has_no_sentences(text: str) -> None:
    assert parse_english(text) == ()


@pytest.mark.parametrize(
    "text",
    ["Der Teller steht neben dem Glas.", "La fourchette est à gauche de l'assiette.", "叉子在盘子的左边。",
     "Вилка слева от тарелки."],
)  # fmt: skip
def test_other_languages_are_refused(text: str) -> None:
    (sentence,) = parse_english(text)
    assert not sentence.clauses
    assert sentence.fragment is None
    assert sentence.understood == 0
    assert "known as English" in sentence.misunderstood[0].reason


@pytest.mark.parametrize("number", ["9" * 400, "9" * 5000, "1e999"])
def test_a_number_without_end_is_not_a_count(number: str) -> None:
    assert parse_english(f"{number} forks are left of the plate.")
