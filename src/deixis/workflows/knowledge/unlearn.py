"""Take back what a sentence, a lesson, a label, a table, a teacher or a day taught, in all memories.

Everything that came only from it goes, and nothing else: what remains is what the memory would hold if it had never
been taught. Lessons are removed with what follows from them only; a view keeps its other teachings, and is forgotten
with its last one. In the episodes, what persons said and showed is deleted, with the fluents of the same events; what
was seen stays.
"""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import date, datetime, time, timedelta
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, count
from deixis.errors import DeixisError
from deixis.knowledge_store import KnowledgeStore
from deixis.learning.teachings import Teaching, Teachings, boxes_key, prevailing, teachings_of, written
from deixis.memory.episodes.changes import Add, Delete
from deixis.memory.episodes.episode import EpisodicFluent, Origin, Source, episodic
from deixis.perception.scene import Scene
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.fluent import Pattern, Statement
from deixis.view_store import SETTLES, ViewStore, category_name
from deixis.workflows.descriptions.remembered_attributes import CALLED, NOT_CALLED
from deixis.workflows.layouts.read import as_scene

if TYPE_CHECKING:
    from deixis.learning.update import Commit
    from deixis.memory.episodes.blackboard import Blackboard
    from deixis.memory.perceptual.level import LevelMemory
    from deixis.ontology.lessons.read import Provenance


_SENTENCE_ENDS = re.compile(r"(?<=[.!?])\s+|[;\n]+")

NAMED = frozenset({"isA", "called"})
"""Predicates of the category that a person names."""

PENDING = "unlearning"
"""Predicate of what is being taken back: lessons, id of the journal, and fluents."""

IDS_IN_A_FLUENT = 2000
"""Maximum number of ids in one fluent of an unlearning."""

UNLEARN = "unlearn"
"""Name under which the log of the blackboard records what was taken back."""


@dataclass(frozen=True)
class Selection:
    """Choice of what to take back. A lesson or a teaching of a view is taken back if all given parts hold of it.

    ``lesson`` and ``sentence`` select lessons, and what these taught; ``label`` and ``view`` select what a person
    taught about views. ``table`` is a scene, or the name of its file. ``since`` is the first moment and ``until`` the
    first moment after the last one, both with a time zone.
    """

    lesson: str | None = None
    sentence: str | None = None
    label: str | None = None
    view: str | None = None
    table: Scene | str | Path | Mapping[str, Any] | None = None
    teacher: str | None = None
    since: datetime | None = None
    until: datetime | None = None

    def __post_init__(self) -> None:
        if all(value is None for value in vars(self).values()):
            raise SettingError(
                "name what to take back: a lesson, sentence, label, view, table, teacher, day, or a time span"
            )
        for name in ("since", "until"):
            moment = getattr(self, name)
            if moment is not None and (not isinstance(moment, datetime) or moment.utcoffset() is None):
                raise SettingError(f"`{name}` must be a datetime with a time zone, got {moment!r}")


def span_of_day(day: str) -> tuple[datetime, datetime]:
    """Return the first moment of a day and that of the next day, in local time.

    Parameters
    ----------
    day
        The day as ``2026-11-23``, or ``today`` or ``yesterday``.

    Returns
    -------
    tuple of datetime
        Both moments with the local time zone.

    Raises
    ------
    SettingError
        If it is not a day.
    """
    relative = {"today": 0, "yesterday": 1}
    try:
        found = date.today() - timedelta(relative[day]) if day in relative else date.fromisoformat(day)
        after = found + timedelta(1)
    except (ValueError, OverflowError) as error:
        raise SettingError(f"a day must be a date such as 2026-11-23, today or yesterday, got {day!r}") from error
    first, last = (datetime.combine(each, time()).astimezone() for each in (found, after))
    return first, last


@dataclass(frozen=True, slots=True)
class ViewChange:
    """A view that lost teachings. ``category`` is None where it is forgotten; else its category now."""

    view: str
    before: str
    category: str | None
    sources: tuple[str, ...]  # lessons and persons whose teachings are taken back


@dataclass(frozen=True, repr=False)
class Unlearned(Answer):
    """Lessons, views and fluents that were taken back.

    A view is forgotten, or has another category or source now; ``fluents`` are the ids of what persons said or showed.
    ``containing`` are lessons that have the sentence among others, and stay.
    """

    lessons: tuple[str, ...] = ()
    views: tuple[ViewChange, ...] = ()
    fluents: tuple[str, ...] = ()
    containing: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.lessons or self.views or self.fluents)

    def summary(self) -> str:
        """Return the numbers of lessons and views."""
        gone = sum(change.category is None for change in self.views)
        return (
            f"{count(len(self.lessons), 'lesson')} taken back, {count(gone, 'view')} forgotten, "
            f"{count(len(self.views) - gone, 'view')} changed"
            + (f", {count(len(self.fluents), 'fluent')} deleted" if self.fluents else "")
        )


def unlearn(selection: Selection, knowledge: KnowledgeStore, views: ViewStore, dry_run: bool = False) -> Unlearned:
    """Take back everything that a selection came from, in one step over both stores.

    Parameters
    ----------
    selection
        What to take back.
    knowledge
        The semantic store.
    views
        The perceptual store.
    dry_run
        True to change nothing.

    Returns
    -------
    Unlearned
        What was taken back; it is false where nothing matches.

    Raises
    ------
    UnknownLessonError
        If the selected lesson is not in the memory.
    DamagedMemoryError
        If a view cannot be read; nothing is changed then.
    """
    chosen = _Chosen(selection)
    lessons = _lessons(chosen, knowledge) if knowledge.exists() else ()
    with _episodes(knowledge.path) as board:
        if board is not None:
            complete_unlearning(board, knowledge)
        fluents = () if board is None else _fluents(board, lessons, chosen)
        ids = tuple(each.id for each in fluents)
        if not views.exists():
            if lessons and not dry_run:
                _with_episodes(knowledge.unlearning(lessons, {}), board, fluents, lessons)(None)
            elif board is not None and fluents and not dry_run:
                board.write(*(Delete(each.id) for each in fluents), by=UNLEARN)
            return Unlearned(lessons, (), ids, _containing(chosen, knowledge, lessons))
        memory = views.memory()
        with memory.exclusive():
            before = _teachings(memory, knowledge)
            after = {view: _without(turns, lessons, chosen, view) for view, turns in before.items()}
            after = {view: turns for view, turns in after.items() if turns != before[view]}
            containing = _containing(chosen, knowledge, lessons)
            found = Unlearned(lessons, tuple(_changes(before, after)), ids, containing)
            if found and not dry_run:
                _write(lessons, before, after, memory, knowledge, board, fluents)
    return found


@contextmanager
def _episodes(folder: Path) -> Iterator[Blackboard | None]:
    """Open the blackboard of a memory, if it has one."""
    from deixis.memory.episodes.blackboard import Blackboard, has_episodes

    if not has_episodes(folder):
        yield None
        return
    with Blackboard.open(folder) as board:
        yield board


def _fluents(board: Blackboard, lessons: Sequence[str], chosen: _Chosen) -> tuple[EpisodicFluent, ...]:
    """Return the fluents that a person stated and that are taken back, and those of the same events and lessons."""
    known = board.holding()
    stated = [each for each in known if chosen.holds_of_fluent(each, board.moment)]
    events = {each.source.event for each in stated if each.source.event is not None} | set(lessons)
    own = {each.id for each in stated}
    return tuple(each for each in known if each.id in own or each.source.event in events)


def _with_episodes(
    commit: Commit, board: Blackboard | None, fluents: Sequence[EpisodicFluent], lessons: Sequence[str]
) -> Commit:
    """Return a commit after which fluents are deleted, also if the process is killed in between.

    The blackboard first says what the commit decides; see :func:`complete_unlearning`.
    """

    def committing(journal: str | None) -> None:
        if board is None or not fluents:
            commit(journal)
            return
        pending = []
        for first in range(0, len(fluents), IDS_IN_A_FLUENT):
            ids = [each.id for each in fluents[first : first + IDS_IN_A_FLUENT]]
            said = json.dumps({"lessons": list(lessons), "journal": journal, "fluents": ids})
            id, source = board.new_id(UNLEARN), Source(Origin.INFERRED, UNLEARN)
            pending.append(episodic(id, (id, PENDING, said), start=board.seconds(), source=source))
        board.write(*map(Add, pending), by=UNLEARN)
        try:
            commit(journal)
        except BaseException:
            board.write(*(Delete(each.id) for each in pending), by=UNLEARN)
            raise
        board.write(*(Delete(each.id) for each in (*pending, *fluents)), by=UNLEARN)

    return committing


def complete_unlearning(board: Blackboard, knowledge: KnowledgeStore) -> int:
    """Complete or drop what a process that was killed began to take back, so that all memories are in step.

    The commit of the stores decides: if it was made, the fluents go too, and if not, they stay.

    Parameters
    ----------
    board
        The blackboard.
    knowledge
        The semantic store.

    Returns
    -------
    int
        Number of fluents that were deleted.
    """
    deleted = 0
    for pending in board.now(Pattern(predicate=PENDING)):
        said = json.loads(pending.statement.object or "{}")
        ids = [id for id in said["fluents"] if board.fluent(id) is not None] if _was_made(said, knowledge) else []
        board.write(Delete(pending.id), *map(Delete, ids), by=UNLEARN)
        deleted += len(ids)
    return deleted


def _was_made(said: Mapping[str, Any], knowledge: KnowledgeStore) -> bool:
    """Return whether the stores made the commit of an unlearning."""
    from deixis.memory.journal import COMMITTED, MARKS

    if not knowledge.exists():
        return False
    memory = knowledge.memory()
    if said["lessons"]:
        return not set(said["lessons"]) & set(memory.lessons())
    marks = memory.store.quads_for_pattern(MARKS, COMMITTED, None, MARKS)
    return any(getattr(quad.object, "value", None) == said["journal"] for quad in marks)


class _Chosen:
    """A selection, with its table read and its label as categories are named."""

    def __init__(self, selection: Selection) -> None:
        self.all = selection
        self.label = None if selection.label is None else category_name(selection.label)
        self.sentence = None if selection.sentence is None else plain(selection.sentence)
        self.boxes, self.file = _table(selection.table)

    def holds_of_lesson(self, lesson: Provenance) -> bool:
        """Return whether a lesson is taken back as a whole."""
        wanted = self.all
        if self.label is not None or wanted.view is not None:
            return False
        return (
            (wanted.lesson is None or wanted.lesson == lesson.lesson)
            and (self.sentence is None or self.sentence == plain(lesson.told_text or lesson.script_text))
            and (wanted.table is None or self._is_table(lesson.scene_file, lambda: _boxes_of(lesson.scene_text)))
            and (wanted.teacher is None or wanted.teacher == lesson.teacher)
            and self._is_then(lesson.started)
        )

    def holds_of_teaching(self, turn: Teaching, view: str) -> bool:
        """Return whether what a person taught about a view is taken back; lessons take back theirs."""
        wanted = self.all
        if turn.lesson is not None or wanted.lesson is not None or wanted.sentence is not None:
            return False
        boxes = turn.metadata.get("boxes")
        return (
            (self.label is None or self.label == turn.category)
            and (wanted.view is None or wanted.view == view)
            and (wanted.table is None or self._is_table(str(turn.metadata.get("scene", "")), lambda: boxes))
            and (wanted.teacher is None or wanted.teacher == turn.teacher)
            and self._is_then(turn.time)
        )

    def holds_of_fluent(self, fluent: EpisodicFluent, moment: Callable[[float], datetime]) -> bool:
        """Return whether what a person said or showed is taken back; what was seen or inferred stays."""
        wanted, statement = self.all, fluent.statement
        if fluent.source.origin not in (Origin.SAID, Origin.SHOWN) or wanted.table is not None:
            return False
        if wanted.lesson is not None or wanted.view is not None:
            return False
        start = fluent.start.lower
        return (
            (self.sentence is None or plain(_words(statement)) == self.sentence)
            and (
                self.label is None
                or (statement.predicate in NAMED and category_name(statement.object or "?") == self.label)
            )
            and (wanted.teacher is None or wanted.teacher == fluent.source.by)
            and ((wanted.since is None and wanted.until is None) or (isfinite(start) and self._is_then(moment(start))))
        )

    def _is_then(self, moment: datetime) -> bool:
        since, until = self.all.since, self.all.until
        return (since is None or since <= moment) and (until is None or moment < until)

    def _is_table(self, file: str, boxes: Callable[[], str | None]) -> bool:
        if self.boxes is not None:
            return boxes() == self.boxes
        return self.file is not None and (file == self.file or file == str(Path(self.file).absolute()))


def _words(said: Statement) -> str:
    """Return the sentence that a fluent holds: what a person said, or what taught an adjective; else nothing."""
    if said.predicate in (CALLED, NOT_CALLED):
        return str(json.loads(said.object or "{}").get("text", ""))
    return said.object or "" if said.predicate == "said" else ""


def plain(text: str) -> str:
    """Return a sentence in lower case, without line ends and without punctuation at its end.

    Parameters
    ----------
    text
        The sentence.

    Returns
    -------
    str
        A text by which two ways of writing one sentence are equal.

    Examples
    --------
    >>> plain("The fork  is left of the plate.")
    'the fork is left of the plate'
    """
    return " ".join(text.lower().split()).rstrip(" .!;")


def _table(table: Scene | str | Path | Mapping[str, Any] | None) -> tuple[str | None, str | None]:
    """Return the key of the boxes of a table, or else the name of a scene file that no longer exists."""
    if isinstance(table, str | Path) and not Path(table).exists():
        return None, str(table)
    return (None, None) if table is None else (boxes_key(as_scene(table)), None)


def _boxes_of(scene_text: str) -> str | None:
    try:
        return boxes_key(as_scene(json.loads(scene_text)))
    except (DeixisError, ValueError):
        return None


def _lessons(chosen: _Chosen, knowledge: KnowledgeStore) -> tuple[str, ...]:
    """Return the ids of the lessons to take back, in the order learned."""
    from deixis.memory.semantic.rdf.graphs import GraphName
    from deixis.ontology.lessons.read import provenances

    memory = knowledge.memory()
    if chosen.all.lesson is not None:
        memory.require_lesson(chosen.all.lesson)
    known = provenances(memory.triples(GraphName.EPISODES))
    wanted = {lesson.lesson for lesson in known if chosen.holds_of_lesson(lesson)}
    return tuple(lesson for lesson in memory.lessons() if lesson in wanted)


def _containing(chosen: _Chosen, knowledge: KnowledgeStore, lessons: Sequence[str]) -> tuple[str, ...]:
    """Return the lessons that have the sentence to take back among others."""
    from deixis.memory.semantic.rdf.graphs import GraphName
    from deixis.ontology.lessons.read import provenances

    if chosen.sentence is None or not knowledge.exists():
        return ()
    known = provenances(knowledge.memory().triples(GraphName.EPISODES))
    return tuple(
        each.lesson
        for each in known
        if each.lesson not in lessons
        and chosen.sentence in map(plain, _SENTENCE_ENDS.split(each.told_text or each.script_text))
    )


def _teachings(memory: LevelMemory, knowledge: KnowledgeStore) -> dict[str, Teachings]:
    """Return all teachings of all views."""
    from deixis.memory.perceptual import keys
    from deixis.memory.semantic.rdf.links import all_links

    stored, lessons = memory.teachings(), memory.lessons_of_views()
    linked: dict[str, list[str]] = defaultdict(list)
    for link in all_links(knowledge.memory().store) if knowledge.exists() else ():
        linked[link.view].append(link.lesson)
    found = {}
    for view in memory.headers():
        metadata = json.loads(view.metadata)
        current = Teaching(view.category, keys.moment(view.time), metadata, lessons.get(view.id))
        found[view.id] = teachings_of(current, stored.get(view.id, ()), linked[view.id])
    return found


def _without(turns: Teachings, lessons: Sequence[str], chosen: _Chosen, view: str) -> Teachings:
    """Return the teachings of a view that stay."""
    stay = (turn for turn in turns if _origin(turn) not in lessons)
    return tuple(turn for turn in stay if not chosen.holds_of_teaching(turn, view))


def _origin(turn: Teaching) -> str | None:
    """Return the lesson that a teaching came from: its own, or the one that was settled in hindsight."""
    settled = turn.metadata.get(SETTLES)
    return str(settled[0]) if settled and not turn.is_by_hand else turn.lesson


def _changes(before: Mapping[str, Teachings], after: Mapping[str, Teachings]) -> Iterator[ViewChange]:
    for view, turns in after.items():
        gone = [turn for turn in before[view] if turn not in turns]
        sources = tuple(dict.fromkeys(turn.lesson or turn.teacher for turn in gone))
        category = prevailing(turns).category if turns else None
        yield ViewChange(view, prevailing(before[view]).category, category, sources)


def _write(
    lessons: Sequence[str],
    before: Mapping[str, Teachings],
    after: Mapping[str, Teachings],
    memory: LevelMemory,
    knowledge: KnowledgeStore,
    board: Blackboard | None,
    fluents: Sequence[EpisodicFluent],
) -> None:
    """Write what is left of the teachings of views, and remove the lessons."""
    from deixis.learning.views import batch_without
    from deixis.memory.semantic.rdf.links import Link

    gone = [view for view, turns in after.items() if not turns]
    now = {view: prevailing(turns) for view, turns in after.items() if turns}
    changed = {view: turn for view, turn in now.items() if turn != prevailing(before[view])}
    links: dict[str, list[Link]] = {view: [] for view in after}
    owners: dict[str, str | None] = {}
    for view, turn in now.items():
        teaching_lessons = (
            () if turn.is_by_hand else dict.fromkeys(each.lesson for each in after[view] if each.lesson is not None)
        )
        links[view] = [Link(lesson, view, turn.category) for lesson in teaching_lessons]
        owners[view] = turn.lesson or next(reversed(tuple(teaching_lessons)), None)
    batch = batch_without(memory, gone, changed)
    turns = {view: written(after[view]) for view in now}
    change = memory.writing(replace(batch, lessons=owners, teachings=turns))
    if knowledge.exists():
        commit = knowledge.unlearning(lessons, links)
        memory.handle.write_with(change, _with_episodes(commit, board, fluents, lessons))
    else:
        _with_episodes(lambda _: memory.handle.write(change, sync=True), board, fluents, lessons)(None)
