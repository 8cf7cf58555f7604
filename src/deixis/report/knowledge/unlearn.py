"""Write what was taken back as lines of text and plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deixis.workflows.knowledge.unlearn import Unlearned


def unlearned_lines(found: Unlearned) -> Iterator[str]:
    """Yield a line for each lesson and each view, and a last line with their numbers.

    Parameters
    ----------
    found
        Answer of ``deixis unlearn``.

    Yields
    ------
    str
        A line of text.
    """
    for lesson in found.lessons:
        yield f"lesson {lesson}"
    for change in found.views:
        sources = ", ".join(change.sources)
        if change.category is None:
            yield f"view {change.view}: no longer a view of '{change.before}' ({sources}), forgotten"
        elif change.category == change.before:
            yield f"view {change.view}: still a view of '{change.category}', without {sources}"
        else:
            yield f"view {change.view}: '{change.before}' ({sources}) is '{change.category}' again"
    if found.fluents:
        yield f"fluents {', '.join(found.fluents[:20])}{' …' if len(found.fluents) > 20 else ''}"
    summary = found.summary()
    for lesson in found.revised:
        yield f"lesson {lesson}: learned again from its other sentences"
    yield f"{summary[0].upper()}{summary[1:]}." if found else "Nothing that was taught matches."


def unlearned_to_dict(found: Unlearned) -> dict[str, Any]:
    """Return the lessons and views as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis unlearn``.

    Returns
    -------
    dict
        The object that ``deixis unlearn --json`` prints.
    """
    views = [
        {
            "view": change.view,
            "before": change.before,
            "category": change.category,
            "sources": list(change.sources),
        }
        for change in found.views
    ]
    return {
        "lessons": list(found.lessons),
        "views": views,
        "fluents": list(found.fluents),
        "revised": list(found.revised),
    }
