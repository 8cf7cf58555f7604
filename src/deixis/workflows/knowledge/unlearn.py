"""Take back what a sentence, a lesson, a label, a table, a teacher or a day taught, in all memories.

Everything that came only from it goes, and nothing else: what remains is what the memory would hold if it had never
been taught. Lessons are removed with what follows from them only; a view keeps its other teachings, and is forgotten
with its last one. In the episodes, what persons said and showed is deleted, with the fluents of the same events; what
was seen stays.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from contextlib import ExitStack
from dataclasses import dataclass, replace
from datetime import date, datetime, time, timedelta
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, count
from deixis.arguments import require_fields
from deixis.errors import DeixisError
from deixis.knowledge_store import KnowledgeStore
from deixis.learning.views.teachings import Teaching, Teachings, boxes_key, prevailing, teachings_of, written
from deixis.memory.episodes.blackboard import open_episodes
from deixis.memory.episodes.experiences import without_lessons
from deixis.memory.episodes.fluents.changes import Change, Delete, Update
from deixis.memory.episodes.fluents.episode import EVENT, EpisodicFluent, Origin, event_of
from deixis.memory.episodes.predicates import NAMED
from deixis.memory.journal import Part, write_together
from deixis.ontology.things.kinds import plain_name
from deixis.perception.scene import Scene
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.fluent import Statement
from deixis.text_files import is_present
from deixis.view_store import SETTLES, ViewStore, category_name
from deixis.workflows.descriptions.remembered_attributes import CALLED, NOT_CALLED, entry_of
from deixis.workflows.knowledge.sentences import plain
from deixis.workflows.layouts.read import as_scene

if TYPE_CHECKING:
    from deixis.memory.episodes.blackboard import Blackboard
    from deixis.memory.perceptual.level import LevelMemory
    from deixis.memory.perceptual.protocol import Progress
    from deixis.ontology.lessons.read import Provenance
    from deixis.ontology.lessons.types import Lesson


UNLEARN = "unlearn"
"""Name under which the log of the blackboard records what was taken back."""


@dataclass(frozen=True)
class Selection:
    """Choice of what to take back. A lesson or a teaching of a view is taken back if all given parts hold of it.

    ``lesson`` selects a lesson, and what it taught; ``sentence`` selects lessons and names of things in these words,
    and this sentence of the other lessons that have it, with all that came only from it; ``label`` and ``view`` select
    what a person taught about views. ``table`` is a scene, or the name of its file. ``since`` is the first moment and
    ``until`` the first moment after the last one, both with a time zone.
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
        require_fields(self)
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
        first, last = (datetime.combine(each, time()).astimezone() for each in (found, found + timedelta(1)))
    except (ValueError, OverflowError) as error:  # also the first and the last day that dates have
        raise SettingError(f"a day must be a date such as 2026-11-23, today or yesterday, got {day!r}") from error
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
    ``revised`` are lessons that lost the sentence, and teach what their other sentences state.
    """

    lessons: tuple[str, ...] = ()
    views: tuple[ViewChange, ...] = ()
    fluents: tuple[str, ...] = ()
    revised: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.lessons or self.revised or self.views or self.fluents)

    def summary(self) -> str:
        """Return the numbers of lessons and views."""
        gone = sum(change.category is None for change in self.views)
        return (
            f"{count(len(self.lessons), 'lesson')} taken back, {count(gone, 'view')} forgotten, "
            f"{count(len(self.views) - gone, 'view')} changed"
            + (f", {count(len(self.fluents), 'fluent')} deleted" if self.fluents else "")
            + (f", {count(len(self.revised), 'lesson')} without the sentence" if self.revised else "")
        )


def unlearn(
    selection: Selection,
    knowledge: KnowledgeStore,
    views: ViewStore,
    dry_run: bool = False,
    progress: Progress | None = None,
) -> Unlearned:
    """Take back everything that a selection came from, in one step over all stores.

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
    progress
        Called with the number of lessons that are taken back, and of all.

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
    with open_episodes(knowledge.path) as board, ExitStack() as held:
        spoken = set() if board is None or not knowledge.exists() else _lessons_of_words(board, chosen, knowledge)
        lessons = _lessons(chosen, knowledge, spoken) if knowledge.exists() else ()
        empty, revised = _revised(chosen, knowledge, lessons)
        lessons = (*lessons, *empty)
        memory = views.memory() if views.exists() else None
        if memory is not None:
            held.enter_context(memory.exclusive())
        before = {} if memory is None else _teachings(memory, knowledge)
        chosen.events = set() if board is None else _spoken(board, chosen)
        new = {lesson.id: lesson for lesson in revised}
        after = {view: _without(turns, lessons, new, chosen, view) for view, turns in before.items()}
        after = {view: turns for view, turns in after.items() if turns != before[view]}
        shown = set() if board is None else _shown(board, before, after)
        events = shown | (_teaching_events(lessons, knowledge) if lessons else set())
        changes = () if board is None else tuple(_episodes(board, lessons, chosen, events))
        fluents = tuple(change.id for change in changes if isinstance(change, Delete))
        found = Unlearned(lessons, tuple(_changes(before, after)), fluents, tuple(new))
        if (lessons or revised or after) and not dry_run:
            part = None if board is None or not changes else board.part(*changes, by=UNLEARN)
            _write(lessons, revised, before, after, memory, knowledge, part, progress)
        elif board is not None and not dry_run:
            board.write(*changes, by=UNLEARN)
    return found


def _teaching_events(lessons: Sequence[str], knowledge: KnowledgeStore) -> set[str]:
    """Return the events that taught the lessons which are taken back, and no lesson that stays."""
    from deixis.memory.semantic.rdf.links import events_of_lessons

    known = events_of_lessons(knowledge.memory().store)
    kept = {event for lesson, events in known.items() if lesson not in lessons for event in events}
    return {*lessons, *(event for lesson in lessons for event in known.get(lesson, ()))} - kept


def _lessons_of_words(board: Blackboard, chosen: _Chosen, knowledge: KnowledgeStore) -> set[str]:
    """Return the lessons that only the sentence taught which is taken back, in the words in which it was said.

    Their own text may differ: it has neither the name of the layout nor the ids of things.
    """
    from deixis.memory.semantic.rdf.links import events_of_lessons

    if chosen.sentence is None:
        return set()
    said = {each.source.event for each in board.holding() if chosen.holds_of_fluent(each, board.moment)}
    known = events_of_lessons(knowledge.memory().store)
    return {lesson for lesson, events in known.items() if events and said.issuperset(events)}


def _spoken(board: Blackboard, chosen: _Chosen) -> set[str]:
    """Return the events in which persons said the sentence that is taken back, as views name them."""
    if chosen.sentence is None:
        return set()
    fluents = (each for each in board.holding() if chosen.holds_of_fluent(each, board.moment))
    return {event_of(board.origin, each.source.event) for each in fluents if each.source.event is not None}


def _shown(board: Blackboard, before: Mapping[str, Teachings], after: Mapping[str, Teachings]) -> set[str]:
    """Return the events on the blackboard in which persons showed what is taken back of views."""
    gone = (turn.metadata.get(EVENT) for view, turns in after.items() for turn in before[view] if turn not in turns)
    return {event for event in (board.event_here(str(each)) for each in gone if each is not None) if event is not None}


def _episodes(board: Blackboard, lessons: Sequence[str], chosen: _Chosen, others: Set[str]) -> Iterator[Change]:
    """Yield what changes on the blackboard.

    These are the fluents that a person stated and that are taken back, and those of the same events and lessons.
    Experiences stay, and no longer name the lessons.
    """
    known = board.holding()
    yield from _shortened(known, chosen, board.moment)
    stated = [each for each in known if chosen.holds_of_fluent(each, board.moment)]
    events = {each.source.event for each in stated if each.source.event is not None} | others
    own = {each.id for each in stated}
    gone = [each.id for each in known if each.id in own or each.source.event in events]
    yield from map(Delete, gone)
    yield from (change for change in without_lessons(board, lessons) if change.id not in gone)


def _shortened(
    known: Sequence[EpisodicFluent], chosen: _Chosen, moment: Callable[[float], datetime]
) -> Iterator[Change]:
    """Yield the changes that cut the sentence out of what persons said."""
    from deixis.ontology.tbox import default_ontology
    from deixis.workflows.knowledge.sentences import without_sentence

    sentence = chosen.sentence
    if sentence is None:
        return
    for each in known:
        words = _words(each.statement) if each.statement.predicate == "said" else ""
        if sentence in plain(words) and chosen.holds_of_fluent(each, moment, whole=False):
            rest = without_sentence(words, sentence, default_ontology())
            if rest is not None:
                yield Update(each.id, statement=replace(each.statement, object=rest))


class _Chosen:
    """A selection, with its table read and its label as categories are named."""

    def __init__(self, selection: Selection) -> None:
        self.all = selection
        self.label = None if selection.label is None else category_name(selection.label)
        self.sentence = None if selection.sentence is None else plain(selection.sentence)
        self.boxes, self.file = _table(selection.table)
        self.events: set[str] = set()  # in which the sentence was said

    def holds_of_lesson(self, lesson: Provenance, whole: bool = True) -> bool:
        """Return whether a lesson is taken back, or, unless ``whole``, may lose a sentence."""
        wanted = self.all
        if self.label is not None or wanted.view is not None:
            return False
        return (
            (wanted.lesson is None or wanted.lesson == lesson.lesson)
            and (not whole or self.sentence in (None, plain(lesson.told_text or lesson.script_text)))
            and (wanted.table is None or self._is_table(lesson.scene_file, lambda: _boxes_of(lesson.scene_text)))
            and (wanted.teacher is None or wanted.teacher == lesson.teacher)
            and self._is_in_time(lesson.started)
        )

    def holds_of_teaching(self, turn: Teaching, view: str) -> bool:
        """Return whether what a person taught about a view is taken back; lessons take back theirs."""
        wanted = self.all
        if turn.lesson is not None or wanted.lesson is not None:
            return False
        if wanted.sentence is not None and turn.metadata.get(EVENT) not in self.events:
            return False
        boxes = turn.metadata.get("boxes")
        return (
            (self.label is None or self.label == turn.category)
            and (wanted.view is None or wanted.view == view)
            and (wanted.table is None or self._is_table(str(turn.metadata.get("scene", "")), lambda: boxes))
            and (wanted.teacher is None or wanted.teacher == turn.teacher)
            and self._is_in_time(turn.time)
        )

    def holds_of_fluent(self, fluent: EpisodicFluent, moment: Callable[[float], datetime], whole: bool = True) -> bool:
        """Return whether what a person said or showed is taken back, or, unless ``whole``, may lose a sentence.

        What was seen or inferred stays.
        """
        wanted, statement = self.all, fluent.statement
        if fluent.source.origin not in (Origin.SAID, Origin.SHOWN) or wanted.table is not None:
            return False
        if wanted.lesson is not None or wanted.view is not None:
            return False
        start = fluent.start.lower
        return (
            (not whole or self.sentence is None or plain(_words(statement)) == self.sentence)
            and (
                self.label is None
                or (statement.predicate in NAMED and category_name(statement.object or "?") == self.label)
            )
            and (wanted.teacher is None or wanted.teacher == fluent.source.by)
            and (
                (wanted.since is None and wanted.until is None) or (isfinite(start) and self._is_in_time(moment(start)))
            )
        )

    def _is_in_time(self, moment: datetime) -> bool:
        since, until = self.all.since, self.all.until
        return (since is None or since <= moment) and (until is None or moment < until)

    def _is_table(self, file: str, boxes: Callable[[], str | None]) -> bool:
        if self.boxes is not None:
            return boxes() == self.boxes
        return self.file is not None and (file == self.file or file == str(Path(self.file).absolute()))


def _words(statement: Statement) -> str:
    """Return the sentence that a fluent holds: what a person said, or what taught an adjective; else nothing."""
    if statement.predicate in (CALLED, NOT_CALLED):
        entry = entry_of(statement.object)
        return "" if entry is None else str(entry["text"])
    return statement.object or "" if statement.predicate == "said" else ""


def _table(table: Scene | str | Path | Mapping[str, Any] | None) -> tuple[str | None, str | None]:
    """Return the key of the boxes of a table, or else the name of a scene file that no longer exists."""
    if isinstance(table, str | Path) and not is_present(table):
        return None, str(table)
    return (None, None) if table is None else (boxes_key(as_scene(table)), None)


def _boxes_of(scene_text: str) -> str | None:
    try:
        return boxes_key(as_scene(json.loads(scene_text)))
    except (DeixisError, ValueError):
        return None


def _lessons(chosen: _Chosen, knowledge: KnowledgeStore, spoken: Set[str]) -> tuple[str, ...]:
    """Return the ids of the lessons to take back, in the order learned.

    ``spoken`` are lessons that the sentence taught, in other words than those of the lesson.
    """
    from deixis.memory.semantic.rdf.graphs import GraphName
    from deixis.ontology.lessons.read import provenances

    memory = knowledge.memory()
    if chosen.all.lesson is not None:
        memory.require_lesson(chosen.all.lesson)
    known = provenances(memory.triples(GraphName.EPISODES))
    wanted = {lesson.lesson for lesson in known if chosen.holds_of_lesson(lesson, whole=lesson.lesson not in spoken)}
    return tuple(lesson for lesson in memory.lessons() if lesson in wanted)


def _revised(chosen: _Chosen, knowledge: KnowledgeStore, lessons: Sequence[str]) -> tuple[list[str], list[Lesson]]:
    """Return the lessons that are empty without the sentence, and the other lessons that had it, without it."""
    from deixis.memory.semantic.rdf.graphs import GraphName
    from deixis.memory.semantic.rdf.links import events_of_lessons
    from deixis.ontology.lessons.read import provenances
    from deixis.workflows.knowledge.sentences import lesson_of_script, script_without

    gone: list[str] = []
    revised: list[Lesson] = []
    if chosen.all.sentence is None or not knowledge.exists():
        return gone, revised
    memory = knowledge.memory()
    layouts, events = {each.lesson: each for each in knowledge.layouts()}, events_of_lessons(memory.store)
    for record in provenances(memory.triples(GraphName.EPISODES)):
        layout = layouts.get(record.lesson)
        if record.lesson in lessons or layout is None or not chosen.holds_of_lesson(record, whole=False):
            continue
        script = script_without(record, layout, chosen.all.sentence, knowledge.ontology)
        if script is None:
            continue
        own_events, meaning = events.get(record.lesson, ()), knowledge.meaning_before(record.lesson)
        lesson = lesson_of_script(script, record, record.engine, own_events, meaning)
        gone += [record.lesson] if lesson is None else []
        revised += [] if lesson is None else [lesson]
    return gone, revised


def _teachings(memory: LevelMemory, knowledge: KnowledgeStore) -> dict[str, Teachings]:
    """Return all teachings of all views."""
    from deixis.memory.perceptual.database import keys
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


def _without(
    turns: Teachings, lessons: Sequence[str], revised: Mapping[str, Lesson], chosen: _Chosen, view: str
) -> Teachings:
    """Return the teachings of a view that stay; those of a revised lesson are as it teaches them now."""
    kept_turns = (turn for turn in turns if _origin(turn) not in lessons)
    left = (_now(turn, revised.get(_origin(turn) or "")) for turn in kept_turns)
    return tuple(turn for turn in left if turn is not None and not chosen.holds_of_teaching(turn, view))


def _now(turn: Teaching, lesson: Lesson | None) -> Teaching | None:
    """Return what the revised lesson of a teaching teaches now, None for nothing; other teachings stay."""
    if lesson is None:
        return turn
    if SETTLES in turn.metadata:
        return turn if turn.metadata[SETTLES][1] in {role.name for role in lesson.layout.roles} else None
    things = {match.perceived: plain_name(match.object) for match in lesson.categories()}
    category = things.get(str(turn.metadata.get("object")))
    return None if category is None else replace(turn, category=category)


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
    revised: Sequence[Lesson],
    before: Mapping[str, Teachings],
    after: Mapping[str, Teachings],
    memory: LevelMemory | None,
    knowledge: KnowledgeStore,
    episodes: Part | None,
    progress: Progress | None,
) -> None:
    """Write what is left of the teachings of views, remove the lessons, and change the episodes."""
    from deixis.learning.views.views import batch_without
    from deixis.memory.semantic.rdf.links import Link

    gone = [view for view, turns in after.items() if not turns]
    now = {view: prevailing(turns) for view, turns in after.items() if turns}
    changed = {view: turn for view, turn in now.items() if turn != prevailing(before[view])}
    new = {lesson.id for lesson in revised}  # their links are written again
    kept = {view: turns for view, turns in before.items() if any(turn.lesson in new for turn in turns)}
    links: dict[str, list[Link]] = {view: [] for view in after}
    owners: dict[str, str | None] = {}
    for view, turns in {**kept, **after}.items():
        turn = prevailing(turns) if turns else None
        if turn is None:
            continue
        by_lessons = () if turn.is_by_hand else dict.fromkeys(each.lesson for each in turns if each.lesson is not None)
        links[view] = [Link(lesson, view, turn.category) for lesson in by_lessons]
        if view in after:
            owners[view] = turn.lesson or next(reversed(tuple(by_lessons)), None)
    parts = [] if episodes is None else [episodes]
    if memory is not None and after:
        batch = batch_without(memory, gone, changed)
        left = {view: written(after[view]) for view in now}
        change = memory.writing(replace(batch, lessons=owners, teachings=left))
        if not knowledge.exists() and not parts:
            memory.handle.write(change, sync=True)
            return
        parts.append(memory.handle.part(change))
    knowledge.memory(create=True)  # it decides a write of the others
    write_together(knowledge.unlearning(lessons, links, revised, progress), parts)
