"""A text in English as it was read: its sentences, what each states, and the words used for each object."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from deixis.grammar.errors import Diagnostic
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact, Source
from deixis.ontology.relations.relation import Reading as WordReading

Span = tuple[int, int]
"""First and last character of a phrase in the text, counted from 0, the end exclusive."""


@dataclass(frozen=True, slots=True)
class StatedFact:
    """A fact or a claim of a text, with the words that state it and what qualifies it.

    ``sentence`` counts the sentences from 0. ``condition`` is the text of an *if* clause. ``past`` is True for what may
    no longer hold, ``uncertain`` for what only may hold (*might be*). Facts with the same number as ``alternative`` are
    a choice: one of them holds. ``quantifier`` is ``each`` where the facts of a sentence pair the members of two
    groups. ``need_not_hold`` is True for an alternative of a choice of which none need hold. ``confidence`` is the
    probability that the text states the fact, in [0, 1]; ``guesses`` names the steps that make it doubtful
    (``deixis.grammar.english.confidence``). ``by_handle`` is True for a direction of the handle of a tool (*the handle
    of the spoon points to the right*): the statement of the script is about its head, which points the other way.
    """

    content: Fact | Claim
    sentence: int
    span: Span
    condition: str | None = None
    past: bool = False
    uncertain: bool = False
    alternative: int | None = None
    quantifier: str | None = None
    need_not_hold: bool = False
    confidence: float = 1.0
    guesses: tuple[str, ...] = ()
    by_handle: bool = False

    @property
    def asserted(self) -> bool:
        """True if the text states that the fact holds now, without a condition."""
        return not (self.condition or self.past or self.uncertain)

    @property
    def reservations(self) -> tuple[str, ...]:
        """Reasons why the fact is not asserted: ``past``, ``uncertain`` and the words of its condition."""
        marks = [name for name in ("past", "uncertain") if getattr(self, name)]
        return (*marks, self.condition) if self.condition else tuple(marks)


@dataclass(frozen=True, slots=True)
class ReadSentence:
    """A sentence of a text, a plain paraphrase of what was understood, and the phrases that were not understood.

    ``understood`` is the share of its words that were understood.
    """

    text: str
    span: Span
    paraphrase: str
    understood: float
    words: int
    question: bool = False
    heading: bool = False
    problems: tuple[Diagnostic, ...] = ()
    problem_spans: tuple[Span, ...] = ()


@dataclass(frozen=True, slots=True)
class DoubtfulPronoun:
    """A pronoun that could stand for several objects, and the one that it was taken for."""

    span: Span
    word: str
    chosen: str
    others: tuple[str, ...]


@dataclass(frozen=True)
class Reading:
    """Everything that was read in a text.

    ``mentions`` holds the phrases used for each object. ``absent`` are the things that the text says are not there.
    ``surface`` is the name of what everything stands on (``desk``), or None where the text does not name it.
    ``uncounted`` are groups of unknown number (*the cups*): one object each, which stands for all things that fit it.
    """

    text: str
    sentences: tuple[ReadSentence, ...]
    stated: tuple[StatedFact, ...]
    mentions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    absent: tuple[str, ...] = ()
    surface: str | None = None
    uncounted: tuple[str, ...] = ()
    doubtful_pronouns: tuple[DoubtfulPronoun, ...] = ()

    @property
    def understood(self) -> float:
        """Share of the words of the text that were understood."""
        words = sum(sentence.words for sentence in self.sentences)
        return sum(sentence.words * sentence.understood for sentence in self.sentences) / words if words else 0.0

    @property
    def claims(self) -> tuple[Claim, ...]:
        """Asserted claims, in the order of the text."""
        return tuple(s.content for s in self.stated if s.asserted and isinstance(s.content, Claim))


def joined_choices(stated: Sequence[StatedFact]) -> Iterator[StatedFact]:
    """Yield facts in order; a choice between relations of one pair becomes one fact with all these relations.

    Parameters
    ----------
    stated
        Stated facts in the order of the text. Those with the same ``alternative`` are the options of one choice.

    Yields
    ------
    StatedFact
        Each fact of the text. A choice is joined if all of its options are facts about the same pair, in the same
        reading, and all are denied or none is; its weight is the sum of theirs, at most 1. The options of another
        choice have a weight of at least one half: that one of several holds does not deny any of them.

    Examples
    --------
    >>> from deixis.grammar.english.reader import read_english
    >>> script = read_english("The fork is either left of the plate or on the plate.")
    >>> [str(fact.content) for fact in script.reading.stated], [str(fact) for fact in script.facts]
    (['left(fork, plate)', 'on(fork, plate)'], ['left or on(fork, plate)'])
    """
    choices: dict[int, list[StatedFact]] = {}
    for fact in stated:
        if fact.alternative is not None:
            choices.setdefault(fact.alternative, []).append(fact)
    for fact in stated:
        options = choices.get(fact.alternative, []) if fact.alternative is not None else []
        contents = [option.content for option in options if isinstance(option.content, Fact)]
        pairs = {(c.subject, c.object, c.positive, c.relations[0].reading is WordReading.EXACT) for c in contents}
        if len(options) < 2 or len(contents) < len(options) or len(pairs) > 1:
            weight = max(fact.content.weight, 0.5) if options else fact.content.weight
            yield replace(fact, content=replace(fact.content, weight=weight))
        elif fact is options[0]:
            relations = tuple(dict.fromkeys(relation for c in contents for relation in c.relations))
            weight = min(1.0, round(sum(c.weight for c in contents), 6))
            yield replace(
                fact, content=replace(contents[0], relations=relations, optional=fact.need_not_hold, weight=weight)
            )


def source_of_span(text: str, span: Span, file: str) -> Source:
    """Return the lines and columns of a span of characters.

    Parameters
    ----------
    text
        Text of the file.
    span
        Offset of the first character of the span in the text, and the offset after its last one.
    file
        Name of the file.

    Returns
    -------
    Source
        Lines and columns, counted from 1.
    """
    (line, column), (end_line, end_column) = (
        (text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)) for at in span
    )
    return Source(file, line, column, end_line, end_column)
