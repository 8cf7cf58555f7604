"""Tables whose layout has no name: the robot notices when they come up again, and asks a person for the name.

The first table of a kind is described by the relations that hold on it. A later table is of that kind if this
description explains it, as a known layout would (:mod:`deixis.reasoning.comparison.explanation`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from deixis.grammar.layout.format import layout_script
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.script import Script
from deixis.learning.layouts.experience import COMPARED, TOLERANCE, Experience
from deixis.ontology.graph.facts import Fact
from deixis.ontology.lessons.types import LayoutConcept, Role
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.explanation import NOTHING, explain
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.robot.layouts import LearnedLayout
from deixis.view_store import UNKNOWN

MIN_THINGS = 3
"""Minimum number of things at which an arrangement says something."""

MIN_TABLES = 3
"""Minimum number of tables of one kind at which its name is asked for."""

SAME_PLACE = 0.01
"""Distance in metres up to which a thing is where it was."""

MIN_EXPLANATION_RATIO = -2.0
"""Log-likelihood ratio per thing that an explanation must exceed for a table to be of a kind."""

MIN_NAME_PROBABILITY = 0.5
"""Minimum probability at which a recognised name names a role."""


@dataclass(frozen=True, eq=False)
class LayoutQuestion:
    """A question about tables of one kind: the name of their layout.

    Attributes
    ----------
    kind
        The tables that are alike.
    """

    kind: UnnamedKind

    @property
    def text(self) -> str:
        """The question in words."""
        return f"I have seen {len(self.kind.tables)} tables like this; what is it called?"

    @property
    def why(self) -> str:
        """The reason in words."""
        things = ", ".join(role.replace("_", " ") for role in self.kind.layout.roles)
        return f"No layout that I know explains them, and each has the same places: {things}."


@dataclass(frozen=True, eq=False)
class UnnamedTable:
    """A table of a kind, the thing of each role on it, and the id under which the blackboard keeps it, if it does."""

    scene: Scene
    things: Mapping[str, str]
    kept: str | None = None

    @property
    def labelled(self) -> Scene:
        """The table with its roles as labels, and without clouds, so that it teaches places but no looks."""
        roles = {thing: role for role, thing in self.things.items()}
        objects = [
            replace(thing, label=roles.get(thing.id), confidence=1.0, candidates=(), cloud=None)
            for thing in self.scene.objects
        ]
        return replace(self.scene, objects=tuple(objects))


@dataclass(frozen=True, eq=False)
class UnnamedKind:
    """Tables that are alike.

    Attributes
    ----------
    layout
        Description of the first one, with the counts of all.
    tables
        The tables.
    asked
        True if a person was asked for the name and gave none.
    """

    layout: LearnedLayout
    tables: tuple[UnnamedTable, ...]
    asked: bool = False

    @classmethod
    def of(cls, scene: Scene, ontology: Ontology) -> UnnamedKind:
        """Return the kind of a first table.

        Parameters
        ----------
        scene
            The table, with recognised names.
        ontology
            Words of the language.

        Returns
        -------
        UnnamedKind
            The kind, whose roles have the recognised names, or are numbered things.
        """
        roles = _roles(scene)
        things = dict(zip(roles, scene.ids, strict=True))
        layout = LearnedLayout("unnamed", _description(scene, roles, "unnamed", ontology))
        seen = Experience.of_table(roles, {role: scene[thing] for role, thing in things.items()}, ontology.relations)
        return cls(layout.with_table(layout.script, seen), (UnnamedTable(scene, things),))

    def with_table(self, scene: Scene, ontology: Ontology, meaning: Meaning) -> UnnamedKind | None:
        """Return the kind with one more table, if that is of this kind.

        Parameters
        ----------
        scene
            The table, with recognised names.
        ontology
            Words of the language.
        meaning
            Words and sizes.

        Returns
        -------
        UnnamedKind or None
            None if the description does not explain the table, or half of its things are missing or elsewhere.
        """
        found = explain(self.layout.evidence(scene, ontology, meaning))
        roles = self.layout.roles
        if found.evidence <= MIN_EXPLANATION_RATIO * len(scene.objects) or 2 * len(found.mistakes) >= len(roles):
            return None
        things = {
            role: scene.ids[thing] for role, thing in zip(roles, found.thing.tolist(), strict=True) if thing != NOTHING
        }
        seen = Experience.of_table(roles, {role: scene[thing] for role, thing in things.items()}, ontology.relations)
        layout = self.layout.with_table(self.layout.script, seen)
        return replace(self, layout=layout, tables=(*self.tables, UnnamedTable(scene, things)))

    def with_kept(self, id: str) -> UnnamedKind:
        """Return the kind with the id under which the blackboard keeps its last table.

        Parameters
        ----------
        id
            The id.

        Returns
        -------
        UnnamedKind
            The kind.
        """
        return replace(self, tables=(*self.tables[:-1], replace(self.tables[-1], kept=id)))

    def script(self, name: str, ontology: Ontology) -> Script:
        """Return the description of the kind under a name: what held on every table.

        Parameters
        ----------
        name
            Name of the layout.
        ontology
            Words of the language.

        Returns
        -------
        Script
            The script.
        """
        held = self.layout.experience.held
        facts = []
        for fact in self.layout.graph.facts():
            tally = held[fact.relations[0].name, fact.subject, fact.object]
            if tally.held == tally.of:
                facts.append(fact)
        return _script(name, self.layout.roles, facts, ontology)


def place_among(
    kinds: Sequence[UnnamedKind], scene: Scene, ontology: Ontology, meaning: Meaning
) -> tuple[int, UnnamedKind]:
    """Return the kind of a table, with the table added, and its index among the known kinds; their number if new.

    Parameters
    ----------
    kinds
        The known kinds.
    scene
        The table, with recognised names.
    ontology
        Words of the language.
    meaning
        Words and sizes.

    Returns
    -------
    place : int
        Place of the kind.
    kind : UnnamedKind
        The kind, whose last table is this one.
    """
    for place, kind in enumerate(kinds):
        more = kind.with_table(scene, ontology, meaning)
        if more is not None:
            return place, more
    return len(kinds), UnnamedKind.of(scene, ontology)


def is_same_table(first: Scene, second: Scene) -> bool:
    """Return whether two scenes show one table, which may be laid or cleared meanwhile.

    Parameters
    ----------
    first, second
        The scenes.

    Returns
    -------
    bool
        True if more than half of the things of the scene with fewer things lie where things of the other one lie.
    """
    smaller, larger = sorted((first, second), key=lambda scene: len(scene.objects))
    if not smaller.objects:
        return True
    distances = np.linalg.norm(smaller.boxes.mean(axis=1)[:, None] - larger.boxes.mean(axis=1)[None], axis=2)
    return bool(2 * np.count_nonzero(distances.min(axis=1) < SAME_PLACE) > len(smaller.objects))


def _roles(scene: Scene) -> list[str]:
    """Return a name for each thing: what it was recognised as, or ``thing``, numbered where several have one."""
    names = []
    for thing in scene.objects:
        best = next(iter(thing.candidates), (thing.label, thing.confidence))
        known = best[0] is not None and best[0] != UNKNOWN and best[1] >= MIN_NAME_PROBABILITY
        names.append(best[0] if known and best[0] else "thing")
    often, done, found = Counter(names), Counter[str](), []
    for name in names:
        done[name] += 1
        found.append(f"{name}_{done[name]}" if often[name] > 1 or name == "thing" else name)
    return found


def _description(scene: Scene, roles: list[str], name: str, ontology: Ontology) -> Script:
    """Return the relations of a table that do not follow from each other by order alone."""
    relations = ontology.relations
    exact = box_relations(scene.boxes, relations, TOLERANCE).names
    facts = []
    for word in COMPARED:
        relation = relations[word]
        holds = relations.degrees[relation.index][exact] > 0
        np.fill_diagonal(holds, False)
        direct = holds & ~((holds[:, :, None] & holds[None]).any(axis=1))
        facts += [Fact(roles[a], (relation,), roles[b]) for a, b in np.argwhere(direct).tolist()]
    return _script(name, roles, facts, ontology)


def _script(name: str, roles: tuple[str, ...] | list[str], facts: list[Fact], ontology: Ontology) -> Script:
    concept = LayoutConcept(name, name, None, None, tuple(Role(role) for role in roles), tuple(facts))
    return parse_script(layout_script(concept, ontology), ontology=ontology)
