"""Explain a table by what was learned: its layout, the name of each thing, and the mistakes.

The appearance of the things (recognition, sizes) and the layouts have one posterior: each layout explains the table
with as few mistakes as it can (:mod:`deixis.reasoning.comparison.explanation`). The probability of a layout is that of
all its explanations together, and the name of a thing is that of its role, averaged over all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis import answers
from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.learning.layouts.experience import Experience
from deixis.learning.views.views import Known, recognise
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.kinds import plain_name
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.comparison.explanation import NOTHING, Explanation, MistakeKind, explain
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.robot.layouts import LearnedLayout

MIN_EXPLANATION_RATIO = -2.0
"""Log-likelihood ratio, per thing, that an explanation by a layout must exceed for the layout to be there at all."""


MAX_SHOWN_PROBABILITY = 0.99
"""Maximum probability of a name that a person gave to a thing of the table that is looked at."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A mistake on a table.

    Attributes
    ----------
    kind
        Kind of the mistake.
    names
        Names of the roles that it is about; of an extra thing what it seems to be, or nothing.
    things
        Ids of the things that it is about; none for a missing thing.
    """

    kind: MistakeKind
    names: tuple[str, ...]
    things: tuple[str, ...]

    def __str__(self) -> str:
        names = " and ".join(name.replace("_", " ") for name in self.names) or "an unknown thing"
        sentences = {
            MistakeKind.MISSING: f"the {names} is missing",
            MistakeKind.EXTRA: f"{names} does not belong here",
            MistakeKind.DISPLACED: f"the {names} is in the wrong place",
            MistakeKind.TURNED: f"the {names} is turned",
            MistakeKind.SWAPPED: f"the {names} have changed places",
        }
        return sentences[self.kind]


@dataclass(frozen=True, eq=False, repr=False)
class Look(Answer):
    """Explanation of a table: its layouts, the names of its things, and the mistakes.

    Attributes
    ----------
    scene
        The things, with the names that recognition gives them.
    layouts
        Probability of each known layout, the most probable first; what is left is that of no known layout.
    explanations
        Explanation of the table by each layout.

    Examples
    --------
    >>> import tempfile
    >>> import deixis
    >>> low, high = [[0, 0, 0], [0.1, 0, 0], [0.4, 0, 0]], [[0.03, 0.2, 0.02], [0.35, 0.25, 0.02], [0.43, 0.2, 0.02]]
    >>> with tempfile.TemporaryDirectory() as folder, deixis.Robot(folder + "/memory") as robot:
    ...     scene = robot.sees(deixis.Scene.from_boxes(low, high))
    ...     told = robot.told("layout supper; fork left of plate; knife right of plate")
    ...     look = robot.look()
    >>> look.layout, look.name("o1"), list(look.names["o2"]), look.faults()
    ('supper', 'fork', ['plate'], ())
    >>> look.places()
    {}
    """

    scene: Scene
    layouts: Mapping[str, float]
    explanations: Mapping[str, tuple[LearnedLayout, Explanation]]

    def summary(self) -> str:
        """Return the layout, and the numbers of things with names and of mistakes."""
        layout = "no known layout" if self.layout is None else f"'{self.layout}' {self.layouts[self.layout]:.2f}"
        named = sum(self.name(thing) is not None for thing in self.names)
        mistakes = f", {count(len(self.faults()), 'mistake')}" if self.layout is not None else ""
        return f"{layout}: {answers.share(named, len(self.names), 'thing')} named{mistakes}" if self.names else layout

    @property
    def layout(self) -> str | None:
        """Name of the layout of the table; None if probably no known layout explains it."""
        best = next(iter(self.layouts.items()), None)
        return best[0] if best is not None and best[1] >= 0.5 else None

    @cached_property
    def names(self) -> dict[str, dict[str, float]]:
        """Names that each thing may have with their probabilities, the most probable first, by id of the thing."""
        found: dict[str, dict[str, float]] = {}
        for place, thing in enumerate(self.scene.objects):
            shares: dict[str, float] = {}
            free = 1.0
            for name, share in self.layouts.items():
                layout, explanation = self.explanations[name]
                for role, probability in zip(layout.roles, explanation.roles_of[:, place].tolist(), strict=True):
                    if probability > 0:
                        shares[plain_name(role)] = shares.get(plain_name(role), 0.0) + share * probability
                        free -= share * probability
            for candidate, probability in thing.candidates:
                shares[candidate] = shares.get(candidate, 0.0) + max(free, 0.0) * probability
            found[thing.id] = dict(sorted(shares.items(), key=lambda item: (-item[1], item[0])))
        return found

    @checks_arguments
    def name(self, thing: str) -> str | None:
        """Return the name of a thing.

        Parameters
        ----------
        thing
            Id of the thing.

        Returns
        -------
        str or None
            The most probable name; None if it is more probably none of the known ones.
        """
        shares = self.names[self.scene[thing].id]
        best = next(iter(shares.items()), None)
        return best[0] if best is not None and best[1] >= 1.0 - sum(shares.values()) else None

    @checks_arguments
    def faults(self, layout: str | None = None) -> tuple[Fault, ...]:
        """Return what is wrong with the table.

        Parameters
        ----------
        layout
            Name of the layout to compare with; None for the one that lies here.

        Returns
        -------
        tuple of Fault
            The mistakes of the most probable explanation; nothing if no layout lies here.
        """
        wanted = layout or self.layout
        if wanted is None:
            return ()
        if wanted not in self.explanations:
            known_names = ", ".join(self.explanations) or "none"
            raise SettingError(f"`layout` must be a layout that was looked for, got {wanted!r}; it has: {known_names}")
        known, explanation = self.explanations[wanted]
        found = []
        for mistake in explanation.mistakes:
            things = tuple(self.scene.ids[thing] for thing in mistake.things)
            names = tuple(known.roles[role] for role in mistake.roles)
            if mistake.kind is MistakeKind.EXTRA:
                name = self.name(things[0])
                names = (name,) if name is not None else ()
            found.append(Fault(mistake.kind, names, things))
        return tuple(found)

    def places(self) -> dict[str, NDArray[np.float64]]:
        """Estimate where the missing, displaced and swapped things of the table belong, seen from above.

        Swapped things belong in each other's places. Any other thing keeps the mean offsets to the things in place that
        were seen on the tables of the layout; the place is the median over them.

        Returns
        -------
        dict
            A box of shape (2, 2), minimum and maximum corner in metres, for each role whose place is known. A missing
            thing has the mean size that was seen.
        """
        if self.layout is None:
            return {}
        layout, explanation = self.explanations[self.layout]
        boxes = self.scene.boxes[:, :, :2]
        centres = boxes.mean(axis=1)
        places: dict[str, NDArray[np.float64]] = {}
        wrong: dict[str, int | None] = {}
        for mistake in explanation.mistakes:
            if mistake.kind is MistakeKind.SWAPPED:
                for place, own, other in zip(mistake.roles, mistake.things, mistake.things[::-1], strict=True):
                    places[layout.roles[place]] = boxes[own] - centres[own] + centres[other]
            elif mistake.kind in (MistakeKind.MISSING, MistakeKind.DISPLACED):
                wrong[layout.roles[mistake.roles[0]]] = mistake.things[0] if mistake.things else None
        in_place = {
            role: centres[thing]
            for role, thing in zip(layout.roles, explanation.thing.tolist(), strict=True)
            if thing != NOTHING and role not in wrong and role not in places
        }
        for role, thing in wrong.items():
            size = layout.experience.size(role) if thing is None else boxes[thing, 1] - boxes[thing, 0]
            offsets = ((other, layout.experience.offset(other, role)) for other in in_place)
            known = [in_place[other] + offset for other, offset in offsets if offset is not None]
            if size is not None and known:
                centre = np.median(known, axis=0)
                places[role] = np.stack([centre - size / 2, centre + size / 2])
        return places


@dataclass(frozen=True, eq=False, repr=False)
class TableKnowledge:
    """Learned knowledge that the explanation of a table needs, without an open store.

    Attributes
    ----------
    known
        Recogniser of the taught categories.
    layouts
        Learned layouts.
    meaning
        Words and sizes.
    ontology
        Known kinds and relations.
    """

    known: Known
    layouts: tuple[LearnedLayout, ...]
    meaning: Meaning
    ontology: Ontology

    def __repr__(self) -> str:
        categories = count(len(self.known.recogniser.parts[0].categories), "category")
        return f"<TableKnowledge {count(len(self.layouts), 'layout')}, {categories}>"

    def portable(self) -> tuple[Known, tuple[tuple[str, str, Experience], ...], Meaning]:
        """Return the knowledge as values for another process, which has the shipped ontology.

        Returns
        -------
        tuple
            The recogniser; name, text and experience of each layout; words and sizes.
        """
        from deixis.grammar.layout.format import format_script

        layouts = tuple((one.name, format_script(one.script), one.experience) for one in self.layouts)
        return self.known, layouts, self.meaning

    @classmethod
    def from_portable(cls, values: tuple[Known, tuple[tuple[str, str, Experience], ...], Meaning]) -> TableKnowledge:
        """Return the knowledge from its portable form.

        Parameters
        ----------
        values
            Result of :meth:`portable`.

        Returns
        -------
        TableKnowledge
            The knowledge with the shipped ontology.
        """
        from deixis.grammar.layout.parser import parse_script
        from deixis.ontology.tbox import default_ontology

        known, layouts, meaning = values
        learned = tuple(LearnedLayout(name, parse_script(text), seen) for name, text, seen in layouts)
        return cls(known, learned, meaning, default_ontology())

    def recognised(self, scene: Scene) -> Scene:
        """Return a scene with the names that recognition gives its things.

        Parameters
        ----------
        scene
            The scene with clouds.

        Returns
        -------
        Scene
            The scene with labels and candidates.
        """
        clouds: list[PointCloud | None] = [
            scene.cloud_of(thing.id) if thing.cloud is not None else None for thing in scene.objects
        ]
        if not self.known.recogniser.parts[0].categories:
            return scene
        return recognise(self.known, scene, clouds).scene

    def look(self, scene: Scene, shown: Mapping[str, tuple[str, float]] | None = None) -> Look:
        """Explain a table.

        Parameters
        ----------
        scene
            The scene with clouds.
        shown
            Names that persons gave to things of the scene, and their certainties, by id.

        Returns
        -------
        Look
            The layouts, names and mistakes.
        """
        seen = _with_names(self.recognised(scene), shown or {})
        found = {}
        for layout in self.layouts:
            if scene.objects:
                evidence = layout.evidence(seen, self.ontology, self.meaning)
                found[layout.name] = (layout, explain(evidence))
        values = np.array([explanation.evidence for _, explanation in found.values()])
        # A table of things that no layout mentions has one extra thing after another.
        threshold = MIN_EXPLANATION_RATIO * len(seen.objects)
        total = np.logaddexp.reduce(np.append(values, threshold))
        shares = dict(zip(found, np.exp(values - total).tolist(), strict=True))
        ordered = dict(sorted(shares.items(), key=lambda item: (-item[1], item[0])))
        return Look(replace(seen), ordered, found)


def _with_names(scene: Scene, shown: Mapping[str, tuple[str, float]]) -> Scene:
    """Return a scene in which things have the names that persons gave them; what they look like has the rest."""

    def named(thing: PerceivedObject) -> PerceivedObject:
        if thing.id not in shown:
            return thing
        name, certainty = shown[thing.id][0], min(shown[thing.id][1], MAX_SHOWN_PROBABILITY)
        others = [(other, (1 - certainty) * share) for other, share in thing.candidates if other != name]
        return replace(thing, label=name, confidence=certainty, candidates=((name, certainty), *others))

    return replace(scene, objects=tuple(map(named, scene.objects)))
