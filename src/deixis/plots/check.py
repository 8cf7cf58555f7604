"""A checked table as a picture: what is misplaced, miscoloured, missing, extra and undetermined."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.plots.figure import save
from deixis.plots.grounding import Marks, grounding_figure
from deixis.reasoning.comparison.checking import RoleVerdict
from deixis.workflows.belonging import places_of
from deixis.workflows.check import Check

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_check(checked: Check, path: str | Path) -> None:
    """Draw the table from above: what is misplaced or extra in red, what is undetermined dotted, and the verdict.

    What is of another colour is hatched.
    """
    save(check_figure(checked), path)


def check_figure(checked: Check, axes: Axes | None = None) -> Figure:
    """Draw what is wrong with a table, into axes or into a new figure, which is returned."""
    table = checked.table
    found = [
        _listed("missing", [entry.role for entry in table.of(RoleVerdict.MISSING)]),
        _listed("misplaced", [entry.role for entry in table.of(RoleVerdict.MISPLACED)]),
        _listed("of another colour", [entry.role for entry, _ in table.miscoloured]),
        _listed("extra", [entry.label or entry.perceived for entry in table.extra]),
    ]
    summary = "; ".join(part for part in found if part) or "nothing wrong"
    title = f"{checked.layout.title or checked.layout.name}: {summary}"
    return grounding_figure(checked.table.grounding, checked.scene, title, marks_of(checked), axes)


def marks_of(checked: Check) -> Marks:
    """Return what the picture marks; a thing that is both misplaced and of another colour has both marks."""
    table = checked.table
    wrong = {entry.perceived for entry in table.of(RoleVerdict.MISPLACED) if entry.perceived is not None}
    return Marks(
        wrong=wrong | {entry.perceived for entry in table.extra},
        miscoloured={entry.perceived for entry, _ in table.miscoloured if entry.perceived is not None},
        belongs=places_of(checked),
        unsure={entry.perceived for entry in table.of(RoleVerdict.UNDETERMINED) if entry.perceived is not None},
    )


def _listed(what: str, names: Sequence[str]) -> str:
    """Up to two names, or how many there are."""
    if not names:
        return ""
    return f"{what} " + (", ".join(names).replace("_", " ") if len(names) < 3 else str(len(names)))
