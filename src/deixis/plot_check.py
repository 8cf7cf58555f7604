"""A checked table as a picture: what is misplaced, missing, extra and undetermined."""

from __future__ import annotations

from pathlib import Path

from deixis.perception.scene import Scene
from deixis.plot import grounding_figure, save
from deixis.reasoning.checking import Verdict
from deixis.session import Checked


def plot_check(checked: Checked, scene: Scene, path: str | Path) -> None:
    """Draws the table from above: misplaced things in red with what is said of them, missing ones named below it."""
    table = checked.table
    wrong = {entry.perceived for entry in table.of(Verdict.MISPLACED) if entry.perceived is not None}
    extra = {entry.perceived for entry in table.extra}
    title = checked.layout.title or checked.layout.name
    missing = [entry.role.replace("_", " ") for entry in table.of(Verdict.MISSING)]
    verdict = "nothing wrong" if table.well else "missing: " + (", ".join(missing) or "nothing")
    save(grounding_figure(table.grounding, scene, f"{title} — {verdict}", wrong=wrong | extra), path)
