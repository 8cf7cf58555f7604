"""Learn a lesson from a script and a scene: the layout, and the look of its objects."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.grammar.script import Script
from deixis.knowledge_store import KnowledgeStore
from deixis.ontology.lessons.types import ANONYMOUS
from deixis.perception.scene import Scene
from deixis.reasoning.errors import InconsistencyError, NothingFoundError
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT
from deixis.version import VERSION
from deixis.view_store import ViewStore, views_of_matches
from deixis.workflows.grounding.ground import GroundingRequest, answer
from deixis.workflows.layouts.read import as_scene, as_script
from deixis.workflows.scenes.views_of_lessons import keep_lessons

if TYPE_CHECKING:
    from deixis.learning.views.views import KeptName, Taught
    from deixis.memory.journal import Part
    from deixis.memory.perceptual.records import View
    from deixis.ontology.lessons.types import Lesson


Recording = Callable[["Sequence[Lesson]"], "Part | None"]
"""Function that returns the part of the blackboard in the write of new lessons."""


@dataclass(frozen=True, repr=False)
class Learned(Answer):
    """Result of learning one lesson: what it taught, and its grounding.

    Attributes
    ----------
    lesson
        The lesson as it is stored.
    grounding
        The grounding of the script in the scene.
    seen
        Views that the lesson taught, of things with clouds.
    kept_names
        Things that keep the name that a teacher gave them, though the grounding calls them otherwise.

    Examples
    --------
    >>> import tempfile
    >>> import deixis
    >>> script = deixis.read_script(text="layout supper; fork left of plate; knife right of plate")
    >>> corners = [[0, 0], [0.1, 0], [0.4, 0]], [[0.03, 0.2], [0.35, 0.25], [0.43, 0.2]]
    >>> scene = deixis.Scene.from_boxes(*corners, labels=["fork", "plate", "knife"])
    >>> with tempfile.TemporaryDirectory() as folder, deixis.Session(folder + "/memory") as session:
    ...     learned = session.learn(script, scene)
    >>> learned, learned.summary()
    (<Learned 'supper' as lesson supper-1: 3 categories>, "'supper' as lesson supper-1: 3 categories")
    >>> learned.categories, learned.doubtful
    (('fork', 'plate', 'knife'), ())
    >>> learned.to_dict()["lesson"]
    'supper-1'
    """

    lesson: Lesson
    grounding: Grounding
    seen: tuple[Taught, ...] = ()
    kept_names: tuple[KeptName, ...] = ()

    def summary(self) -> str:
        """Return the layout, the lesson, and how many categories it taught."""
        layout = self.lesson.layout
        undecided = f", {len(self.doubtful)} undecided" if self.doubtful else ""
        categories = count(len(self.categories), "category")
        return f"'{layout.name}' as lesson {layout.lesson}: {categories}{undecided}"

    @property
    def categories(self) -> tuple[str, ...]:
        """The objects whose category it taught."""
        return tuple(dict.fromkeys(self.lesson.category_of(match) for match in self.lesson.categories()))

    @property
    def doubtful(self) -> tuple[str, ...]:
        """The objects that it recorded as not decided."""
        return tuple(match.object for match in self.lesson.matches if not match.decided)


def learn(
    examples: Sequence[tuple[Script | str | Path, Scene | str | Path | Mapping[str, Any]]],
    knowledge: KnowledgeStore,
    views: ViewStore,
    engine: str = "exact",
    time_limit: float = DEFAULT_TIME_LIMIT,
    progress: Callable[[int, int], None] | None = None,
    teacher: str = ANONYMOUS,
    events: Sequence[str] = (),
    episodes: Recording | None = None,
) -> tuple[Learned, ...]:
    """Ground scripts, each in its scene, and keep the layouts and what their objects look like: all of them, or none.

    Each is grounded with what the memory had learned before this call. Doubtful and interchangeable matches are kept as
    such and teach no category; the posterior of each match is kept too, for :meth:`KnowledgeStore.learn_relations`.
    Sizes are learned at once. A thing that a teacher named keeps that name.

    Parameters
    ----------
    examples
        Pairs of a script and its scene, or of their files.
    knowledge
        The semantic store.
    views
        The perceptual store.
    engine
        Name of the engine.
    time_limit
        Seconds for each grounding.
    progress
        Called with the number of grounded examples and of all.
    teacher
        Name of the person who teaches.
    events
        Ids in the episodes of what the teacher said.
    episodes
        Function that returns what the blackboard says about the lessons, which is written in the same step.

    Returns
    -------
    tuple of Learned
        A lesson for each example, with its grounding.

    Raises
    ------
    DeixisError
        If a script contradicts itself or what was learned before; nothing is changed then.
    """
    pairs = list(examples)
    if knowledge.exists():
        knowledge.memory().require_writable()
    taken: set[str] = set()
    learned = []
    for done, (script, scene) in enumerate(pairs, 1):
        learned.append(_lesson(script, scene, knowledge, engine, time_limit, taken, teacher, events))
        if progress is not None:
            progress(done, len(pairs))
    if not learned:
        return ()
    groups = [views.except_taught(seen) for _, seen in learned]
    new_views = {one.lesson.id: new for (one, _), (new, _) in zip(learned, groups, strict=True)}
    named = {one.lesson.id: seen for one, seen in learned}
    lessons = [one.lesson for one, _ in learned]
    part = None if episodes is None else episodes(lessons)
    found, left = [], list(keep_lessons(lessons, new_views, knowledge, views, named, part))
    for (one, _), (new, kept) in zip(learned, groups, strict=True):
        found.append(replace(one, seen=tuple(left[: len(new)]), kept_names=kept))
        del left[: len(new)]
    return tuple(found)


def _lesson(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    knowledge: KnowledgeStore,
    engine: str,
    time_limit: float,
    taken: set[str],
    teacher: str,
    events: Sequence[str],
) -> tuple[Learned, list[View]]:
    """Return the lesson that a script and a scene are, not kept yet, and its views; put its id among those taken."""
    from deixis.learning.lessons.lesson import Occasion, layout_name, lesson_of
    from deixis.ontology.lessons.types import next_lesson_id

    script, scene = as_script(script, knowledge.ontology, Deadline.after(time_limit)), as_scene(scene)
    request = GroundingRequest(script, scene, engine, time_limit=time_limit, meaning=knowledge.meaning())
    conflict = request.conflict
    if conflict is not None:
        lines = ", ".join(str(fact.source) for fact in conflict.facts)
        raise InconsistencyError(f"the script contradicts itself, nothing was learned: {conflict.reason} ({lines})")
    started = datetime.now(UTC)
    found = answer(request)
    if not found.object_matches:
        raise NothingFoundError(
            f"no object of the script {script.file} was found in the scene {scene.file}, so nothing was learned"
        )
    knows = knowledge.memory().knows if knowledge.exists() else lambda name: False
    lesson_id = next_lesson_id(layout_name(script), lambda name: name in taken or knows(name))
    taken.add(lesson_id)
    lesson = lesson_of(
        script, scene, found, lesson_id, Occasion(started, datetime.now(UTC), VERSION, teacher, tuple(events))
    )
    return Learned(lesson, found), views_of_matches(scene, lesson.matches, lesson.category_of)
