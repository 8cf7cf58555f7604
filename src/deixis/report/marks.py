"""Marks of doubt and of violations on the lines of a report, which the terminal shows in colour."""

from __future__ import annotations

from enum import Enum


class Mark(Enum):
    """Meaning of a marked line."""

    DOUBT = "doubt"
    VIOLATION = "violation"


class MarkedLine(str):
    """Line of text with a mark; any operation on it returns a plain text."""

    __slots__ = ("mark",)
    mark: Mark

    def __new__(cls, text: str, mark: Mark) -> MarkedLine:
        """Return a text with a mark."""
        line = super().__new__(cls, text)
        line.mark = mark
        return line


def doubt(text: str, is_doubtful: bool = True) -> str:
    """Mark a line about what is not certain; return it as it is where ``is_doubtful`` is False.

    Parameters
    ----------
    text
        Line of a report.
    is_doubtful
        False if the line is certain and needs no mark.

    Returns
    -------
    str
        A :class:`MarkedLine` with the mark ``DOUBT``, or the text itself.
    """
    return MarkedLine(text, Mark.DOUBT) if is_doubtful else text


def violation(text: str, is_violation: bool = True) -> str:
    """Mark a line about what is wrong; return it as it is where ``is_violation`` is False.

    Parameters
    ----------
    text
        Line of a report.
    is_violation
        False if nothing is wrong and the line needs no mark.

    Returns
    -------
    str
        A :class:`MarkedLine` with the mark ``VIOLATION``, or the text itself.

    Examples
    --------
    >>> violation("misplaced    fork"), violation("misplaced    fork").mark
    ('misplaced    fork', <Mark.VIOLATION: 'violation'>)
    """
    return MarkedLine(text, Mark.VIOLATION) if is_violation else text
