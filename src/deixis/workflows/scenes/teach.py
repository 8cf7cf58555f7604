"""Teach a thing of a scene as a view of a category."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.knowledge_store import KnowledgeStore
from deixis.perception.scene import Scene
from deixis.view_store import ViewStore, new_category_name, view_of_thing
from deixis.workflows.layouts.read import as_scene
from deixis.workflows.scenes.views_of_lessons import keep_view

if TYPE_CHECKING:
    from deixis.learning.views.views import Taught
    from deixis.memory.journal import Part


def teach(
    scene: Scene | str | Path | Mapping[str, Any],
    object: str,
    category: str,
    knowledge: KnowledgeStore,
    views: ViewStore,
    teacher: str = "user",
    settles: tuple[str, str] | None = None,
    event: str | None = None,
    episodes: Part | None = None,
) -> Taught:
    """Store the appearance of a thing in a scene as a view of a category, which is created if it is new.

    A word that differs from a known category only by case means that category. Teaching the view again under another
    word corrects it; it then belongs to no lesson.

    Parameters
    ----------
    scene
        A scene, the name of its file, or parsed JSON.
    object
        Id of the thing.
    category
        Name of the category.
    knowledge
        The semantic store.
    views
        The perceptual store.
    teacher
        Name of the person who teaches.
    settles
        Id of a lesson and a role in it, of which this is the thing.
    event
        Event in which the teacher showed it (:func:`deixis.memory.episodes.fluents.episode.event_of`); None where the
        episodes do not have it.
    episodes
        What the blackboard says about it, which is written in the same step; None for nothing.

    Returns
    -------
    Taught
        The view, and the number of views of its category.

    Raises
    ------
    SceneError
        If the scene has no such thing, or no cloud of it.
    SettingError
        If the name is invalid.
    """
    scene = as_scene(scene)
    name = views.category_meant(new_category_name(category))
    view = view_of_thing(scene, object, name, teacher, settles, event)
    return keep_view(view, knowledge, views, episodes)
