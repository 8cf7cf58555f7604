"""Tables of words, written as text: a key, a colon and its words, with commas between phrases."""

from __future__ import annotations


def word_set(text: str) -> frozenset[str]:
    """Return the words of a text as a set.

    Parameters
    ----------
    text
        Words with spaces or line ends between them.

    Returns
    -------
    frozenset of str
        Words, each once.
    """
    return frozenset(text.split())


def table(text: str) -> dict[str, tuple[str, ...]]:
    """Read a table of words.

    Parameters
    ----------
    text
        Lines with a key, a colon and words or phrases with commas between them.

    Returns
    -------
    dict of str to tuple of str
        Words by their key; lines with the same key are joined.
    """
    found: dict[str, tuple[str, ...]] = {}
    for line in text.strip().splitlines():
        key, _, words = line.partition(":")
        entries = tuple(word.strip() for word in words.split(",") if word.strip())
        found[key.strip()] = found.get(key.strip(), ()) + entries
    return found


def inverted(table: dict[str, tuple[str, ...]]) -> dict[str, str]:
    """Return the key of each word of a table.

    Parameters
    ----------
    table
        Words by their key.

    Returns
    -------
    dict of str to str
        Keys by word; of a word with several keys, the last one.
    """
    return {word: key for key, words in table.items() for word in words}


LITERAL = "\u02bc"
"""First and last letter, in ``Word.norm``, of a name that is taken as it is: ``left_shoe``, or words in backticks."""
