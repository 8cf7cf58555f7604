"""Write what was learned from experiences as lines of text and plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deixis.workflows.knowledge.episodes import Consolidation


def consolidated_lines(done: Consolidation) -> Iterator[str]:
    """Yield a line for each experience that taught a lesson, and for each other one the reason.

    Parameters
    ----------
    done
        Answer of ``deixis episodes consolidate``.

    Yields
    ------
    str
        A line of text.
    """
    yield from (f"{name}: lesson {lesson}" for name, lesson in done.lessons.items())
    yield from (f"left out    {name}: {reason}" for name, reason in done.left_out.items())
    if not done.lessons:
        yield "Nothing was learned."


def consolidated_to_dict(done: Consolidation) -> dict[str, Any]:
    """Return the lessons and the reasons as plain data.

    Parameters
    ----------
    done
        Answer of ``deixis episodes consolidate``.

    Returns
    -------
    dict
        The object that ``deixis episodes consolidate --json`` prints.
    """
    return {"lessons": done.lessons, "left_out": done.left_out}


def consolidated_rows(done: Consolidation) -> Iterator[dict[str, Any]]:
    """Yield a row for each experience.

    Parameters
    ----------
    done
        Answer of ``deixis episodes consolidate``.

    Yields
    ------
    dict
        ``experience``, its ``lesson`` or None, and the ``reason`` why it taught nothing or None.
    """
    for name, lesson in done.lessons.items():
        yield {"experience": name, "lesson": lesson, "reason": None}
    for name, reason in done.left_out.items():
        yield {"experience": name, "lesson": None, "reason": reason}
