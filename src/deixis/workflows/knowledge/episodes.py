"""Services over the blackboard: files of fluents, consistency, classes, memories by name, and consolidation."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.errors import DeixisError, UnknownTermError
from deixis.grammar.formats.fluents import FluentFile, bounds_to_json, format_fluents, parse_fluents
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import CONSOLIDATED, RECORDED, Experience, Holding, episode, experiences
from deixis.memory.episodes.fluents.changes import Add, Change, Logged
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.subscription import Subscription
from deixis.ontology.graph.facts import Fact
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import Ontology
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.errors import LimitError
from deixis.reasoning.temporal.errors import TemporalConflictError
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern
from deixis.reasoning.temporal.timeline import Timeline
from deixis.spelling import nearest

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.memory.journal import Part
    from deixis.memory.perceptual.protocol import Progress
    from deixis.ontology.lessons.types import LayoutConcept, Lesson
    from deixis.perception.scene import Scene
    from deixis.workflows.knowledge.learn import Learned, Recording

TIMELINE = 100
"""Number of fluents whose times are checked together."""

MAX_SITUATIONS = 200
"""Maximum number of situations of an aggregate whose spatial or logical consistency is checked."""


class Memory(StrEnum):
    """The five memories of the robot."""

    WORKING = "working"
    EPISODIC = "episodic"
    SEMANTIC = "semantic"
    PERCEPTUAL = "perceptual"
    PROCEDURAL = "procedural"


_NAMED = re.compile(
    r"\s*this is how (?:an? )?['\"‘“]?(?P<name>[^'\"’”.:]{1,60}?)['\"’”]? is laid[.:]\s*", re.IGNORECASE
)
"""Sentence before a description that names the layout."""


class _Board(Holding, Protocol):
    """The methods of a robot's board that consolidation calls."""

    def new_id(self, prefix: str) -> str:
        """Return an id that this memory has never given before."""
        ...

    def write(self, *changes: Change) -> int:
        """Write changes as one."""
        ...

    def part(self, *changes: Change) -> Part:
        """Return changes as a part of a write over several stores."""
        ...


_Episodes = Blackboard | _Board


class _Learner(Protocol):
    """The methods of a session that these services call."""

    @property
    def ontology(self) -> Ontology:
        """Words that scripts may use."""
        ...

    def learn(
        self, script: Script, scene: Scene, *, events: Sequence[str] = (), episodes: Recording | None = None
    ) -> Learned:
        """Ground a script in a scene, and keep the layout and the look of its objects."""
        ...

    def lessons_of_events(self) -> dict[str, str]:
        """Return the lessons that sentences taught, by their events."""
        ...

    def remembers(self) -> bool:
        """Return whether there is a semantic memory."""
        ...

    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Return all learned layouts."""
        ...

    def has_views(self) -> bool:
        """Return whether there is a perceptual memory."""
        ...

    def categories(self) -> dict[str, int]:
        """Return the number of views of each taught category."""
        ...


def text_of_fluents(
    board: Blackboard, pattern: Pattern = ANYTHING, start: float | None = None, end: float | None = None
) -> str:
    """Return what held in a window as a file of fluents, which ``deixis time`` reads.

    Parameters
    ----------
    board
        The blackboard.
    pattern
        Subject, predicate and object; None matches everything.
    start, end
        Ends of the window in seconds; by default it has no end on that side.

    Returns
    -------
    str
        Text of the file.
    """
    held = board.holding(pattern, start, end)
    return format_fluents(FluentFile(board.origin.isoformat(), tuple(each.fluent for each in held)))


def fluents_of_text(text: str, file: str, source: Source) -> tuple[EpisodicFluent, ...]:
    """Return the fluents of a file for the blackboard.

    Parameters
    ----------
    text
        Text of a file of fluents.
    file
        Its name in messages.
    source
        How they became known, and by whom.

    Returns
    -------
    tuple of EpisodicFluent
        The fluents, each certain.

    Raises
    ------
    FluentFileError
        If the text has an error; the message names the place.
    """
    return tuple(EpisodicFluent(fluent, 1.0, source) for fluent in parse_fluents(text, file).fluents)


def fluent_to_dict(fluent: EpisodicFluent) -> dict[str, Any]:
    """Return a fluent of the blackboard as plain data.

    Parameters
    ----------
    fluent
        The fluent.

    Returns
    -------
    dict
        Its id, statement, times as in a file of fluents, certainty and source.
    """
    statement, source = fluent.statement, fluent.source
    return {
        "id": fluent.id,
        "statement": [
            statement.subject,
            statement.predicate,
            *([] if statement.object is None else [statement.object]),
        ],
        "start": bounds_to_json(fluent.start),
        "finish": bounds_to_json(fluent.finish),
        "certainty": fluent.certainty,
        "origin": source.origin.value,
        "by": source.by,
        "event": source.event,
    }


def span_of(fluents: Sequence[EpisodicFluent]) -> tuple[float, float]:
    """Return the stretch of time in which the known starts and finishes of fluents lie.

    Parameters
    ----------
    fluents
        The fluents.

    Returns
    -------
    tuple of float
        Start and finish in seconds.

    Raises
    ------
    DeixisError
        If no two times are known.
    """
    ends = [time for each in fluents for bounds in (each.start, each.finish) for time in (bounds.lower, bounds.upper)]
    known = [time for time in ends if math.isfinite(time)]
    if len(set(known)) < 2:
        raise DeixisError("an experience needs at least two known times of its fluents")
    return min(known), max(known)


@dataclass(frozen=True)
class Consistency:
    """Contradictions in an aggregate of fluents, one line each; all are empty for a consistent one.

    ``undecided`` names what the limits of time and size left open.
    """

    temporal: tuple[str, ...] = ()
    spatial: tuple[str, ...] = ()
    logical: tuple[str, ...] = ()
    undecided: tuple[str, ...] = ()

    @property
    def consistent(self) -> bool:
        """True if no contradiction was found."""
        return not (self.temporal or self.spatial or self.logical)


def check_consistency(
    fluents: Sequence[EpisodicFluent], ontology: Ontology, time_limit: float = 30.0, logical: bool = True
) -> Consistency:
    """Check whether fluents can all be true: by their times, in space at each time, and by the ontology.

    Parameters
    ----------
    fluents
        The aggregate.
    ontology
        Relations, and kinds of things.
    time_limit
        Seconds for all checks.
    logical
        False to leave out the check by the ontology, which takes about a second.

    Returns
    -------
    Consistency
        The contradictions. Spatial and logical ones are of what certainly holds at one time; logical ones are found by
        the rules of OWL 2 RL.
    """
    deadline = Deadline.after(time_limit)
    undecided: list[str] = []
    temporal = tuple(_temporal(fluents, deadline, undecided))
    spatial = tuple(_spatial(fluents, ontology, deadline, undecided))
    found = tuple(_logical(fluents, ontology, deadline, undecided)) if logical else ()
    return Consistency(temporal, spatial, found, tuple(undecided))


def _temporal(fluents: Sequence[EpisodicFluent], deadline: Deadline, undecided: list[str]) -> Iterator[str]:
    for number, each in enumerate(fluents):
        if deadline.passed:
            left = len(fluents) - number
            undecided.append(f"time limit reached before {left} of {len(fluents)} fluents were checked in time")
            break
        if number % TIMELINE == 0:  # the times of one fluent do not depend on those of another
            timeline = Timeline()
        try:
            timeline.add(each.fluent, max(0.1, deadline.left))
        except TemporalConflictError as conflict:
            yield str(conflict).splitlines()[0]
        except DeixisError as error:
            yield str(error)
    by_statement: dict[str, list[EpisodicFluent]] = {}
    for each in fluents:
        if each.statement.predicate == "at":
            by_statement.setdefault(each.statement.subject, []).append(each)
    for subject, places in by_statement.items():
        places.sort(key=lambda each: (each.start.upper, each.id))
        for one, other in pairwise(places):
            together = one.must_hold(other.start.upper, math.inf) and one.finish.lower > other.start.upper
            if one.statement.object != other.statement.object and together:
                yield f"'{subject}' is at two places at {other.start.upper:g} s: '{one.id}' and '{other.id}'"


def _spatial(
    fluents: Sequence[EpisodicFluent], ontology: Ontology, deadline: Deadline, undecided: list[str]
) -> Iterator[str]:
    known = {relation.name: relation for relation in ontology.relations.values()}
    known |= {relation.iri.rpartition("#")[2]: relation for relation in ontology.relations.values()}
    related = [each for each in fluents if each.statement.predicate in known and each.statement.object is not None]
    for time, held in _situations(related, undecided, "in space"):
        if deadline.passed:
            undecided.append("time limit reached before all situations were checked in space")
            return
        facts = [
            Fact(each.statement.subject, (known[each.statement.predicate],), str(each.statement.object))
            for each in held
        ]
        names = sorted({name for fact in facts for name in (fact.subject, fact.object)})
        try:
            implied = Implications(RelationGraph.from_facts(ontology.relations, names, facts), max(0.1, deadline.left))
            conflict = None if implied.consistent else find_conflict(implied)
        except LimitError as error:
            undecided.append(f"at {time:g} s: {error}")
            continue
        if conflict is not None:
            stated = ", ".join(map(str, conflict.facts))
            yield f"at {time:g} s: {conflict.reason} ({stated})"


def _logical(
    fluents: Sequence[EpisodicFluent], ontology: Ontology, deadline: Deadline, undecided: list[str]
) -> Iterator[str]:
    import pyoxigraph as ox

    from deixis.memory.episodes.rdf.observations import TYPE, statement_triple, thing_iri
    from deixis.memory.semantic.rdf.graphs import GraphName
    from deixis.memory.semantic.rdf.package import packaged
    from deixis.ontology.rdf.triples import with_blank_nodes
    from deixis.reasoning.description_logic.entailment import LogicEngine, entail
    from deixis.reasoning.description_logic.justification import justify

    stated: dict[str, ox.Triple] = {}
    for each in fluents:
        statement = each.statement
        if statement.predicate == "isA" and statement.object is not None:
            kind, _ = ontology.of_name(statement.object)
            if kind is not None:
                stated[each.id] = ox.Triple(thing_iri(statement.subject), TYPE, ox.NamedNode(kind.iri))
        elif statement.object is not None and statement.predicate in ontology.relations:
            stated[each.id] = statement_triple(statement)
    terms = set(packaged()[GraphName.ONTOLOGY])

    def text_of(some: Iterable[EpisodicFluent]) -> str:
        triples = terms | {stated[each.id] for each in some}
        return (ox.serialize(with_blank_nodes(triples), format=ox.RdfFormat.N_TRIPLES) or b"").decode("utf-8")

    stated_fluents = [each for each in fluents if each.id in stated]
    try:
        if deadline.passed:
            raise LimitError("no time left")
        if entail(text_of(stated_fluents), LogicEngine.RL, deadline.left).consistent:
            return  # then what held at one time is consistent too
        for time, held in _situations(stated_fluents, undecided, "by the ontology"):
            if deadline.passed:
                raise LimitError("no time left")
            text = text_of(held)
            if entail(text, LogicEngine.RL, deadline.left).consistent:
                continue
            among = held
            with suppress(LimitError):
                axioms = justify(text, None, deadline).ntriples
                needed = set(ox.parse(axioms, format=ox.RdfFormat.N_TRIPLES))
                among = [each for each in held if any(quad.triple == stated[each.id] for quad in needed)]
            statements = "; ".join(sorted(str(each.statement) for each in among))
            yield f"at {time:g} s: the kinds and relations contradict the ontology: {statements}"
    except LimitError:
        undecided.append("time limit reached before the check of the fluents by the ontology was done")


def _situations(
    fluents: Sequence[EpisodicFluent], undecided: list[str], checked: str
) -> Iterator[tuple[float, list[EpisodicFluent]]]:
    """Yield the sets of fluents that certainly hold at one time, each with the first such time.

    A fluent without any times is a plain triple, which always holds.
    """
    times = sorted({each.start.upper for each in fluents if math.isfinite(each.start.upper)}) or [0.0]
    if len(times) > MAX_SITUATIONS:
        undecided.append(f"only the first {MAX_SITUATIONS} of {len(times)} situations were checked {checked}")
    seen: set[frozenset[str]] = set()
    for time in times[:MAX_SITUATIONS]:
        held = [each for each in fluents if _is_plain(each) or each.must_hold(time, time)]
        ids = frozenset(each.id for each in held)
        if ids not in seen:
            seen.add(ids)
            yield time, held


def _is_plain(fluent: EpisodicFluent) -> bool:
    """Return whether a fluent has no times."""
    return all(math.isinf(end) for bounds in (fluent.start, fluent.finish) for end in (bounds.lower, bounds.upper))


def change_to_dict(change: Logged) -> dict[str, Any]:
    """Return a change of the blackboard as plain data.

    Parameters
    ----------
    change
        The change.

    Returns
    -------
    dict
        Its sequence number and that of the last change of the same write, its kind, who wrote it and when (seconds
        since 1970), and the fluent before and after it.
    """
    return {
        "sequence": change.sequence,
        "last": change.last,
        "kind": change.kind,
        "by": change.by,
        "written": change.written,
        "before": None if change.before is None else fluent_to_dict(change.before),
        "after": None if change.after is None else fluent_to_dict(change.after),
    }


def experience_to_dict(experience: Experience) -> dict[str, Any]:
    """Return an experience as plain data.

    Parameters
    ----------
    experience
        The experience.

    Returns
    -------
    dict
        Its name, the id of its fluent, and its start and finish in seconds; the finish is None while it is recorded.
    """
    return {"name": experience.name, "id": experience.id, "start": experience.start, "finish": experience.finish}


class KnownClass(NamedTuple):
    """A class of things: its name, its broader classes, and the individuals that are of it now."""

    name: str
    broader: tuple[str, ...]
    individuals: tuple[str, ...]


def known_classes(board: Blackboard, ontology: Ontology, under: str | None = None) -> tuple[KnownClass, ...]:
    """Return the classes of the ontology and of the blackboard, with their individuals.

    Parameters
    ----------
    board
        The blackboard, whose statements ``isA`` that hold now give the individuals.
    ontology
        The kinds of things.
    under
        Name of a class; only its subclasses and itself.

    Returns
    -------
    tuple of KnownClass
        The classes by name.

    Raises
    ------
    UnknownTermError
        If there is no class ``under``.
    """
    names = {kind.iri: kind.name for kind in ontology.kinds}
    broader = {kind.name: tuple(sorted(names[iri] for iri in kind.broader if iri in names)) for kind in ontology.kinds}
    members: dict[str, dict[str, None]] = {}
    for each in board.now(Pattern(predicate="isA")):
        kind_name = str(each.statement.object)
        kind, _ = ontology.of_name(kind_name)
        name = kind_name if kind is None else kind.name
        broader.setdefault(name, ())
        members.setdefault(name, {})[each.statement.subject] = None
    if under is not None:
        kind, _ = ontology.of_name(under)
        top = under if kind is None else kind.name
        if top not in broader:
            meant = nearest(top, broader)
            raise UnknownTermError(f"there is no class '{under}'" + (f"; did you mean '{meant}'?" if meant else ""))
        broader = {name: above for name, above in broader.items() if name == top or top in above}
    return tuple(KnownClass(name, broader[name], tuple(members.get(name, {}))) for name in sorted(broader))


def memory_lines(which: Memory, board: Blackboard, session: _Learner) -> Iterator[str]:
    """Yield the content of one of the five memories, one line for each entry.

    Parameters
    ----------
    which
        The memory.
    board
        The blackboard.
    session
        The session with the semantic and the perceptual memory.

    Yields
    ------
    str
        A fluent of the current situation, an experience, a learned layout, or a category with its views; nothing for
        the procedural memory, which comes with the acting robot.
    """
    if which is Memory.WORKING:
        yield from map(str, board.now())
    elif which is Memory.EPISODIC:
        yield from map(str, experiences(board))
    elif which is Memory.SEMANTIC and session.remembers():
        yield from (f"layout {layout.name}" for layout in session.layouts())
    elif which is Memory.PERCEPTUAL and session.has_views():
        yield from (f"category {name}: {views} views" for name, views in session.categories().items())


def memory_to_dict(which: Memory, board: Blackboard, session: _Learner) -> dict[str, Any]:
    """Return the content of one of the five memories as plain data.

    Parameters
    ----------
    which
        The memory.
    board
        The blackboard.
    session
        The session with the semantic and the perceptual memory.

    Returns
    -------
    dict
        The name of the memory, and its ``fluents``, ``experiences``, ``layouts`` or ``categories``; only the name for
        the procedural memory.
    """
    content: dict[str, Any] = {}
    if which is Memory.WORKING:
        content["fluents"] = [fluent_to_dict(each) for each in board.now()]
    elif which is Memory.EPISODIC:
        content["experiences"] = [experience_to_dict(each) for each in experiences(board)]
    elif which is Memory.SEMANTIC:
        content["layouts"] = [layout.name for layout in session.layouts()]
    elif which is Memory.PERCEPTUAL:
        content["categories"] = dict(session.categories()) if session.has_views() else {}
    return {"memory": which.value, **content}


def scene_of(fluents: Sequence[EpisodicFluent], at: float) -> Scene | None:
    """Return the scene that fluents describe at a time.

    Parameters
    ----------
    fluents
        Fluents; the object of ``at`` is a box in metres, ``[x0, y0, z0, x1, y1, z1]`` or without z, that of ``isA`` a
        label.
    at
        The time in seconds.

    Returns
    -------
    Scene or None
        The scene; None if no thing has a box then.
    """
    from deixis.perception.scene import PerceivedObject, Scene

    held = [each for each in fluents if each.may_hold(at, at)]
    labels = {each.statement.subject: each for each in held if each.statement.predicate == "isA"}
    things = []
    for each in held:
        if each.statement.predicate == "at":
            corners = _box(str(each.statement.object))
            label = labels.get(each.statement.subject)
            named = {} if label is None else {"label": label.statement.object, "confidence": label.certainty}
            if corners is not None:
                half = len(corners) // 2
                things.append(PerceivedObject(each.statement.subject, corners[:half], corners[half:], **named))  # type: ignore[arg-type]
    return Scene(tuple(things)) if things else None


def _box(text: str) -> tuple[float, ...] | None:
    """Return the corners in a text, flat or as the lower and the upper one; None if it has no box."""
    import numpy as np

    try:
        corners = np.array(json.loads(text), dtype=np.float64).reshape(2, -1)
    except (ValueError, TypeError, OverflowError, RecursionError):
        return None
    fits = corners.shape[1] in (2, 3) and np.isfinite(corners).all() and (corners[0] <= corners[1]).all()
    return tuple(corners.ravel().tolist()) if fits else None


@dataclass(frozen=True, repr=False)
class Consolidation(Answer):
    """Lessons learned from experiences, and why other experiences taught nothing.

    Attributes
    ----------
    lessons
        Id of the lesson of each experience that taught one, by the name of the experience.
    left_out
        Reason why each other experience taught nothing, by its name.

    Examples
    --------
    >>> Consolidation({"dinner": "dinner-1"}, {"walk": "nothing was said in it"})
    <Consolidation 1 lesson, 1 experience left out>
    """

    lessons: dict[str, str]
    left_out: dict[str, str]

    def summary(self) -> str:
        """Return the answer in a few words, for ``repr``.

        Returns
        -------
        str
            The summary, without the name of the type.
        """
        left_out = f", {count(len(self.left_out), 'experience')} left out" if self.left_out else ""
        return f"{count(len(self.lessons), 'lesson')}{left_out}"


def named_layout(text: str) -> tuple[str | None, str]:
    """Return the name that a description gives its layout at the beginning, and the rest of the description.

    Parameters
    ----------
    text
        The description in English.

    Returns
    -------
    name : str or None
        Name of the layout, valid as the name of a script; None without one.
    rest : str
        The description without the sentence that names it.

    Examples
    --------
    >>> named_layout("This is how a 'work place' is laid. The fork is left of the plate.")
    ('work_place', 'The fork is left of the plate.')
    """
    named = _NAMED.match(text)
    return (None, text) if named is None else (named["name"].strip().replace(" ", "_"), text[named.end() :])


def consolidate(
    board: _Episodes,
    session: _Learner,
    by: str = "consolidation",
    undescribed: Callable[[Scene], object] | None = None,
    progress: Progress | None = None,
) -> Consolidation:
    """Learn a layout from each finished experience that a person described, once.

    Experiences of layouts with one name are tables of one layout. What taught a lesson when it was said is not learned
    again. A layout that the words do not name has the name of the experience.

    Parameters
    ----------
    board
        The blackboard, or a robot's board.
    session
        The session or robot that learns: it grounds the words in what lay on the table at the end of the experience.
    by
        Name under which the lessons are written to a blackboard.
    undescribed
        Called, once, with the table of each experience in which nothing was said.
    progress
        Called with the number of experiences that are done, and of all.

    Returns
    -------
    Consolidation
        The lessons, and the reasons for the others. An experience is marked when it was consolidated.
    """
    done = {each.statement.subject for each in board.holding(Pattern(predicate=CONSOLIDATED))}
    lessons: dict[str, str] = {}
    left_out: dict[str, str] = {}
    finished = [(each, each.finish) for each in experiences(board) if each.finish is not None and each.name not in done]
    for number, (each, finish) in enumerate(finished):
        if progress is not None:
            progress(number, len(finished))
        fluents = episode(board, each.name)
        last = math.nextafter(finish, -math.inf)
        known = {layout.lesson for layout in session.layouts()}
        words = [  # in this experience, not before
            f for f in fluents if f.statement.predicate == "said" and f.start.lower >= each.start
        ]
        scene = scene_of(fluents, last)
        lesson_of_event = {**session.lessons_of_events(), **dict(zip(known, known, strict=True))}
        taught = next((lesson_of_event[f.source.event] for f in words if f.source.event in lesson_of_event), None)
        if taught is None:
            if not words or scene is None:
                left_out[each.name] = "nothing was said in it" if not words else "no thing has a place in it"
                if scene is not None and undescribed is not None:
                    undescribed(scene)
                    _write(board, _mark(board, each, None, by), by)
                continue
            try:
                taught = _learned(each, words, scene, session, partial(_marked, board, each, by))
            except DeixisError as error:
                left_out[each.name] = str(error).splitlines()[0]
                continue
        else:
            _write(board, _mark(board, each, taught, by), by)
        lessons[each.name] = taught
    return Consolidation(lessons, left_out)


def _learned(
    experience: Experience, words: Sequence[EpisodicFluent], scene: Scene, session: _Learner, episodes: Recording
) -> str:
    """Learn the layout that words describe from a table, and return the id of the lesson."""
    from deixis.workflows.layouts.read import read_layout_or_english

    name, rest = named_layout("\n".join(str(each.statement.object) for each in words))
    script = read_layout_or_english(rest, session.ontology)
    if own := script.name or name:
        script = replace(script, name=own)
    else:
        script = replace(script, name=re.sub(r"\W+", "_", experience.name), title=experience.name)
    events = list(dict.fromkeys(each.source.event for each in words if each.source.event is not None))
    return session.learn(script, scene, events=events, episodes=episodes).lesson.id


def _marked(board: _Episodes, experience: Experience, by: str, lessons: Sequence[Lesson]) -> Part:
    """Return what the blackboard says about the lesson of an experience, as a part of its write."""
    mark = _mark(board, experience, lessons[0].id, by)
    return board.part(mark, by=by) if isinstance(board, Blackboard) else board.part(mark)


def _write(board: _Episodes, change: Change, by: str) -> None:
    board.write(change, by=by) if isinstance(board, Blackboard) else board.write(change)


def _mark(board: _Episodes, experience: Experience, lesson: str | None, by: str) -> Change:
    """Return the change that says that an experience was consolidated, and which lesson it taught."""
    source = Source(Origin.INFERRED, by, experience.id)
    statement = (experience.name, CONSOLIDATED, lesson)
    return Add(episodic(board.new_id("c"), statement, start=experience.finish, source=source))


def consolidate_in_background(
    board: Blackboard, session: _Learner, done: Callable[[Consolidation], object] = lambda result: None
) -> Subscription:
    """Consolidate each experience when its recording finishes, in a thread of its own.

    Parameters
    ----------
    board
        The blackboard.
    session
        The session that learns; its methods must be safe to call from threads.
    done
        Called with each result.

    Returns
    -------
    Subscription
        The subscription; cancel it to end the task.
    """

    def recorded(change: Logged) -> None:
        if change.after is not None and not change.after.is_open:
            done(consolidate(board, session))

    return board.subscribe("consolidation", Pattern(predicate=RECORDED), recorded)
