"""Suggestions for misspelt words: the known word that is spelt most like a given one."""

from __future__ import annotations

from collections.abc import Iterable

MIN_SIMILARITY = 0.6
"""Minimum share of matching letters of a suggestion."""

LETTERS_PER_MISTAKE = 3
"""Number of letters of the longer word for each letter that may be wrong."""

MAX_LENGTH = 100
"""Number of characters of a word that are compared."""


def nearest(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that is spelt most like a word.

    Parameters
    ----------
    word
        The word.
    known
        The known words.

    Returns
    -------
    str or None
        The nearest word, or None if all are too different.

    Examples
    --------
    >>> nearest("rihgt", ["left", "right"])
    'right'
    >>> nearest("hive frame", ["silverware"])
    """
    from difflib import get_close_matches

    word = word[:MAX_LENGTH]
    found = get_close_matches(word, sorted(known), n=3, cutoff=MIN_SIMILARITY)
    return next(
        (near for near in found if mistakes(word, near) <= max(len(word), len(near)) / LETTERS_PER_MISTAKE), None
    )


def mistakes(word: str, meant: str) -> int:
    """Return how many letters are missing, added, wrong or exchanged with the next one.

    Parameters
    ----------
    word, meant
        The words.

    Returns
    -------
    int
        Distance of Damerau and Levenshtein, without edits inside exchanged letters.

    Examples
    --------
    >>> mistakes("rihgt", "right"), mistakes("frok", "forks"), mistakes("", "cup")
    (1, 2, 3)
    """
    before: list[int] = []
    last = list(range(len(meant) + 1))
    for i, letter in enumerate(word):
        row = [i + 1]
        for j, other in enumerate(meant):
            row.append(min(last[j] + (letter != other), last[j + 1] + 1, row[j] + 1))
            if i and j and letter == meant[j - 1] and word[i - 1] == other:
                row[-1] = min(row[-1], before[j - 1] + 1)
        before, last = last, row
    return last[-1]
