"""Confidence of a fact from the doubtful steps by which it was read.

Most facts come from clauses that the grammar takes whole, whose phrases name their things. A *guess* is a step at which
the reader had to choose without support in the words: a clause that begins without a joint after another one, a
predicate without a subject, the thing that a direction is from, a comma that can join something else, a bare word that
can be a verb as well. The confidence of a fact is the share of right facts without guesses, multiplied by a factor for
each guess. :func:`standing` decides by it what becomes of a fact: it is asserted, listed as doubtful, or left out, and
the message about its words suggests a sentence that states it.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

RIGHT_WITHOUT_GUESSES = 0.87
"""Share of right facts among those without a guess, in texts for which the reader was not changed."""


class Standing(StrEnum):
    """Use of a fact by its confidence."""

    ASSERTED = "asserted"
    DOUBTFUL = "doubtful"
    LEFT_OUT = "left out"


MIN_CONFIDENCE = {Standing.ASSERTED: 0.75, Standing.DOUBTFUL: 0.5, Standing.LEFT_OUT: 0.0}
"""Minimum confidence of a fact of each standing; below 0.5, a fact is more probably wrong than right."""


class Guess(StrEnum):
    """A doubtful step of reading; the value names it in messages."""

    RUN_ON = "words before this, without a comma or a conjunction, do not fit it"
    CUT_SHORT = "words after this, without a comma or a conjunction, do not fit it"
    NO_SUBJECT = "the clause has no subject"
    ACCOMPANIED = "'with' does not say where the other thing is"
    OF_THE_LAST = "the clause does not say of what this is a direction"
    OF_EARLIER = "the sentence does not say of what this is a direction"
    PRONOUN = "the pronoun can stand for several things"
    THOSE = "'these' or 'those' can stand for several things"
    ACTION = "the verb tells an action, and where it happens need not be where the thing is"
    CONTESTED = "the commas or conjunctions can be read otherwise"
    ELLIPSIS = "a phrase without a noun goes back to things that were named long before"
    THEY = "it is not clear which things 'they' stands for"
    STRANGE = "these words may be several things, or have a verb among them, and not be one name"
    BARE = "a word without an article can be another word than the name of a thing"
    BEFORE = "'before' can be a time as well"
    NO_THING = "these words are not the name of a thing that has a place"


UNJOINED = frozenset({Guess.RUN_ON, Guess.CUT_SHORT})
"""Guesses of where a clause begins and ends."""
UNANCHORED = frozenset({Guess.OF_THE_LAST, Guess.OF_EARLIER})
"""Guesses of the thing that a direction is from."""

SHARE_RIGHT = {
    Guess.RUN_ON: 0.72,
    Guess.CUT_SHORT: 0.78,
    Guess.NO_SUBJECT: 0.5,
    Guess.ACCOMPANIED: 0.3,
    Guess.OF_THE_LAST: 0.8,
    Guess.OF_EARLIER: 0.58,
    Guess.PRONOUN: 0.87,
    Guess.THOSE: 0.33,
    Guess.BARE: 0.22,
    Guess.ACTION: 0.6,
    Guess.CONTESTED: 0.6,
    Guess.ELLIPSIS: 0.6,
    Guess.THEY: 0.3,
    Guess.STRANGE: 0.33,
    Guess.BEFORE: 0.5,
    Guess.NO_THING: 0.26,
}
"""Share of right facts among those with one guess.

``CONTESTED``, ``ELLIPSIS`` and ``THEY`` are fitted on 30 facts, a third of which are from texts that the reader had not
seen. ``THOSE`` and ``BARE`` are fitted on facts that earlier versions of the reader read from texts before it was
changed for them. The other guesses are rare there, and are fitted on all texts in ``tests/grammar/english/texts``.
``OF_THE_LAST`` and ``OF_EARLIER`` rest on these texts together with facts of real pages that were judged by hand: 33 of
40 and 28 of 48 are right. So does ``NO_THING``, with 8 of 31. ``BEFORE`` rests on three facts, one
of which is right. ``PRONOUN`` counts as no doubt by itself.
Unknown nouns, the number of words left out, the length of a clause and the distance between subject and place tell
little: with all of them, a logistic regression over 1079 facts keeps 0.89 of the right facts at a share of 0.89.
"""


def confidence(guesses: Iterable[Guess]) -> float:
    """Return the confidence of a fact.

    Parameters
    ----------
    guesses
        Doubtful steps by which the fact was read, each at most once.

    Returns
    -------
    float
        Probability that the fact is what the text states, in [0, 1]; guesses are taken as independent.

    Notes
    -----
    ``bench_english.py --texts tests/grammar/english/texts --guesses`` prints the shares of right facts, by guess.

    Examples
    --------
    >>> confidence([]), round(confidence([Guess.OF_THE_LAST, Guess.PRONOUN]), 2)
    (0.87, 0.8)
    """
    share = RIGHT_WITHOUT_GUESSES
    for guess in sorted(guesses):  # in one order, so that the last digit is the same in each process
        share *= SHARE_RIGHT[guess] / RIGHT_WITHOUT_GUESSES
    return share


def standing(guesses: Iterable[Guess]) -> Standing:
    """Return whether a fact is asserted, listed as doubtful, or left out.

    Parameters
    ----------
    guesses
        Doubtful steps by which the fact was read.

    Returns
    -------
    Standing
        First standing whose minimum in :data:`MIN_CONFIDENCE` the confidence of the fact reaches.

    Examples
    --------
    >>> [standing(guesses).value for guesses in ([], [Guess.CONTESTED], [Guess.THEY])]
    ['asserted', 'doubtful', 'left out']
    """
    share = confidence(guesses)
    return next(found for found, least in MIN_CONFIDENCE.items() if share >= least)
