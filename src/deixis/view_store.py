"""The perceptual memory of a session, opened on demand, and recognition by its views."""

from __future__ import annotations

import json
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from deixis.memory.on_demand import OnDemand
from deixis.memory.owner import Closing
from deixis.ontology.things.kinds import plain_name
from deixis.perception.errors import SceneError

if TYPE_CHECKING:
    from deixis.learning.views.views import KeptName, Known, Taught
    from deixis.memory.perceptual.database.handle import WriteBatch
    from deixis.memory.perceptual.level import LevelMemory
    from deixis.memory.perceptual.protocol import Progress
    from deixis.memory.perceptual.records import View
    from deixis.ontology.lessons.types import Match
    from deixis.perception.scene import Scene

Done = TypeVar("Done")

SETTLES = "settles"
"""Key in the metadata of a view: the lesson, and the role in it, whose thing the teaching names."""

UNKNOWN = "unknown"
"""Label of a thing that is of no category."""


class ViewStore(Closing):
    """Taught categories and their views; the memory stays open from the first call that needs it."""

    def __init__(self, path: Path) -> None:
        self._memory = OnDemand(path, _open)

    @property
    def path(self) -> Path:
        """The folder of the memory."""
        return self._memory.path

    def close(self) -> None:
        """Close the memory; a later call that needs it raises MemoryFormatError."""
        self._memory.close()

    def exists(self) -> bool:
        """Return whether the memory has views.

        Returns
        -------
        bool
            True if a view was taught.
        """
        from deixis.memory.perceptual.in_folder import has_views

        return self._memory.is_open or has_views(self.path)

    def memory(self, create: bool = False) -> LevelMemory:
        """Return the open perceptual memory.

        Parameters
        ----------
        create
            True to make a memory where there is none.

        Returns
        -------
        LevelMemory
            The store, open until the session ends.

        Raises
        ------
        DeixisError
            If there is no memory and ``create`` is False.
        """
        return self._memory.get(create)

    def category_meant(self, name: str) -> str:
        """Return the known category that a name stands for.

        Parameters
        ----------
        name
            A name, in any case.

        Returns
        -------
        str
            The category with this name, else the first that differs only in case, else the name itself.
        """
        from deixis.grammar.layout.names import key_of

        if not self.exists():
            return name
        known = self._despite_damage(self.memory(), lambda memory: memory.categories())
        alike = [category for category in known if key_of(category) == key_of(name)]
        return name if name in alike or not alike else alike[0]

    def keeping(
        self,
        views: Sequence[View],
        lessons: Mapping[str, str] | None = None,
        named: Sequence[tuple[View, str | None]] = (),
    ) -> tuple[WriteBatch, tuple[Taught, ...]]:
        """Return the change that stores views, and what each taught.

        Damaged stored views teach nothing; one that is stored again is repaired. Call this, and write the change, while
        ``memory(create=True).exclusive()`` is held.

        Parameters
        ----------
        views
            The views, each with its category.
        lessons
            Id of the lesson by the id of the view, for views that a lesson teaches.
        named
            All new teachings in turn, each a view and its lesson or None.

        Returns
        -------
        tuple
            The change, and what each view taught.
        """
        from deixis.learning.views.views import batch_of

        def change(readable: LevelMemory) -> tuple[WriteBatch, tuple[Taught, ...]]:
            batch, taught = batch_of(readable, views, lessons, named)
            return readable.writing(batch), taught

        return self._despite_damage(self.memory(create=True), change)

    def except_taught(self, views: Sequence[View]) -> tuple[list[View], tuple[KeptName, ...]]:
        """Return the views of a grounding that no teacher has named, and the things that a teacher named otherwise.

        Parameters
        ----------
        views
            Views of a grounding, each with the category of its match.

        Returns
        -------
        tuple
            Views to keep, and the names that stay as taught.
        """
        from deixis.learning.views.views import KeptName, taught_by_hand

        named = taught_by_hand(self.memory(), views) if self.exists() else {}
        kept = []
        for view in views:
            taught = named.get(view.id)
            if taught is not None and taught.category != view.category:
                thing, teacher = (str(taught.metadata.get(key, "?")) for key in ("object", "teacher"))
                kept.append(KeptName(thing, taught.category, teacher, view.category))
        return [view for view in views if view.id not in named], tuple(kept)

    def known(
        self, frame: str, progress: Progress | None = None, left_out: Callable[[str], None] | None = None
    ) -> Known:
        """Return the recogniser of the taught categories in a frame; it knows nothing where nothing was taught.

        Parameters
        ----------
        frame
            Name of the frame of the views.
        progress
            Called while views are read and calibrated, which takes seconds for many views.
        left_out
            Called with a line about damaged views, which teach nothing.

        Returns
        -------
        Known
            The recogniser.
        """
        from deixis.learning.views.views import nothing_known, recogniser_of

        if not self.exists():
            return nothing_known(frame)
        return self._despite_damage(self.memory(), lambda memory: recogniser_of(memory, frame, progress), left_out)

    def settled_roles(self) -> dict[tuple[str, str], dict[str, str]]:
        """Return the roles of lessons whose things were named after the lesson.

        Returns
        -------
        dict
            Id of the thing by role, by the id of the lesson and the key of the boxes of its scene
            (:func:`deixis.learning.views.teachings.boxes_key`); the teaching that came last counts.
        """
        return self._despite_damage(self.memory(), _settled) if self.exists() else {}

    def _despite_damage(
        self, memory: LevelMemory, work: Callable[[LevelMemory], Done], left_out: Callable[[str], None] | None = None
    ) -> Done:
        """Return the result of an action on all views, or on the undamaged ones where some are damaged."""
        from deixis.memory.errors import DamagedMemoryError
        from deixis.memory.perceptual.in_folder import open_undamaged

        try:
            return work(memory)
        except DamagedMemoryError:
            with open_undamaged(self.path) as readable:
                done = work(readable)
                if left_out is not None:
                    damage = "; ".join(readable.left_out)
                    left_out(f"left out, as damaged: {damage}; 'deixis memory verify' lists all damage")
            return done

    def categories(self, left_out: Callable[[str], None] | None = None) -> dict[str, int]:
        """Return the number of views of each taught category.

        Parameters
        ----------
        left_out
            Called with a line about damaged views, which are not counted.

        Returns
        -------
        dict
            Number of views by the name of the category.
        """
        if not self.exists():
            return {}
        return self._despite_damage(self.memory(), _counted, left_out)


def _open(path: Path, create: bool) -> LevelMemory:
    from deixis.memory.perceptual.in_folder import open_in

    return open_in(path, create)


def _counted(memory: LevelMemory) -> dict[str, int]:
    return {name: sum(1 for _ in memory.listing(name)) for name in memory.categories()}


def _settled(memory: LevelMemory) -> dict[tuple[str, str], dict[str, str]]:
    from deixis.learning.views.teachings import Teaching
    from deixis.memory.perceptual.database import keys

    stored, found = memory.teachings(), []
    for view in memory.headers():
        turns = [Teaching.read(entry) for entry in stored.get(view.id, ())]
        turns = turns or [Teaching(view.category, keys.moment(view.time), json.loads(view.metadata))]
        found += [turn for turn in turns if SETTLES in turn.metadata]
    settled: dict[tuple[str, str], dict[str, str]] = {}
    for turn in sorted(found, key=lambda turn: turn.time):
        lesson, role = turn.metadata[SETTLES]
        settled.setdefault((lesson, str(turn.metadata["boxes"])), {})[role] = str(turn.metadata["object"])
    return settled


def views_of_matches(
    scene: Scene, matches: Iterable[Match], category_of: Callable[[Match], str] = attrgetter("object")
) -> list[View]:
    """Return a view of each decided thing that has a cloud in the scene, under the name of its object.

    Parameters
    ----------
    scene
        The scene.
    matches
        Matches of a grounding.
    category_of
        Function that returns the name of the category of a match; by default, that of its object.

    Returns
    -------
    list of View
        The views, in the order of the matches.

    Raises
    ------
    SceneError
        If two things have the same points.
    """
    from deixis.learning.views.teachings import GROUNDING

    seen = [match for match in matches if match.decided and scene[match.perceived].cloud is not None]
    views = [view_of_thing(scene, match.perceived, plain_name(category_of(match)), GROUNDING) for match in seen]
    first: dict[str, str] = {}
    for match, view in zip(seen, views, strict=True):
        if first.setdefault(view.id, match.perceived) != match.perceived:
            raise SceneError(
                f"{scene.file}: the clouds of '{first[view.id]}' and '{match.perceived}' are the same points;"
                " perceive the table again, or name no cloud for one of them"
            )
    return views


def view_of_thing(
    scene: Scene,
    object_id: str,
    category: str,
    teacher: str,
    settles: tuple[str, str] | None = None,
    event: str | None = None,
) -> View:
    """Return a view of a thing of a scene, ready to be stored.

    Parameters
    ----------
    scene
        The scene.
    object_id
        Id of the thing.
    category
        Name of the category.
    teacher
        Name of the person who named it.
    settles
        Id of a lesson and a role in it, of which this is the thing; kept in the metadata.
    event
        Event in the episodes in which the teacher showed it; kept in the metadata.

    Returns
    -------
    View
        The view, with its descriptors.

    Raises
    ------
    SceneError
        If the scene has no points of the thing.
    """
    from deixis.learning.views.teachings import boxes_key
    from deixis.learning.views.views import view_of
    from deixis.memory.episodes.fluents.episode import EVENT

    file = scene.file if scene.file.startswith("<") else str(Path(scene.file).absolute())
    metadata: dict[str, object] = {"scene": file, "boxes": boxes_key(scene), "object": object_id, "teacher": teacher}
    if settles is not None:
        metadata = {**metadata, SETTLES: list(settles)}
    if event is not None:
        metadata = {**metadata, EVENT: event}
    return view_of(scene.cloud_of(object_id), scene.frame, category, datetime.now(UTC), metadata)


def category_name(text: str) -> str:
    """Return the name of a category as scripts write it, such as ``dinner_fork`` for ``dinner fork``.

    Parameters
    ----------
    text
        A name.

    Returns
    -------
    str
        The name with underscores.

    Raises
    ------
    SettingError
        If the name is empty.
    """
    from deixis.reasoning.errors import SettingError

    name = "_".join(text.split())
    if not name:
        raise SettingError("the name of a category must have at least one word, got none")
    return name


def new_category_name(text: str) -> str:
    """Return the name of a category to teach, as :func:`category_name` writes it.

    Parameters
    ----------
    text
        A name.

    Returns
    -------
    str
        The name with underscores.

    Raises
    ------
    SettingError
        If the name is empty, if no scene can have it as a label, or if it is the label of unknown things.
    """
    from deixis.reasoning.errors import SettingError

    name = category_name(text)
    if any(unicodedata.category(character) == "Cc" for character in name):
        raise SettingError(f"the name of a category must not have control characters, got {name!a}")
    if name.lower() == UNKNOWN:
        raise SettingError(f"'{name}' is the label of things of no known category; choose another word")
    return name
