"""The robot: it sees tables, is shown things and told layouts, learns from it, and says what is wrong with the next.

One session is its memory. A text that it reads is grounded in the table that it sees; what is decided is taught at
once, and what is doubtful waits. Every table of a layout adds to the experience of that layout.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.errors import DeixisError
from deixis.grammar.errors import ScriptError
from deixis.grammar.script import Script
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.robot.layouts import Experience, LearnedLayout
from deixis.robot.looking import Fault, Look, TableKnowledge
from deixis.session import Session

if TYPE_CHECKING:
    from deixis.learning.views import Taught
    from deixis.workflows.learn import Learned


class RobotError(DeixisError, ValueError):
    """Error for what a robot cannot do now, such as naming things before it sees any."""


@dataclass(frozen=True, eq=False)
class Told:
    """Result of a text: the layout, the lesson with its grounding, and what each role was matched with."""

    layout: str
    learned: Learned
    taught: tuple[str, ...]
    waiting: tuple[str, ...]
    questions: int = 0


class Robot:
    """A robot with one memory over time.

    Parameters
    ----------
    memory
        The session, or the folder of its memory.

    Notes
    -----
    Things are named by their ids in the scene that is seen now. Methods are called by one thread at a time.
    """

    def __init__(self, memory: Session | str | Path) -> None:
        self.session = memory if isinstance(memory, Session) else Session(memory)
        self.layouts: dict[str, LearnedLayout] = {}
        self._scene: Scene | None = None
        self._look: Look | None = None
        self._knowledge: TableKnowledge | None = None

    def close(self) -> None:
        """Close the memory."""
        self.session.close()

    # ---- seeing

    @property
    def scene(self) -> Scene:
        """The scene that is seen now.

        Raises RobotError before the first one.
        """
        if self._scene is None:
            raise RobotError("the robot must see a table first; call sees() with a scene or a cloud")
        return self._scene

    def sees(self, scene: Scene | PointCloud) -> Scene:
        """Take a scene as the present situation.

        Parameters
        ----------
        scene
            A scene, or a cloud in which the things are then detected.

        Returns
        -------
        Scene
            The scene.
        """
        if isinstance(scene, PointCloud):
            scene = perceived(scene)
        self._scene, self._look = scene, None
        return scene

    def knowledge(self) -> TableKnowledge:
        """Return what was learned so far, as far as looking at a table needs it.

        Returns
        -------
        TableKnowledge
            The recogniser, the layouts, words and sizes.
        """
        if self._knowledge is None:
            frame = self._scene.frame if self._scene is not None else "table"
            known = self.session.view_store.known(frame)
            layouts = tuple(self.layouts[name] for name in sorted(self.layouts))
            self._knowledge = TableKnowledge(known, layouts, self.session.meaning(), self.session.ontology)
        return self._knowledge

    def look(self) -> Look:
        """Return how the present scene is understood.

        Returns
        -------
        Look
            Layouts, names and mistakes.
        """
        if self._look is None:
            self._look = self.knowledge().look(self.scene)
        return self._look

    def names(self) -> Mapping[str, Mapping[str, float]]:
        """Return the names that each thing may have, with their probabilities.

        Returns
        -------
        mapping
            Probability by name, by id of the thing.
        """
        return self.look().names

    def layout(self) -> str | None:
        """Return the layout that lies here.

        Returns
        -------
        str or None
            Its name; None if it is probably none that is known.
        """
        return self.look().layout

    def check(self, layout: str | None = None) -> tuple[Fault, ...]:
        """Return what is wrong with the present table.

        Parameters
        ----------
        layout
            Name of the layout to compare with; None for the one that lies here.

        Returns
        -------
        tuple of Fault
            The mistakes.

        Raises
        ------
        RobotError
            If there is no layout of that name.
        """
        if layout is not None and layout not in self.layouts:
            known = ", ".join(sorted(self.layouts)) or "none"
            raise RobotError(f"`layout` must be a layout that the robot knows, got '{layout}'; there are: {known}")
        return self.look().faults(layout)

    # ---- being taught

    def shown(self, label: str, thing: str, by: str = "user") -> Taught:
        """Learn what a thing looks like that a person points at and names.

        Parameters
        ----------
        label
            Name of the thing.
        thing
            Id of the thing in the present scene.
        by
            Name of the person.

        Returns
        -------
        Taught
            The stored view.
        """
        taught = self.session.teach(self.scene, thing, label, by)
        self._forget_look()
        return taught

    def told(self, text: str | Script) -> Told:
        """Learn the layout that a text describes from the table that is seen.

        Parameters
        ----------
        text
            A script in the layout language or in English, as text or parsed.

        Returns
        -------
        Told
            The layout, the grounding, and what was taught and what waits.
        """
        script = text if isinstance(text, Script) else understood(text, self.session)
        seen = self.knowledge().recognised(self.scene)
        learned = self.session.learn(script, seen)
        layout = LearnedLayout.told(script)
        name = layout.name
        known = self.layouts.get(name, layout)
        matches = learned.grounding.object_matches
        things: dict[str, PerceivedObject] = {
            role: seen[match.perceived]
            for role, match in matches.items()
            if role in known.roles and (match.probability is None or match.probability >= 0.5)
        }
        table = Experience.of_table(known.roles, things, self.session.ontology.relations)
        self.layouts[name] = LearnedLayout(name, known.script, known.experience + table)
        self._forget_look()
        taught = learned.categories
        waiting = tuple(role for role in known.roles if role not in taught)
        return Told(name, learned, taught, waiting)

    def _forget_look(self) -> None:
        self._look = self._knowledge = None


def perceived(cloud: PointCloud) -> Scene:
    """Return the things in a cloud; parts of a thing that another thing hides in the middle are one thing.

    Parameters
    ----------
    cloud
        The cloud, in metres.

    Returns
    -------
    Scene
        The scene in the frame of the table.
    """
    from deixis.perception.occlusion import joined_behind_others
    from deixis.workflows.perceive import perceive

    return joined_behind_others(perceive(cloud))


def understood(text: str, session: Session) -> Script:
    """Read a text as a layout script, or else as English.

    Parameters
    ----------
    text
        The text.
    session
        Session with the words.

    Returns
    -------
    Script
        The script.

    Raises
    ------
    ScriptError
        If it is neither.
    """
    from deixis.workflows.read import read_script

    try:
        return read_script(text=text, ontology=session.ontology)
    except ScriptError:
        return read_script(text=text, ontology=session.ontology, english=True)
