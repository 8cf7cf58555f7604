"""Pictures of checked tables: misplaced, turned, miscoloured, missing, extra and undetermined things."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.plots.figure import save
from deixis.plots.grounding import Marks, grounding_figure
from deixis.reasoning.comparison.checking import RoleVerdict
from deixis.workflows.grounding.belonging import places_of
from deixis.workflows.grounding.check import Check

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_check(checked: Check, path: str | Path) -> None:
    """Draw the table and the verdict: misplaced, turned and extra things in orange, undetermined ones dotted.

    Things of a wrong colour are hatched.

    Parameters
    ----------
    checked
        The check.
    path
        File of the picture; its ending says which format.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    """
    save(check_figure(checked), path)


def check_figure(checked: Check, axes: Axes | None = None) -> Figure:
    """Draw a checked table into axes or into a new figure.

    Parameters
    ----------
    checked
        The check.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    table = checked.table
    found = [
        _listed("missing", [entry.role for entry in table.of(RoleVerdict.MISSING)]),
        _listed("misplaced", [entry.role for entry in table.of(RoleVerdict.MISPLACED)]),
        _listed("turned", [entry.role for entry in table.turned]),
        _listed("of another colour", [entry.role for entry, _ in table.miscoloured]),
        _listed("extra", [entry.label or entry.perceived for entry in table.extra]),
    ]
    summary = "; ".join(part for part in found if part) or "nothing wrong"
    title = f"{checked.layout.title or checked.layout.name}: {summary}"
    return grounding_figure(checked.table.grounding, checked.scene, title, marks_of(checked), axes)


def marks_of(checked: Check) -> Marks:
    """Return the marks of the picture; a thing that is both misplaced and miscoloured has both marks.

    Parameters
    ----------
    checked
        The check.

    Returns
    -------
    Marks
        The ids of the things by mark.
    """
    table = checked.table
    wrong = {entry.perceived for entry in table.of(RoleVerdict.MISPLACED) if entry.perceived is not None}
    wrong |= {entry.perceived for entry in table.turned if entry.perceived is not None}
    return Marks(
        wrong=wrong | {entry.perceived for entry in table.extra},
        miscoloured={entry.perceived for entry, _ in table.miscoloured if entry.perceived is not None},
        belongs=places_of(checked),
        unsure={entry.perceived for entry in table.of(RoleVerdict.UNDETERMINED) if entry.perceived is not None},
    )


def _listed(what: str, names: Sequence[str]) -> str:
    """Return up to two names, or their number."""
    if not names:
        return ""
    return f"{what} " + (", ".join(names).replace("_", " ") if len(names) < 3 else str(len(names)))
