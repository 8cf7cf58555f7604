"""Lay example tables that satisfy a script, or explain why there is no such table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.grammar.script import Script
from deixis.ontology.graph.facts import Fact
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.things.kinds import Kind, Kinds, with_article
from deixis.ontology.things.sizes import SizeRange
from deixis.perception.scene import DEFAULT_VIEWPOINT, PerceivedObject, Scene
from deixis.reasoning.entailment.claim_facts import facts_of_claims, with_facts_of_claims
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.entailment.realisation.demands import is_firm
from deixis.reasoning.entailment.realisation.picture import Impossible, Picture, Undecided, realise
from deixis.reasoning.errors import SettingError, require_time_limit
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.answers.claims import ClaimOutcome, ClaimVerdict
from deixis.workflows.layouts.arrange import Arrangement, arrange
from deixis.workflows.layouts.read import as_script

TIME_LIMIT = 30.0
MAX_ATTEMPTS = 5
"""Maximum number of attempts to find a table that differs from those before."""


@dataclass(frozen=True, slots=True)
class Sized:
    """An object of a script, the kind it is taken for (None: not known), and how large such things usually are."""

    name: str
    kind: Kind | None
    size: SizeRange

    def __str__(self) -> str:
        return f"{self.name}, {'of unknown kind' if self.kind is None else with_article(self.kind.label)}: {self.size}"


@dataclass(frozen=True, slots=True)
class Waived:
    """A fact that need not hold and does not, and what excludes it: facts, and things of their usual sizes."""

    fact: Fact
    because: tuple[Fact, ...]
    sizes: tuple[Sized, ...]


@dataclass(frozen=True)
class ImaginedTable:
    """An example table. ``holds`` are the facts that it satisfies; ``overlapping`` are pairs of names.

    ``not_shown`` are facts of graded words such as *near* that no place was found for; ``claims`` are outcomes of the
    script's claims.
    """

    scene: Scene
    objects: tuple[Sized, ...]
    holds: tuple[Fact, ...]
    waived: tuple[Waived, ...]
    overlapping: tuple[tuple[str, str], ...]
    named_otherwise: tuple[Fact, ...]
    not_shown: tuple[Fact, ...]
    finished: bool
    claims: tuple[ClaimOutcome, ...] = ()


@dataclass(frozen=True)
class NoTable:
    """Firm facts that no table satisfies; with ``sizes``, none on which these things have their usual sizes.

    ``minimal`` is True if there is such a table without any one of them. ``reason`` is the reason in words if they are
    few.
    """

    facts: tuple[Fact, ...]
    sizes: tuple[Sized, ...]
    minimal: bool
    reason: str | None = None


@dataclass(frozen=True, repr=False)
class Imagination(Answer):
    """Example tables of a script, or why it has no table; neither where the time limit was reached before.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.imagine(deixis.read_script(text="fork left of plate; cup right of plate"), seed=1)
    >>> found
    <Imagination of <text>: 1 example table>
    >>> [table.scene.ids for table in found.tables]
    [('o1', 'o2', 'o3')]
    >>> found.decided
    True
    """

    script: Script
    tables: tuple[ImaginedTable, ...] = ()
    none: NoTable | None = None

    def summary(self) -> str:
        """Return the number of tables, or the verdict without one."""
        if self.tables:
            return f"of {self.script.file}: {count(len(self.tables), 'example table')}"
        return f"of {self.script.file}: {'no table satisfies it' if self.none else 'undecided within the time limit'}"

    @property
    def decided(self) -> bool:
        """True if a table was found, or proved impossible."""
        return bool(self.tables) or self.none is not None


@checks_arguments
def imagine(
    script: Script | str | Path,
    *,
    any_size: bool = False,
    seed: int = 0,
    count: int = 1,
    time_limit: float = TIME_LIMIT,
) -> Imagination:
    """Lay example tables that satisfy every firm fact of a script in its stated reading, and the others where possible.

    The first table of seed 0 is the plain one, with typical sizes; all others are drawn.

    Parameters
    ----------
    script
        The script, or its file.
    any_size
        True to allow whatever sizes it takes, not only those usual for the kinds.
    seed
        Seed of the random numbers.
    count
        Number of tables.
    time_limit
        Seconds for each table.

    Returns
    -------
    Imagination
        The tables with the facts that each gives up, or the minimal set of facts and sizes that allows no table.

    Raises
    ------
    SettingError
        If a setting is out of range.

    Examples
    --------
    >>> from deixis.grammar.layout.parser import parse_script
    >>> found = imagine(parse_script("fork left of plate; knife right of plate"))
    >>> [thing.label for thing in found.tables[0].scene.objects]
    ['fork', 'plate', 'knife']
    >>> str(imagine("examples/formal_dinner.layout"))
    'Imagination of examples/formal_dinner.layout: 1 example table'
    >>> str(imagine(parse_script("dinner_plate on teaspoon")).none.sizes[1])
    'teaspoon, a teaspoon: 11 to 16 cm long and 2.2 to 3.6 cm wide'
    """
    for name, value, least in (("count", count, 1), ("seed", seed, 0)):
        if value < least:
            raise SettingError(f"`{name}` must be a whole number of at least {least}, got {value}")
    require_time_limit(time_limit)
    read = as_script(script, deadline=Deadline.after(time_limit))
    graph = _with_claims(read).affirming()
    objects = sized_objects(read, graph)
    tables: list[ImaginedTable] = []
    for found in _pictures(graph, objects, any_size, seed, count, time_limit, read.ontology.kinds):
        if isinstance(found, Impossible):
            return Imagination(read, none=_no_table(graph, objects, found))
        if isinstance(found, Picture):
            tables.append(_table(read, graph, objects, found, np.random.default_rng([seed, len(tables)]), time_limit))
    return Imagination(read, tuple(tables))


def _pictures(
    graph: RelationGraph,
    objects: Sequence[Sized],
    any_size: bool,
    seed: int,
    count: int,
    time_limit: float,
    kinds: Kinds,
) -> Iterator[Picture | Impossible | Undecided]:
    """Yield different pictures, at most ``count``, or the reason why there is no further one."""
    sizes, lying = [thing.size for thing in objects], lying_across(graph, objects, kinds)
    seen: set[bytes] = set()
    for number in range(count):
        for attempt in range(MAX_ATTEMPTS):
            plain = seed == number == attempt == 0
            rng = None if plain else np.random.default_rng([seed, number, attempt])
            found = realise(graph, sizes, lying=lying, any_size=any_size, deadline=Deadline.after(time_limit), rng=rng)
            if not isinstance(found, Picture):
                yield found
                return
            if found.boxes.tobytes() not in seen:
                seen.add(found.boxes.tobytes())
                yield found
                break


def sized_objects(script: Script, graph: RelationGraph) -> tuple[Sized, ...]:
    """Return every object with its kind, declared or said by its name, and its usual size.

    Parameters
    ----------
    script
        The script.
    graph
        Its relation graph.

    Returns
    -------
    tuple of Sized
        Objects in the order of the graph, each with the kind that is declared or that its name says.
    """
    kinds = script.ontology.kinds
    found = [kinds[iri] if iri else None for iri in graph.kinds or (None,) * len(graph.nodes)]
    sizes = [script.ontology.sizes.of(kind.iri if kind else None) for kind in found]
    return tuple(Sized(*entry) for entry in zip(graph.nodes, found, sizes, strict=True))


LONG_SIDE_TO_VIEWER = ("device", "appliance", "furniture")
"""Kinds whose long side faces the viewer, as a keyboard, a microwave or a sofa stands."""

LEAST_WIDE = 0.25
"""Minimum typical length in metres at which such a thing lies across; a telephone or a computer mouse points away."""


def lying_across(graph: RelationGraph, objects: Sequence[Sized], kinds: Kinds) -> list[bool]:
    """Return which things rather lie across than point away from the viewer.

    These are cutlery that is said to lie above something, as for dessert, and larger devices, appliances and furniture.

    Parameters
    ----------
    graph
        The relation graph of the script.
    objects
        Its objects with their kinds.
    kinds
        The known kinds.

    Returns
    -------
    list of bool
        True for each object that lies across.
    """
    cutlery, wide = kinds.of_word("cutlery"), [kinds.of_word(word) for word in LONG_SIDE_TO_VIEWER]
    above = {fact.subject for fact in graph.facts() if fact.plain and fact.relations[0].word == "top"}

    def lies(thing: Sized) -> bool:
        if thing.kind is None:
            return False
        if cutlery is not None and kinds.is_a(thing.kind, cutlery):
            return thing.name in above
        faces = any(kind is not None and kinds.is_a(thing.kind, kind) for kind in wide)
        return faces and thing.size.length.typical >= LEAST_WIDE

    return [lies(thing) for thing in objects]


def _with_claims(script: Script) -> RelationGraph:
    """Return the graph of a script, with the facts that its claims imply after the stated ones."""
    graph = script.graph()
    found = facts_of_claims(script.claims, graph.nodes, graph.vocabulary)
    found = tuple(entry for entry in found if not entry.fact.relations[0].by_model)
    return with_facts_of_claims(graph, found) if found else graph


def _table(
    script: Script,
    graph: RelationGraph,
    objects: tuple[Sized, ...],
    picture: Picture,
    rng: np.random.Generator,
    time_limit: float,
) -> ImaginedTable:
    stated = range(len(script.facts))
    given_up = {entry.edge for entry in picture.given_up}
    graded = {edge for edge in range(len(graph)) if any(r.by_model for r in graph.fact(edge).relations)} - given_up
    claims: tuple[ClaimOutcome, ...] = ()
    if graded or script.claims:
        kept = tuple(edge for edge in range(len(graph)) if edge not in given_up | graded)
        task = Arrangement(graph, script.claims, kept, tuple(sorted(graded)))
        if task.firm(picture.boxes):
            arranged = arrange(task, picture.boxes, rng, Deadline.after(time_limit))
            picture = replace(picture, boxes=arranged)
        upper = {graph.nodes[pair[0]] for pair in task.together}
        claims = tuple(_on_table(entry, upper) for entry in task.outcomes(picture.boxes))
    things = tuple(
        PerceivedObject(f"o{number}", tuple(box[0]), tuple(box[1]), label=name)
        for number, (name, box) in enumerate(zip(graph.nodes, picture.boxes.tolist(), strict=True), start=1)
    )
    not_shown = _not_shown(graph, picture.boxes) - given_up
    return ImaginedTable(
        scene=Scene(things, viewpoint=script.viewpoint or DEFAULT_VIEWPOINT),
        objects=objects,
        holds=tuple(graph.fact(edge) for edge in stated if edge not in given_up | not_shown),
        waived=tuple(
            Waived(
                fact=graph.fact(entry.edge),
                because=tuple(graph.fact(edge) for edge in entry.because),
                sizes=tuple(objects[i] for i in entry.sizes),
            )
            for entry in picture.given_up
            if entry.edge in stated
        ),
        overlapping=tuple((graph.nodes[a], graph.nodes[b]) for a, b in picture.overlapping),
        named_otherwise=tuple(graph.fact(edge) for edge in picture.named_otherwise if edge in stated),
        not_shown=tuple(graph.fact(edge) for edge in sorted(not_shown) if edge in stated),
        finished=picture.finished,
        claims=claims,
    )


def _on_table(entry: ClaimOutcome, upper: set[str]) -> ClaimOutcome:
    """Return a claim that something stands on the surface as satisfied, except of what lies on or in another thing.

    The table that is imagined is the surface, and a plan has no heights to measure.
    """
    claim = entry.claim
    on_surface = claim.relation == "on" and not claim.arguments and claim.positive
    if not on_surface or upper & set(claim.subjects):
        return entry
    return replace(entry, verdict=ClaimVerdict.SATISFIED, degree=1.0, measured="it stands on the table")


def _not_shown(graph: RelationGraph, boxes: NDArray[np.float64]) -> set[int]:
    """Return the edges of graded words that the model of the word denies of the boxes (n, 2, 2)."""
    from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence

    if not any(relation.by_model for fact in graph.facts() for relation in fact.relations):
        return set()
    evidence = no_unary_evidence(graph, scene_relations(graph.nodes, boxes, graph.vocabulary))
    degrees = evidence.degrees(np.arange(len(graph.nodes)))
    return {int(evidence.facts[place]) for place in evidence.modelled if degrees[place] == 0.0}


def _no_table(graph: RelationGraph, objects: tuple[Sized, ...], found: Impossible) -> NoTable:
    """Return why there is no table; a contradiction in the words of inference where it sees one that is as small."""
    facts = tuple(graph.fact(edge) for edge in found.edges)
    if found.sizes:
        return NoTable(facts, tuple(objects[i] for i in found.sizes), found.minimal)
    conflict = find_conflict(Implications(graph))
    if conflict is not None and len(conflict.facts) <= len(facts) and all(map(is_firm, conflict.facts)):
        return NoTable(conflict.facts, (), found.minimal, conflict.reason)
    return NoTable(facts, (), found.minimal)
