"""A memory with lessons, views and episodes, and every write over several of them: to be killed by tests."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import deixis
from deixis.learning.update import stale
from deixis.memory.episodes.blackboard import Blackboard, open_episodes
from deixis.memory.episodes.experiences import finish_recording, put_episode, start_recording
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.perceptual.in_folder import export_all
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.verify import verify
from deixis.ontology.tbox import default_ontology
from deixis.robot.robot import Robot
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
        robot = (
            "import deixis; from deixis.robot.robot import Robot; robot = Robot(session); "
            f"robot.sees(deixis.read_scene({self.scene(4)!r}), 60.0); "
        )
        consolidating = (
            "from deixis.memory.episodes.blackboard import Blackboard; "
            "from deixis.workflows.knowledge.episodes import consolidate; consolidate(Blackboard.open(folder), session)"
        )
        return {
            "told": f"{robot} robot.told({TEA!r}, 'Ada', 61.0)",
            "shown": f"{robot} robot.shown('gizmo', 'o1', 'Ada', 61.0)",
            "consolidate": consolidating,
            "learn": f"session.learn({self.script!r}, {self.scene(4)!r})",
            "learn a batch": f"session.learn_all([({self.script!r}, {self.scene(4)!r})] * 3)",
            "teach otherwise": f"session.teach({self.scene(3)!r}, 'o1', 'gizmo')",
            "forget a lesson": "session.forget('tea-1')",
            "take back a table": (
                "from deixis.workflows.knowledge.unlearn import Selection; "
                f"session.unlearn(Selection(table={self.scene(3)!r}))"
            ),
            "take back a teacher": (
                "from deixis.workflows.knowledge.unlearn import Selection; session.unlearn(Selection(teacher='Ada'))"
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
    robot = Robot(made.memory)
    with Blackboard.open(made.memory, create=True) as board:
        start_recording(board, "dinner", 1.0, "test")
        robot.sees(deixis.read_scene(made.scene(3)), 2.0)
        robot.told(TEA, "Ada", 3.0)
        robot.shown("fork", robot.lessons[0].settled["fork"].thing, "Ada", 4.0)
        finish_recording(board, "dinner", 5.0, "test")
        assert robot.consolidate().lessons == {"dinner": "tea-1"}
        put_episode(board, "supper", list(_supper()), 10.0, 20.0, "test")
    robot.close()
    with Session(folder / "other") as session:
        session.learn(made.script, made.scene(5))
        (folder / "concepts.trig").write_text(export_memory(session.memory()).replace("tea-1", "tea-9"))
    export_all(folder / "other", folder / "views.zip")
    return made


def _supper() -> Iterator[EpisodicFluent]:
    """Yield what holds in an experience that is not consolidated yet."""
    said = Source(Origin.SAID, "Bob", "sentence 7")
    yield episodic("s1", ("Bob", "said", "fork left of plate"), start=12.0, source=said)
    for place, name in enumerate(("fork", "plate")):
        box = str([place, 0.0, 0.0, place + 0.1, 0.2, 0.1])
        yield episodic(f"s2{place}", (f"x{place}", "at", box), start=11.0, source=Source(Origin.SEEN, "tracker"))
        yield episodic(f"s3{place}", (f"x{place}", "isA", name), start=11.0, source=Source(Origin.SEEN, "tracker"))


def recorded(memory: Path) -> list[Any]:
    """Return everything that the episodes of a memory state except what was seen, without times."""
    with open_episodes(memory) as board:
        told = () if board is None else board.holding()
        return [(each.id, each.statement, each.source) for each in told if each.source.origin is not Origin.SEEN]


def state(memory: Path) -> Any:
    """Return everything in a memory except times and what was seen."""
    episodes = recorded(memory)
    with Session(memory) as session:
        text = TIMES.sub("time", export_memory(session.memory())) if session.remembers() else ""
        if not session.has_views():
            return text, (), {}, episodes
        views = [(key.category, key.id) for key in session.views().listing()]
        return text, tuple(views), session.views().lessons_of_views(), episodes


def findings(memory: Path, inferred: bool = True) -> tuple[str, ...]:
    """Verify a memory, with or without its inferred facts, and return the findings as text."""
    worked_out = (lambda store: stale(store, default_ontology())) if inferred else None
    return tuple(map(str, verify(memory, None, worked_out).findings)) if memory.exists() else ()
