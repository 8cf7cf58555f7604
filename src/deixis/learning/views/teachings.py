"""All teachings of a view: every time that a person or a lesson said what it shows.

A view has the category of one of its teachings: what a person said last, else what a lesson said last. The others are
kept beside it, so that any of them can be taken back, in any order, and what is left is what would be there without it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime

from deixis.memory.perceptual.records import Json
from deixis.perception.scene import Scene

GROUNDING = "grounding"
"""Name of the teacher of views that come from a grounding."""


@dataclass(frozen=True)
class Teaching:
    """One statement about a view: its category, with the time, the scene, and the person or lesson that stated it.

    ``metadata`` are those of the view: scene, boxes, object and teacher. ``lesson`` is None where a person
    stated it, and where its lesson was forgotten.
    """

    category: str
    time: datetime
    metadata: Json = field(default_factory=dict)
    lesson: str | None = None

    @property
    def teacher(self) -> str:
        """Name of the person, or :data:`GROUNDING`."""
        return str(self.metadata.get("teacher", GROUNDING))

    @property
    def is_by_hand(self) -> bool:
        """True if a person said it."""
        return self.teacher != GROUNDING

    def to_json(self) -> Json:
        """Return the teaching as JSON; :meth:`read` is the inverse.

        Returns
        -------
        Json
            Category, time, metadata and lesson.
        """
        entry = {"category": self.category, "time": self.time.isoformat(), "metadata": dict(self.metadata)}
        return entry if self.lesson is None else {**entry, "lesson": self.lesson}

    @classmethod
    def read(cls, entry: Json) -> Teaching:
        """Read a teaching from the JSON of :meth:`to_json`.

        Parameters
        ----------
        entry
            The JSON.

        Returns
        -------
        Teaching
            The teaching.
        """
        return cls(entry["category"], datetime.fromisoformat(entry["time"]), entry["metadata"], entry.get("lesson"))


Teachings = tuple[Teaching, ...]
"""All teachings of a view, in turn."""


def prevailing(turns: Sequence[Teaching]) -> Teaching:
    """Return the teaching that decides what a view shows.

    Parameters
    ----------
    turns
        One or more teachings, in turn.

    Returns
    -------
    Teaching
        The last one by a person, else the last one.

    Examples
    --------
    >>> from datetime import UTC
    >>> now = datetime(2026, 5, 1, tzinfo=UTC)
    >>> turns = [Teaching("cup", now, {"teacher": "Ada"}), Teaching("mug", now, {"teacher": GROUNDING}, "tea-1")]
    >>> prevailing(turns).category, prevailing(turns[1:]).category
    ('cup', 'mug')
    """
    by_hand = [turn for turn in turns if turn.is_by_hand]
    return (by_hand or list(turns))[-1]


def teachings_of(current: Teaching, stored: Sequence[Json], linked: Iterable[str] = ()) -> Teachings:
    """Return all teachings of a view.

    Parameters
    ----------
    current
        What the view itself says: its category, time, metadata and lesson.
    stored
        Its teachings as they are stored; empty where the view itself says all.
    linked
        All lessons that list the view. Those without a teaching taught it before teachings were stored.

    Returns
    -------
    Teachings
        The teachings, in turn.
    """
    turns = [Teaching.read(entry) for entry in stored] or [current]
    last = prevailing(turns)
    turns = [replace(turn, category=current.category) if turn is last else turn for turn in turns]
    lessons = {turn.lesson for turn in turns}
    older = [replace(current, lesson=name) for name in linked if name not in lessons]
    return (*older, *turns)


def written(turns: Sequence[Teaching]) -> list[Json]:
    """Return teachings as they are stored beside their view.

    Parameters
    ----------
    turns
        The teachings, in turn.

    Returns
    -------
    list of Json
        The teachings; none for a single one, which the view and its lesson state.
    """
    return [turn.to_json() for turn in turns] if len(turns) > 1 else []


def boxes_key(scene: Scene) -> str:
    """Return a key of the boxes of a scene, by which two tables in one file are kept apart.

    Parameters
    ----------
    scene
        The scene.

    Returns
    -------
    str
        Digest of the corners of all boxes, 16 characters.
    """
    return hashlib.sha256(scene.boxes.tobytes()).hexdigest()[:16]


def each_changed(
    stored: Mapping[str, Sequence[Json]], change: Callable[[Teaching], Teaching | None]
) -> dict[str, list[Json]]:
    """Return the stored teachings of the views of which a change alters one.

    Parameters
    ----------
    stored
        Teachings by the ids of views.
    change
        Function that returns the changed teaching, or None to leave it out.

    Returns
    -------
    dict
        New teachings, as they are stored, by the ids of the views that differ.
    """
    new: dict[str, list[Json]] = {}
    for view, entry in stored.items():
        before = [Teaching.read(each) for each in entry]
        after = [turn for turn in map(change, before) if turn is not None]
        if after != before:
            new[view] = written(after)
    return new
