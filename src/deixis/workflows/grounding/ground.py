"""Ground a script in a scene: one request with every option, and the one function that answers it.

Python (:func:`deixis.ground`, ``Session.ground``) and the command line (``deixis ground``) build the same
:class:`GroundingRequest`, so that both have the same options and give the same answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.grammar.script import Script
from deixis.learning.attributes import attribute_ratios
from deixis.learning.lessons.scene_evidence import (
    conflict_notes,
    graph_evidence,
    shortlisted_evidence,
    surface_thing,
    unit_notes,
    viewpoint_notes,
)
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.lessons.types import Match
from deixis.perception.scene import Scene
from deixis.reasoning.entailment.claim_facts import implications_with_claims
from deixis.reasoning.entailment.conflict import Conflict, find_conflict
from deixis.reasoning.entailment.implications import TIME_LIMIT, Implications
from deixis.reasoning.errors import LimitError, OutOfTimeError, SettingError, require_time_limit
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.ground import ground as ground_evidence
from deixis.reasoning.grounding.memory_budget import (
    DEFAULT_MEMORY_LIMIT,
    different_facts,
    leaves_room_for_chains,
    require_memory_limit,
    required_gigabytes,
)
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT, EngineName, Select, ViewpointName
from deixis.workflows.layouts.read import as_scene, as_script

if TYPE_CHECKING:
    from deixis.reasoning.attributes.attribute import Attribute
    from deixis.workflows.grounding.dialogue import Ask

CONFLICT_SHARE = 0.15
"""Share of the time limit that may be spent on whether the facts can hold together."""

TEXT_SIZES_SHARE = 0.3
"""Weight of the usual sizes for texts in English, as a share of that for layouts: a noun in a text often does not have
the size of its kind (*toy train*, *camp stove*), and two such nouns would make the scene another one."""

SIDES_HELD = {ViewpointName.STATED: 1, ViewpointName.QUARTER: 3, ViewpointName.UNKNOWN: 7}
"""Factor on the number of things in the estimate of memory; its square is the number of viewpoints searched at once."""

MIN_SHORTLISTED, PAIRS_PER_SECOND = 10, 4e5
"""Minimum number of things per object at which a shortlist pays off, and approximate number of pairs of things that
grounding processes in a second."""

MAX_LISTED = 3
"""Maximum number of facts that a note lists."""

Stage = Callable[[str], AbstractContextManager[None]]
"""Function that returns a context for one stage of the work, from the name of the stage."""


@dataclass(frozen=True, eq=False)
class GroundingRequest:
    """Script and scene to ground it in, with the settings.

    The relation graph of the script, what it implies and whether it contradicts itself are computed once, when they
    are first needed.

    Parameters
    ----------
    script, scene
        What was said, and what was seen.
    engine
        ``exact``, ``scalable``, ``similarity`` (the paper's), ``blondel`` or ``heymans-singh``.
    select
        What chooses among sub-graphs under the paper's engine: ``facts``, or ``similarity`` alone as in the paper.
    literal
        Take words literally, not by degrees.
    sizes
        Take into account how large things usually are.
    viewpoint
        ``stated``: that of the scene; or recovered, by ``quarter`` turns, or ``unknown``, from any angle.
    ask
        Who answers questions that tell the likeliest groundings apart: the truth as a mapping from names to ids (None
        for what is absent), a function of the question and the situation that returns the answer (None to end), or a
        :class:`deixis.workflows.grounding.dialogue.Dialogue`. None asks nothing. Only the engine ``exact`` asks.
    max_questions
        Maximum number of questions.
    time_limit
        Seconds until the answer, proved or not; a person who answers is given the time that it takes.
    memory_limit
        Gigabytes (10^9 bytes) that the answer may take beyond the program itself. What takes more is refused before it
        is begun.
    attributes
        Learned adjectives by word, which count where they are part of a name (*blick cup*).
    deadline
        When the answer is due, where the time limit began before the request was made, as with reading. None begins it
        now.
    meaning
        How words and sizes are taken: as shipped, or as a memory has learned them (``Session.meaning()``).

    Raises
    ------
    DeixisError
        For a setting with another value.
    """

    script: Script
    scene: Scene
    engine: str = EngineName.EXACT
    select: str = Select.FACTS
    literal: bool = False
    sizes: bool = True
    viewpoint: str = ViewpointName.STATED
    ask: Ask | None = None
    max_questions: int | None = None
    time_limit: float = DEFAULT_TIME_LIMIT
    meaning: Meaning = SHIPPED
    memory_limit: float = DEFAULT_MEMORY_LIMIT
    deadline: Deadline | None = None
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def __post_init__(self) -> None:
        require_time_limit(self.time_limit)
        require_memory_limit(self.memory_limit)
        for what, value, choices in (
            ("select", self.select, Select),
            ("viewpoint", self.viewpoint, ViewpointName),
        ):
            if value not in list(choices):
                raise SettingError(f"`{what}` must be one of {', '.join(choices)}, got '{value}'")
        if self.ask is not None and self.engine != EngineName.EXACT:
            raise SettingError(f"only the engine 'exact' asks, got '{self.engine}'; leave out --engine (engine=)")
        if self.ask is not None:
            from deixis.workflows.grounding.dialogue import Dialogue

            if not (isinstance(self.ask, Dialogue | Mapping) or callable(self.ask)):
                raise SettingError(f"`ask` must be a mapping, a function or a Dialogue, got {self.ask!r:.60}")
        if self.max_questions is not None:
            if self.max_questions < 1:
                raise SettingError(f"`max_questions` must be at least 1, got {self.max_questions}")
            if self.ask is None:
                raise SettingError(
                    "`max_questions` needs a source of answers: add --ask or --oracle (ask=), or leave it out"
                )
        object.__setattr__(self, "deadline", self.deadline or Deadline.after(self.time_limit))

    @property
    def due(self) -> Deadline:
        """Deadline of the answer."""
        assert self.deadline is not None
        return self.deadline

    @cached_property
    def graph(self) -> RelationGraph:
        """Description: the script's facts as a relation graph."""
        return self.script.graph()

    @cached_property
    def implied(self) -> Implications:
        """Implications of the description."""
        return Implications(self.graph, min(TIME_LIMIT, self.due.share(CONFLICT_SHARE).left))

    @cached_property
    def surface(self) -> tuple[str, str] | None:
        """Word of the script for what its objects stand on, and the perceived thing that this is; None without one."""
        name = self.script.surface
        thing = surface_thing(name, self.graph, self.scene, self.script.ontology.kinds)
        return None if name is None or thing is None else (name, thing)

    @cached_property
    def conflict(self) -> Conflict | None:
        """Minimal set of facts, stated or implied by claims, that cannot hold together; None for a consistent script.

        Raises OutOfTimeError if the time limit is reached first, and LimitError if there are too many objects.
        """
        if not self.script.claims:
            return find_conflict(self.implied)
        return find_conflict(implications_with_claims(self.graph, self.script.claims, self.implied.time_limit)[1][-1])

    @cached_property
    def shortlisted(self) -> bool:
        """True if only a shortlist of the scene's things is compared, as all pairs take too much memory or time."""
        if self.engine not in (EngineName.EXACT, EngineName.SCALABLE) or self.viewpoint != ViewpointName.STATED:
            return False
        if self.ask is not None:  # the truth may be off the list
            return False
        objects, things = len(self.graph.nodes), len(self.scene.objects)
        if things <= MIN_SHORTLISTED * objects:
            return False
        needed = required_gigabytes(objects, things, len(self.graph), different_facts(self.graph))
        return needed > self.memory_limit or things**2 * self.due.slowness > PAIRS_PER_SECOND * self.due.left

    @cached_property
    def memory_limited(self) -> bool:
        """True if the memory limit leaves no room to sample marginals.

        Raises OutOfMemoryError where it leaves no room for an answer.
        """
        things = len(self.scene.objects) * SIDES_HELD[ViewpointName(self.viewpoint)]
        return not leaves_room_for_chains(self.graph, things, self.memory_limit)

    @cached_property
    def effective_meaning(self) -> Meaning:
        """The meaning, less what the request leaves out."""
        share = 0.0 if not self.sizes else 1.0 if self.script.reading is None else TEXT_SIZES_SHARE
        weights = replace(self.meaning.weights, sizes=share * self.meaning.weights.sizes)
        return replace(self.meaning, graded=self.meaning.graded and not self.literal, weights=weights)

    def evidence(self, scene: Scene, keep_surface_free: bool = True) -> Evidence:
        """Return the evidence for which thing each name refers to, in the scene as seen from one side.

        Parameters
        ----------
        scene
            The scene as seen from one side.
        keep_surface_free
            Let no name but that of the surface be the thing that the others stand on.

        Returns
        -------
        Evidence
            Log-likelihood ratios of names and things, and of pairs.
        """
        if self.shortlisted:
            known = shortlisted_evidence(
                self.graph, scene, self.script.ontology, self.effective_meaning, self.memory_limit, self.due
            )
            return replace(known, consistent=self._consistent, uncounted=self.script.uncounted)
        memory_limited = self.memory_limited
        known = graph_evidence(
            self.graph,
            scene,
            self.script.ontology,
            self.effective_meaning,
            deadline=self.due,
            claims=self.script.claims,
        )
        if self.attributes:
            known = replace(known, sizes=known.sizes + attribute_ratios(self.graph.nodes, scene, self.attributes))
        if self.surface is not None and keep_surface_free:
            known = known.with_surface(self.surface[1])
        return replace(
            known, memory_limited=memory_limited, consistent=self._consistent, uncounted=self.script.uncounted
        )

    @cached_property
    def _consistent(self) -> bool:
        """True if the firm facts can hold together; False where there are too many objects to decide."""
        try:
            return self.implied.consistent
        except LimitError:
            return False


@checks_arguments
def ground(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    engine: str = EngineName.EXACT,
    time_limit: float = DEFAULT_TIME_LIMIT,
    select: str = Select.FACTS,
    meaning: Meaning = SHIPPED,
    viewpoint: str = ViewpointName.STATED,
    *,
    memory_limit: float = DEFAULT_MEMORY_LIMIT,
    literal: bool = False,
    sizes: bool = True,
    ask: Ask | None = None,
    max_questions: int | None = None,
    attributes: Mapping[str, Attribute] = MappingProxyType({}),
) -> Grounding:
    """Find which perceived thing each object of a script refers to.

    The answer comes within about ``time_limit`` seconds, with loading and reading, and says whether it is proved.

    Parameters
    ----------
    script, scene
        The script and the scene, or their files; a scene may be parsed JSON.
    engine
        ``exact``, ``scalable``, ``similarity`` (the paper's), ``blondel`` or ``heymans-singh``.
    time_limit
        Seconds until the answer; a person who answers questions is given more time.
    select
        Choice among sub-graphs under the paper's engine: ``facts``, or ``similarity`` alone as in the paper.
    meaning
        Words and sizes, as shipped or as a memory has learned them (``Session.meaning()``).
    viewpoint
        ``stated``: that of the scene; or recovered, by ``quarter`` turns, or ``unknown``, from any angle.
    memory_limit
        Gigabytes (10^9 bytes) that the answer may take beyond the program itself.
    literal
        True to take words literally, not by degrees.
    sizes
        True to take into account how large things usually are.
    ask
        Source of answers to questions that tell the likeliest groundings apart: the truth as a mapping from names to
        ids (None for what is absent), a function of the question and the situation (None ends the dialogue), or a
        :class:`deixis.workflows.grounding.dialogue.Dialogue`. None asks nothing.
    max_questions
        Maximum number of questions.
    attributes
        Learned adjectives by word, which count where they are part of a name (*blick cup*).

    Returns
    -------
    Grounding
        The match of each object with its posterior probability, the outcome of each fact, and notes.

    Raises
    ------
    DeixisError
        For bad input or settings.
    OutOfTimeError, OutOfMemoryError
        If the limits leave no answer.

    Examples
    --------
    >>> import deixis
    >>> boxes = {"o1": [0.0, 0.0], "o2": [0.4, 0.0], "o3": [0.8, 0.0]}
    >>> things = [{"id": id, "min": [x, y], "max": [x + 0.1, y + 0.1]} for id, (x, y) in boxes.items()]
    >>> script = deixis.read_script(text="cup left of jug; mug left of jug")
    >>> found = deixis.ground(script, {"objects": things}, ask={"cup": "o2", "mug": "o1", "jug": "o3"})
    >>> [match.perceived for match in found.matches.values()], len(found.exchanges)
    (['o2', 'o3', 'o1'], 2)
    """
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    described, seen = as_script(script, deadline=deadline), as_scene(scene)
    request = GroundingRequest(
        script=described,
        scene=seen,
        engine=engine,
        select=select,
        literal=literal,
        sizes=sizes,
        viewpoint=viewpoint,
        ask=ask,
        max_questions=max_questions,
        time_limit=time_limit,
        meaning=meaning,
        memory_limit=memory_limit,
        deadline=deadline,
        attributes=attributes,
    )
    return answer(request)


def answer(request: GroundingRequest, stage: Stage = lambda _: nullcontext()) -> Grounding:
    """Answer a request.

    Parameters
    ----------
    request
        Script, scene and settings.
    stage
        Makes, from its name, the context of a stage, such as a progress bar; the dialogue has none.

    Returns
    -------
    Grounding
        The answer, proved or not.

    Raises
    ------
    OutOfTimeError, OutOfMemoryError
        If the limits leave no answer.
    """
    from deixis.workflows.grounding.viewpoint import ground_from_sides, recover_scene

    deadline, contradiction = request.due, _contradiction(request)
    notes = unit_notes(request.scene, request.script.objects, request.script.ontology)
    notes += viewpoint_notes(request.script.viewpoint, request.scene) + _unused_notes(request.script)
    stated = request.scene.from_viewer()
    side = None
    if request.viewpoint != ViewpointName.STATED:
        any_angle = request.viewpoint == ViewpointName.UNKNOWN
        with stage("looking from other sides"):
            side = recover_scene(request.evidence, request.scene, any_angle, deadline.share(0.5))
    if request.ask is not None:
        seen = stated if side is None else side.scene
        found = _answer_with_questions(request, request.ask, seen, deadline.left)
        if side is None:
            found = found.noting(notes)
        else:
            viewpoints = side.viewpoints.viewpoints if side.viewpoints else ()
            found = replace(found.noting(side.notes + side.viewpoint_notes), viewpoints=viewpoints)
    else:
        select = Select(request.select)
        with stage("grounding"):
            if side is None:
                engine = engine_named(request.engine, select)
                found = ground_evidence(request.evidence(stated), engine, deadline, contradiction).noting(notes)
                if request.surface is not None and not found.matches:
                    known = request.evidence(stated, keep_surface_free=False)
                    found = ground_evidence(known, engine, deadline, contradiction).noting(notes)
            else:
                found = ground_from_sides(request.evidence, side, request.engine, select, deadline, contradiction)
    if request.surface is not None:
        name, thing = request.surface
        others = {one: match for one, match in found.matches.items() if match.perceived != thing}
        left = tuple(one for one in found.unmatched_perceived if one.name != thing)
        matches = others | {name: _surface_match(name, thing)}
        found = replace(found, matches=matches, unmatched_perceived=left, surface=name)
    return replace(found, scene=request.scene)


def _surface_match(name: str, thing: str) -> Match:
    """Return the match of the surface; its thing is found by its label or by what stands on it, not by a search."""
    return Match(
        object=name, perceived=thing, score=1.0, similarity=1.0, decided=True, alternatives=(), probability=None
    )


def _unused_notes(script: Script) -> tuple[str, ...]:
    """Return a note about the facts that a text states under a condition, as past or as uncertain."""
    unused = [] if script.reading is None else [fact for fact in script.reading.stated if not fact.asserted]
    if not unused:
        return ()
    listed = [f"{fact.content} ({', '.join(fact.reservations)})" for fact in unused[:MAX_LISTED]]
    more = [f"{len(unused) - MAX_LISTED} more"] if len(unused) > MAX_LISTED else []
    return (f"the text does not assert these facts, which were not used: {'; '.join([*listed, *more])}",)


def _contradiction(request: GroundingRequest) -> tuple[str, ...]:
    """Return the notes about facts that cannot hold together, or about not having checked them."""
    try:
        return conflict_notes(request.conflict)
    except OutOfTimeError:
        return ("the script contradicts itself, so that not all of it can hold",)
    except LimitError:
        return ("whether all facts can hold together was not looked into: they are about too many objects",)


def _answer_with_questions(request: GroundingRequest, ask: Ask, scene: Scene, time_limit: float) -> Grounding:
    """Ground a script in a scene, with questions that distinguish the likeliest groundings."""
    from deixis.reasoning.grounding.questions.inquiry import Inquiry
    from deixis.reasoning.grounding.questions.refinement import Hold, refine
    from deixis.reasoning.grounding.questions.situation import Situation
    from deixis.workflows.grounding.dialogue import closing_lines, dialogue_with, run

    dialogue = dialogue_with(ask)
    limit = math.inf if request.max_questions is None else request.max_questions

    def start(situation: Situation) -> Hold:
        source = dialogue.source(situation)

        def hold(inquiry: Inquiry, most: float) -> Inquiry:
            return run(inquiry, source, dialogue.out, min(most, limit))

        return hold

    evidence = replace(request.evidence(scene), deadline=Deadline.never())  # a person may take long
    refined = refine(evidence, request.implied, start, time_limit)
    print(*closing_lines(refined.inquiry), sep="\n", file=dialogue.out)
    notes = _contradiction(request)
    found = ground_evidence(refined.evidence, engine_named(request.engine), refined.deadline, notes)
    return replace(found, exchanges=refined.inquiry.exchanges)
