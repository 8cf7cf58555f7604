"""A script and a scene become a lesson: the layout, and what its objects look like."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.grammar.script import Script
from deixis.knowledge_store import KnowledgeStore
from deixis.perception.scene import Scene
from deixis.reasoning.errors import InconsistencyError, NothingFoundError
from deixis.reasoning.grounding.answer import Grounding
from deixis.reasoning.grounding.ground import DEFAULT_TIME_LIMIT
from deixis.version import VERSION
from deixis.view_store import ViewStore, views_of_matches
from deixis.workflows.ground import GroundingRequest, answer
from deixis.workflows.read import as_scene, as_script

if TYPE_CHECKING:
    from deixis.learning.views import StandingWord, Taught
    from deixis.ontology.lessons.types import Lesson


@dataclass(frozen=True)
class Learned:
    """What a lesson left behind."""

    lesson: Lesson
    grounding: Grounding
    seen: tuple[Taught, ...] = ()  # the views that it taught, of things with clouds
    standing: tuple[StandingWord, ...] = ()  # what it would call otherwise than a teacher did

    @property
    def categories(self) -> tuple[str, ...]:
        """The objects whose category it taught."""
        return tuple(match.object for match in self.lesson.categories())

    @property
    def doubtful(self) -> tuple[str, ...]:
        """The objects that it recorded as not settled."""
        return tuple(match.object for match in self.lesson.matches if not match.decided)


def learn(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    knowledge: KnowledgeStore,
    views: ViewStore,
    engine: str = "exact",
    time_limit: float = DEFAULT_TIME_LIMIT,
) -> Learned:
    """Grounds a script in a scene, and keeps the layout and what its objects look like, with where it comes from.

    What is doubtful or interchangeable is kept as such and teaches no category; how sure each match is is kept too,
    for :meth:`KnowledgeStore.learn_relations`. Sizes are learned at once. What a teacher named stays of that name.
    Raises DeixisError, having changed nothing, where the script contradicts itself or what was learned before.
    """
    from deixis.learning.lesson import Occasion, layout_name, lesson_of
    from deixis.ontology.lessons.types import next_lesson_id

    script, scene = as_script(script, knowledge.ontology), as_scene(scene)
    request = GroundingRequest(script, scene, engine, time_limit=time_limit, meaning=knowledge.meaning())
    conflict = request.conflict
    if conflict is not None:
        lines = ", ".join(str(fact.source) for fact in conflict.facts)
        raise InconsistencyError(f"the script contradicts itself, nothing was learned: {conflict.reason} ({lines})")
    started = datetime.now(UTC)
    found = answer(request)
    if not found.matches:
        raise NothingFoundError("nothing that the script names was found in the scene, so nothing was learned")
    id = next_lesson_id(layout_name(script), knowledge.memory(create=True).lessons())
    lesson = lesson_of(script, scene, found, id, Occasion(started, datetime.now(UTC), VERSION))
    new, standing = views.but_for_taught(views_of_matches(scene, found.matches.values()))
    with views.keeping(new) as seen:
        knowledge.keep(lesson)
    return Learned(lesson, found, seen, standing)
