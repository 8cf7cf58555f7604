"""A checked table as a picture: what is misplaced, miscoloured, missing, extra and undetermined."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from deixis.perception.scene import Scene
from deixis.plot import grounding_figure, save
from deixis.reasoning.checking import Verdict
from deixis.session import Checked


def plot_check(checked: Checked, scene: Scene, path: str | Path) -> None:
    """Draws the table from above: what is wrong with a thing in red, what is undetermined dotted, and the verdict."""
    table = checked.table
    wrong = {entry.perceived for entry in table.of(Verdict.MISPLACED) if entry.perceived is not None}
    wrong |= {entry.perceived for entry, _ in table.miscoloured if entry.perceived is not None}
    wrong |= {entry.perceived for entry in table.extra}
    unsure = {entry.perceived for entry in table.of(Verdict.UNDETERMINED) if entry.perceived is not None}
    title = f"{checked.layout.title or checked.layout.name}: {_summary(checked)}"
    save(grounding_figure(table.grounding, scene, title, wrong, unsure), path)


def _summary(checked: Checked) -> str:
    table = checked.table
    found = [
        _listed("missing", [entry.role for entry in table.of(Verdict.MISSING)]),
        _listed("misplaced", [entry.role for entry in table.of(Verdict.MISPLACED)]),
        _listed("of another colour", [entry.role for entry, _ in table.miscoloured]),
        _listed("extra", [entry.label or entry.perceived for entry in table.extra]),
    ]
    return "; ".join(part for part in found if part) or "nothing wrong"


def _listed(what: str, names: Sequence[str]) -> str:
    """Up to two names, or how many there are."""
    if not names:
        return ""
    return f"{what} " + (", ".join(names).replace("_", " ") if len(names) < 3 else str(len(names)))
