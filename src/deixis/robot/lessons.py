"""Lessons of a robot: tables on which a teacher described a layout, what each taught, and what still waits.

A decided match is learned at once. The others wait for an answer, for a person who points, or for what further tables
teach about the layout and its things. They are then learned in hindsight, because a lesson keeps its table.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from deixis.answers import count
from deixis.learning.layouts.tables import TaughtTable
from deixis.ontology.inflection import is_plural
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answers.answer import Grounding

QUESTION_COST = 0.5
"""Cost of a question in nats: it is asked if the expected information of its answer is larger."""

MIN_SETTLED_PROBABILITY = 0.97
"""Minimum probability at which a role that waits is taught in hindsight."""


class SettledBy(StrEnum):
    """Source of the thing of a role."""

    WORDS = "words"  # the grounding decided it
    ANSWER = "answer"  # the teacher answered a question
    POINTING = "pointing"  # the teacher pointed at it
    HINDSIGHT = "hindsight"  # later tables and names decided it


@dataclass(frozen=True, slots=True)
class Settled:
    """Thing of a role, how it came to be known, and how probable it is."""

    thing: str
    by: SettledBy
    probability: float


@dataclass(frozen=True, slots=True)
class Question:
    """A question about a lesson: which thing a role is.

    Attributes
    ----------
    lesson
        Number of the lesson.
    role
        The role.
    among
        Things that it may be, with their probabilities, the most probable first; None is for none of the things.
    gain
        Information that the answer is expected to give, in nats.
    """

    lesson: int
    role: str
    among: tuple[tuple[str | None, float], ...]
    gain: float

    @property
    def text(self) -> str:
        """The question in words."""
        name = self.role.replace("_", " ")
        return f"Which ones are the {name}?" if is_plural(name) else f"Which one is the {name}?"

    @property
    def why(self) -> str:
        """The reason in words."""
        listed = ", ".join(f"{thing or 'none of them'} ({share:.2f})" for thing, share in self.among[:4])
        return (
            f"The words do not say which one it is: {listed}. The answer is worth {self.gain:.1f} nats, "
            f"and a question costs {QUESTION_COST:g}."
        )


@dataclass(frozen=True, eq=False, repr=False)
class TableLesson:
    """A table on which a layout was described.

    Attributes
    ----------
    number
        Number of the lesson.
    layout
        Name of the layout.
    scene
        The table with its clouds.
    settled
        Roles that are known.
    waiting
        For each role that is not, the things that it may be with their probabilities; None is for none of them.
    id
        Id of the lesson in the memory.
    roles
        All roles that were described.
    present
        Roles whose thing the grounding found on the table, whichever it is.
    """

    number: int
    layout: str
    scene: Scene
    settled: Mapping[str, Settled]
    waiting: Mapping[str, Mapping[str | None, float]]
    id: str = ""
    roles: tuple[str, ...] = ()
    present: frozenset[str] = frozenset()

    def __repr__(self) -> str:
        known = count(len(self.settled), "role")
        return f"<TableLesson {self.id} of '{self.layout}': {known} known, {len(self.waiting)} waiting>"

    @classmethod
    def of(cls, number: int, layout: str, scene: Scene, grounding: Grounding, id: str = "") -> TableLesson:
        """Return the lesson that a grounding teaches.

        Parameters
        ----------
        number
            Number of the lesson.
        layout
            Name of the layout.
        scene
            The table.
        grounding
            Grounding of the description in the table.
        id
            Id of the lesson in the memory.

        Returns
        -------
        TableLesson
            Decided matches are settled, the other objects wait.
        """
        settled, waiting = {}, {}
        for role, match in grounding.object_matches.items():
            probability = 1.0 if match.probability is None else match.probability
            if match.decided:
                settled[role] = Settled(match.perceived, SettledBy.WORDS, probability)
            else:
                others = {each.perceived: each.probability or 0.0 for each in match.alternatives}
                waiting[role] = {match.perceived: probability, **others}
        for left in grounding.unmatched_objects:
            waiting[left.name] = {each.perceived: each.probability or 0.0 for each in left.alternatives}
        present = frozenset(grounding.object_matches)
        return cls(number, layout, scene, settled, waiting, id, (*settled, *waiting), present)

    def with_settled(self, role: str, settled: Settled | None) -> TableLesson:
        """Return the lesson with a role that is known.

        Parameters
        ----------
        role
            The role.
        settled
            Its thing; None if it is not on the table, so that it no longer waits.

        Returns
        -------
        TableLesson
            The lesson, in which no other role waits for that thing.
        """
        known = dict(self.settled)
        rest = {name: shares for name, shares in self.waiting.items() if name != role}
        if settled is not None:
            known[role] = settled
            rest = {name: {k: v for k, v in shares.items() if k != settled.thing} for name, shares in rest.items()}
        return replace(self, settled=known, waiting=rest)

    def revised(self, table: TaughtTable | None) -> TableLesson:
        """Return the lesson as it is in the memory after something was taken back.

        Parameters
        ----------
        table
            The table of the lesson in the memory; None if the lesson was taken back.

        Returns
        -------
        TableLesson
            The lesson with the roles that are left. A role whose thing is no longer known waits again.
        """
        if table is None:
            return replace(self, settled={}, waiting={})
        roles = tuple(role.name for role in table.layout.roles)
        settled = {role: Settled(thing, SettledBy.WORDS, 1.0) for role, thing in table.things.items()}
        settled |= {role: known for role, known in self.settled.items() if table.things.get(role) == known.thing}
        waiting: dict[str, Mapping[str | None, float]] = {
            role: {known.thing: known.probability} for role, known in self.settled.items()
        }
        waiting.update(self.waiting)
        waiting = {role: shares for role, shares in waiting.items() if role in roles and role not in settled}
        return replace(self, settled=settled, waiting=waiting, roles=roles, present=table.present)

    def questions(self) -> tuple[Question, ...]:
        """Return the questions about the roles that wait, the most informative first.

        Returns
        -------
        tuple of Question
            One for each role whose answer is not known.
        """
        taken = {settled.thing for settled in self.settled.values()}
        found = []
        for role, shares in self.waiting.items():
            listed = {thing: share for thing, share in shares.items() if thing not in taken and share > 0}
            total = sum(listed.values())
            if total < 1.0:
                # what no listed thing explains: another thing, or none
                listed[None] = listed.get(None, 0.0) + 1.0 - total
            rates = np.array(list(listed.values())) / sum(listed.values())
            gain = float(-(rates * np.log(np.maximum(rates, 1e-12))).sum())
            among = sorted(zip(listed, rates.tolist(), strict=True), key=lambda item: (-item[1], item[0] or ""))
            found.append(Question(self.number, role, tuple(among), gain))
        return tuple(sorted(found, key=lambda question: (-question.gain, question.role)))
