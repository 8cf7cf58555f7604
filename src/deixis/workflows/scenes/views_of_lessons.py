"""Writes that several stores take part in: lessons, their views and their episodes. Each is all or nothing over all.

What a write needs is worked out first. Then one commit of the semantic store decides it, and the journals of the other
stores carry it out or drop it, also after a kill: see :mod:`deixis.memory.journal`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from deixis.knowledge_store import KnowledgeStore
from deixis.learning.views.teachings import each_changed
from deixis.memory.journal import Part, write_together
from deixis.memory.perceptual.records import Batch
from deixis.view_store import ViewStore

if TYPE_CHECKING:
    from deixis.learning.views.views import Taught
    from deixis.memory.perceptual.database.handle import WriteBatch
    from deixis.memory.perceptual.level import LevelMemory
    from deixis.memory.perceptual.records import View
    from deixis.ontology.lessons.types import Lesson


FORGET = "forget"
"""Name under which the log of the blackboard records that a lesson was forgotten."""


def keep_lessons(
    lessons: Sequence[Lesson],
    seen: Mapping[str, Sequence[View]],
    knowledge: KnowledgeStore,
    views: ViewStore,
    named: Mapping[str, Sequence[View]] = MappingProxyType({}),
    episodes: Part | None = None,
) -> tuple[Taught, ...]:
    """Write lessons, the views that each teaches, and what the episodes say about them, in one step over all stores.

    Parameters
    ----------
    lessons
        The lessons.
    seen
        Views by the id of the lesson that teaches them.
    knowledge
        The semantic store.
    views
        The perceptual store.
    named
        Views that each lesson names, by its id, with those that a teacher named otherwise.
    episodes
        Changes of the blackboard; None for none.

    Returns
    -------
    tuple of Taught
        What each view taught, in turn.
    """
    together = [view for lesson in lessons for view in seen.get(lesson.id, ())]
    turns = [(view, lesson.id) for lesson in lessons for view in named.get(lesson.id, seen.get(lesson.id, ()))]
    if not turns:
        write_together(knowledge.keeping(lessons, {}), _parts(None, episodes))
        return ()
    owners = {view.id: lesson.id for lesson in lessons for view in seen.get(lesson.id, ())}
    memory = views.memory(create=True)
    with memory.exclusive():
        change, taught = views.keeping(together, owners, turns)
        write_together(knowledge.keeping(lessons, seen), _parts(memory.handle.part(change), episodes))
    return taught


def keep_view(view: View, knowledge: KnowledgeStore, views: ViewStore, episodes: Part | None = None) -> Taught:
    """Write a view that a teacher named; it then belongs to no lesson.

    Parameters
    ----------
    view
        The view.
    knowledge
        The semantic store.
    views
        The perceptual store.
    episodes
        Changes of the blackboard; None for none.

    Returns
    -------
    Taught
        The view, and the number of views of its category.
    """
    memory = views.memory(create=True)
    with memory.exclusive():
        change, (taught,) = views.keeping([view], named=[(view, None)])
        of_lessons = [view.id] if memory.lesson_of(view.id) is not None else []
        _write(change, dict.fromkeys(of_lessons), knowledge, views, episodes)
    return taught


def forget_lesson(lesson: str, knowledge: KnowledgeStore, views: ViewStore) -> None:
    """Remove one lesson, with everything that follows from it alone; its views stay, and belong to no lesson.

    Parameters
    ----------
    lesson
        Id of the lesson.
    knowledge
        The semantic store.
    views
        The perceptual store.

    Raises
    ------
    UnknownLessonError
        If there is no such lesson.
    """
    from deixis.memory.episodes.blackboard import open_episodes
    from deixis.memory.episodes.experiences import without_lessons
    from deixis.memory.semantic.rdf.links import lessons_with, links_of

    commit, store = knowledge.forgetting(lesson), knowledge.memory().store
    linked = links_of(store, lesson)
    with open_episodes(knowledge.path) as board:
        marks = () if board is None else without_lessons(board, (lesson,))
        episodes = None if board is None or not marks else board.part(*marks, by=FORGET)
        if not views.exists():
            write_together(commit, _parts(None, episodes))
            return
        memory = views.memory()
        with memory.exclusive():
            turns = each_changed(
                memory.teachings(), lambda turn: replace(turn, lesson=None) if turn.lesson == lesson else turn
            )
            owners: dict[str, str | None] = {}
            for link in linked:
                if memory.lesson_of(link.view) == lesson:
                    others = [other for other in lessons_with(store, link.view) if other != lesson]
                    owners[link.view] = others[-1] if others else None
            change = memory.writing(Batch(lessons=owners, teachings=turns)) if linked or turns else None
            part = None if change is None else memory.handle.part(change)
            write_together(commit, _parts(part, episodes))


def rename_category(old: str, new: str, knowledge: KnowledgeStore, views: ViewStore) -> None:
    """Give a category of views another name.

    Parameters
    ----------
    old, new
        Its present name and its new one.
    knowledge
        The semantic store.
    views
        The perceptual store.

    Raises
    ------
    UnknownCategoryError
        If there is no category ``old``.
    RejectedWriteError
        If the new name is in use.
    """
    memory = views.memory()
    with memory.exclusive():
        change = memory.renaming(old, new)
        change.pairs += _renamed_teachings(memory, old, new)
        _write(change, dict.fromkeys(memory.taught_by_lessons(old), new), knowledge, views)


def merge_categories(source: str, into: str, knowledge: KnowledgeStore, views: ViewStore) -> None:
    """Move the views of one category to another.

    Parameters
    ----------
    source, into
        Category that goes, and category that gets the views.
    knowledge
        The semantic store.
    views
        The perceptual store.

    Raises
    ------
    UnknownCategoryError
        If there is no category ``source``.
    """
    memory = views.memory()
    with memory.exclusive():
        change = memory.merging(source, into)
        change.pairs += _renamed_teachings(memory, source, into)
        _write(change, dict.fromkeys(memory.taught_by_lessons(source), into), knowledge, views)


def forget_category(name: str, knowledge: KnowledgeStore, views: ViewStore) -> None:
    """Forget a category with all its views, and that lessons taught them.

    Parameters
    ----------
    name
        Name of the category.
    knowledge
        The semantic store.
    views
        The perceptual store.

    Raises
    ------
    UnknownCategoryError
        If there is no such category.
    """
    memory = views.memory()
    with memory.exclusive():
        change = memory.forgetting(name)
        gone = {key.id for key in memory.listing(name)}
        others = {view: turns for view, turns in memory.teachings().items() if view not in gone}
        turns = each_changed(others, lambda turn: None if turn.category == name else turn)
        change.pairs += memory.writing(Batch(teachings=turns)).pairs
        _write(change, dict.fromkeys(memory.taught_by_lessons(name)), knowledge, views)


def _renamed_teachings(memory: LevelMemory, old: str, new: str) -> list[tuple[bytes, bytes | None]]:
    """Return the keys and values of the teachings of which some name a category that gets another name."""
    turns = each_changed(memory.teachings(), lambda turn: replace(turn, category=new) if turn.category == old else turn)
    return memory.writing(Batch(teachings=turns)).pairs


def _parts(*parts: Part | None) -> list[Part]:
    return [part for part in parts if part is not None]


def _write(
    change: WriteBatch,
    categories: Mapping[str, str | None],
    knowledge: KnowledgeStore,
    views: ViewStore,
    episodes: Part | None = None,
) -> None:
    """Write a change of views; ``categories`` are those of the views of lessons afterwards, None for no lesson.

    What the episodes say about it needs a semantic store, which decides the write.
    """
    from deixis.memory.semantic.rdf.links import relinking

    handle = views.memory().handle
    if episodes is None and not (categories and knowledge.exists()):
        handle.write(change, sync=True)
        return
    memory = knowledge.memory(create=True)
    links, rules = relinking(memory.store, categories), memory.kept_up()
    write_together(lambda joint: memory.commit(links, rules, joint), _parts(handle.part(change), episodes))
