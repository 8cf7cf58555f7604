"""A memory with lessons and views, and every write over both stores: for tests and benchmarks that kill them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import deixis
from deixis.learning.update import stale
from deixis.memory.perceptual.in_folder import export_all
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.verify import verify
from deixis.ontology.tbox import default_ontology
from deixis.session import Session
from deixis.workflows.layouts.lay_table import lay_script
from deixis.workflows.scenes.simulate import simulate

TEA = "layout tea\nfork left of plate; knife right of plate\n"
TIMES = re.compile(r'"[^"]*"\^\^xsd:dateTime')


@dataclass(frozen=True)
class Example:
    """A folder with a memory that learned one table, and with all that further writes to it need."""

    folder: Path

    @property
    def memory(self) -> Path:
        return self.folder / "memory"

    @property
    def script(self) -> str:
        return str(self.folder / "tea.layout")

    def scene(self, seed: int) -> str:
        """Return the file of a perceived table; table 3 was learned, tables 4 and 5 were not."""
        return str(self.folder / f"{seed}.scene.json")

    def writes(self) -> dict[str, str]:
        """Return the code of each write by name; it uses ``session``, whose memory is a copy in ``folder``."""
        views, concepts = str(self.folder / "views.zip"), str(self.folder / "concepts.trig")
        importing = (
            "from pathlib import Path; from deixis.memory.perceptual.in_folder import import_all; "
            f"import_all(Path({views!r}), Path(folder))"
        )
        return {
            "learn": f"session.learn({self.script!r}, {self.scene(4)!r})",
            "learn a batch": f"session.learn_all([({self.script!r}, {self.scene(4)!r})] * 3)",
            "teach otherwise": f"session.teach({self.scene(3)!r}, 'o1', 'gizmo')",
            "forget a lesson": "session.forget('tea-1')",
            "take back a table": (
                "from deixis.workflows.knowledge.unlearn import Selection; "
                f"session.unlearn(Selection(table={self.scene(3)!r}))"
            ),
            "forget a category": "session.forget_category('plate')",
            "rename": "session.rename_category('fork', 'prongs')",
            "merge": "session.merge_categories('fork', 'knife')",
            "import concepts": f"session.import_({concepts!r})",
            "import concepts into a new memory": f"session.import_({concepts!r})",
            "import views": importing,
        }

    def begin(self, write: str) -> Path | None:
        """Return the memory that a write starts from, or None for a new memory."""
        return None if write.endswith("new memory") else self.memory


def example_in(folder: Path) -> Example:
    """Make an example."""
    made = Example(folder)
    Path(made.script).write_text(TEA)
    for seed in (3, 4, 5):
        cloud = simulate(lay_script(deixis.read_script(text=TEA), seed=seed), seed=seed).cloud
        deixis.write_scene(deixis.perceive(cloud), made.scene(seed))
    with Session(made.memory) as session:
        session.learn(made.script, made.scene(3))
    with Session(folder / "other") as session:
        session.learn(made.script, made.scene(5))
        (folder / "concepts.trig").write_text(export_memory(session.memory()).replace("tea-1", "tea-9"))
    export_all(folder / "other", folder / "views.zip")
    return made


def state(memory: Path) -> Any:
    """Everything in a memory but times."""
    with Session(memory) as session:
        text = TIMES.sub("time", export_memory(session.memory())) if session.remembers() else ""
        if not session.has_views():
            return text, (), {}
        views = [(key.category, key.id) for key in session.views().listing()]
        return text, tuple(views), session.views().lessons_of_views()


def findings(memory: Path, inferred: bool = True) -> tuple[str, ...]:
    """Verify a memory, with or without its inferred facts, and return the findings as text."""
    worked_out = (lambda store: stale(store, default_ontology())) if inferred else None
    return tuple(map(str, verify(memory, None, worked_out).findings)) if memory.exists() else ()
