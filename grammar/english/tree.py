"""The parsed form of English sentences: clauses, the predicates that they state, and noun phrases.

The parser (``parse``) turns a text into these types. Two readers use them: ``discourse`` turns statements into the
facts of a script, and :mod:`deixis.workflows.descriptions.refer` turns a description into a query for one object.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from deixis.grammar.english.confidence import Guess

Span = tuple[int, int]
"""First and last character of a phrase in the text, counted from 0, the end exclusive."""
TOWARDS = "toward"
"""Mark, among its adverbs, of a place that was named after *toward*: what can aim there faces it."""


class Mood(StrEnum):
    """The use of a sentence: something that holds, something to do, or something asked."""

    STATEMENT = "statement"
    COMMAND = "command"
    QUESTION = "question"


class Degree(StrEnum):
    """Degree of an adjective: *tall*, *taller*, *tallest*."""

    PLAIN = "plain"
    COMPARATIVE = "comparative"
    SUPERLATIVE = "superlative"


@dataclass(frozen=True, slots=True)
class Adjective:
    """A modifier of a noun: ``red``, ``tallest``, ``left``, ``second`` (``rank`` 2, or -1 for ``last``).

    ``dimension`` is what it describes: ``colour``, ``size``, ``height``, ``length``, ``width``, ``thickness``,
    ``material``, ``shape``, ``position`` (``left``, ``middle``, ``top``, ``near``), ``rank``, ``state`` or ``other``.
    """

    word: str  # lemma: 'tall' for 'tallest'
    dimension: str
    degree: Degree
    span: Span
    rank: int | None = None
    positive: bool = True


@dataclass(frozen=True, slots=True)
class Measure:
    """A distance, in metres: 0.1 and the hedge ``about`` for *about 10 cm*.

    ``bound`` is ``<`` for *within* and *less than*, ``>`` for *at least* and *more than*, and None otherwise.
    """

    metres: float
    hedge: str | None
    bound: str | None
    span: Span


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """Place and direction of a viewer: *facing the bed*, *from the door*, *standing at the sink with your back to it*.

    ``at`` is where the viewer stands, ``facing`` what the viewer looks at, ``back`` what is behind the viewer. ``own``
    is the owner of a side: *to your left* (pronoun ``you``), *to the chair's left*. ``entering`` is True for *as you
    walk in through the door* (``at`` is the door, and the viewer looks into the room).
    """

    span: Span
    at: NounPhrase | None = None
    facing: NounPhrase | None = None
    back: NounPhrase | None = None
    own: NounPhrase | None = None
    entering: bool = False


@dataclass(frozen=True, slots=True)
class NounPhrase:
    """A phrase that stands for one or more objects.

    ``head`` is the noun in the singular with the nouns before it (``water bottle``; between two ``LITERAL`` letters
    for a name that is taken as it is), empty for a pronoun or an ellipsis (``the left one`` has the pronoun
    ``one``; ``the leftmost`` has neither). ``members`` are the parts of a coordination, joined by ``joined_by``
    (``and``, ``or``); a coordination has no head of its own. ``of`` is the complement of a phrase such as *end of
    the shelf*, *row of pawns*, *one of the forks*. ``owner`` is the possessor (*the cup's handle*, *its lid*).
    """

    span: Span
    head: str = ""
    determiner: str | None = (
        None  # 'a', 'the', 'this', 'each', 'every', 'all', 'both', 'no', 'any', 'other', 'same', ...
    )
    count: int | None = None  # 2 for 'two cups'; None where no number is given
    plural: bool = False
    pronoun: str | None = None  # 'it', 'they', 'one', 'other', 'former', 'latter', 'me', 'you', 'everything', ...
    adjectives: tuple[Adjective, ...] = ()
    predicates: tuple[Predicate, ...] = ()  # restrictions: phrases and relative clauses whose subject is this phrase
    of: NounPhrase | None = None
    owner: NounPhrase | None = None
    members: tuple[NounPhrase, ...] = ()
    joined_by: str | None = None
    known: bool = True  # False for a singular that the ontology does not have
    negated: bool = False  # 'the red box, not the blue one': the second member


@dataclass(frozen=True, slots=True)
class Predicate:
    """Something said about a subject: ``left of the plate``, ``red``, ``between the cup and the jug``, ``the tallest``.

    ``relation`` is a name of the ontology (``left``, ``near``, ``between``, ``corner``, ``bigger``, ``colour``) or, for
    a property, the dimension of its ``value``. ``reversed`` is True where the subject and the first argument change
    places: *with a napkin on it*, *that contains a pen*, and the relative clause *that the cup stands on*.

    Further relations:

    - ``kind`` (*is a chair*, *it is the one on the left*: the argument is the noun phrase) and ``with`` (*with the
      monitor*, *has a lamp*);
    - ``corner``, ``edge``, ``end``, ``side``, ``middle`` and ``part``, of the argument, or of the whole table or room
      if there is none; *on the left* is ``left`` without arguments, with the part ``left``, *on the left side* has the
      part ``side``, and *to the left* has none;
    - ``ordinal`` (*second from the left*: ``value.rank`` 2, ``part`` ``left``) and ``row`` (part ``left to right``);
    - ``near`` and ``far`` with the degree superlative (*closest to the door*) or comparative with ``than``; a
      comparison (*taller than the jug*) has the jug as its argument and the adjective as its ``value``;
    - ``material`` (*made of wood*), ``like`` (*looks like a bowl*), ``share`` (*share one saucer*), ``as`` after
      *the same* (*on the same wall as the sink*), ``to`` after a door (*the door to the bathroom*);
    - ``one_each`` (*one each*: the two groups of the clause are matched), and ``there`` (*over there*, *anywhere*: the
      subject is present).
    """

    relation: str
    arguments: tuple[NounPhrase, ...]
    span: Span
    value: Adjective | None = None
    part: str | None = None  # 'far left' for 'in the far left corner'
    subject_part: NounPhrase | None = None  # 'its handle' in 'its handle pointing to the right'
    measure: Measure | None = None
    degree: Degree = Degree.PLAIN  # 'closer to the edge than the mouse' is comparative, 'closest to it' superlative
    than: NounPhrase | None = None
    adverbs: tuple[str, ...] = ()  # 'directly', 'right', 'slightly', 'usually'
    positive: bool = True
    reversed: bool = False
    of_one: bool = False  # of a thing that 'it' stands for: 'with a knife across it'
    viewpoint: Viewpoint | None = None  # 'to your left', 'to the chair's left'; see also Sentence.viewpoint


@dataclass(frozen=True, slots=True)
class Clause:
    """One subject with what is said about it; ``predicates`` are all said together (*and*).

    ``choices`` are further lists of predicates of which one holds instead (*or, if you prefer, …*). ``condition`` is
    the text of an *if* clause, ``modal`` the word that makes it less than a plain statement (``should``, ``may``,
    ``must``, ``cannot``), ``past`` is True if it may no longer hold.
    """

    subject: NounPhrase | None
    predicates: tuple[Predicate, ...]
    span: Span
    mood: Mood = Mood.STATEMENT
    positive: bool = True
    modal: str | None = None
    hedges: tuple[str, ...] = ()
    past: bool = False
    condition: str | None = None
    choices: tuple[tuple[Predicate, ...], ...] = ()
    existential: bool = False  # 'there is a cup on the tray'
    step: str | None = None  # 'first', 'then', 'before'
    guesses: frozenset[Guess] = frozenset()  # doubtful steps by which the clause was parsed (confidence.py)


@dataclass(frozen=True, slots=True)
class Misunderstood:
    """A phrase that was left out: where it is, why, and a wording that would be understood."""

    span: Span
    reason: str
    suggestion: str | None = None


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence of a text: its clauses, the words that were understood, and the phrases that were not."""

    text: str
    span: Span
    clauses: tuple[Clause, ...]
    fragment: NounPhrase | None  # a sentence that is only a noun phrase: 'The chair to the left of the desk.'
    words: int
    words_understood: int
    misunderstood: tuple[Misunderstood, ...] = ()
    heading: bool = False
    viewpoint: Viewpoint | None = None  # 'facing the bed, …', 'from the door, …': holds of the whole sentence
    guesses: frozenset[Guess] = frozenset()  # doubtful steps by which the fragment was parsed
    contested: frozenset[Span] = frozenset()  # predicates that not all good readings have (readings.py)
    place: tuple[Predicate, ...] = ()  # place that a heading names: 'On the top shelf', 'Lower shelves'

    @property
    def understood(self) -> float:
        """Share of the words that were understood."""
        return self.words_understood / self.words if self.words else 1.0


def aimed(predicate: Predicate) -> Predicate:
    """Return *toward the left* as the direction that its subject faces.

    Parameters
    ----------
    predicate
        Predicate of a part, or of what a verb turns.

    Returns
    -------
    Predicate
        Direction for a place that was named after *toward*; another predicate as it is.
    """
    if TOWARDS not in predicate.adverbs:
        return predicate
    side = (predicate.part or predicate.relation).replace("_", " ")
    aim = Adjective(side, "position", Degree.PLAIN, predicate.span)
    adverbs = tuple(adverb for adverb in predicate.adverbs if adverb != TOWARDS)
    return replace(predicate, relation="facing", arguments=(), value=aim, part=None, adverbs=adverbs)
