"""The paper's figures and tables again, each a module with a ``run`` function."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from deixis.ontology.errors import UnknownTermError

if TYPE_CHECKING:
    from deixis.experiments.figure6 import Figure6


def run_experiment(name: str, out: Path, variants: int, orders: int, seed: int) -> Figure6:
    """Runs the experiment of that name; pictures go to ``out``. Raises UnknownTermError where there is none."""
    if name != "figure6":
        raise UnknownTermError(f"there is no experiment '{name}'; the experiments are: figure6")
    from deixis.experiments.figure6 import run

    return run(out, variants=variants, orders=orders, seed=seed)
