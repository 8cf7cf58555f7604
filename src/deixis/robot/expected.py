"""Objects that are expected because a person said that they are there, until they are seen or found to be missing.

A sentence such as *there is a red ball on the left* is about what is present, not about a layout. Each look at the
table grounds it by the engine that grounds layouts: a thing that fits becomes the object. Otherwise, the probability
that the object is there falls with each look at its place, as far as that place is in view
(:mod:`deixis.robot.places`; Bayesian search: L. D. Stone, *Theory of Optimal Search*, 1975).

Objects that a description puts into the same representation as perceived ones are those of N. Mavridis and D. Roy,
"Grounded situation models for robots: where words and percepts meet", IROS 2006.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from deixis.grammar.script import Script
from deixis.ontology.graph.claims import PLACES, SUPERLATIVES
from deixis.ontology.things.kinds import plain_name

PRIOR_PRESENT = 0.95
"""Probability that an object is there when a person says so."""

MIN_MATCH_PROBABILITY = 0.9
"""Minimum probability at which a thing is taken for the expected object."""

DETECTION_PROBABILITY = 0.7
"""Probability that one look detects a thing whose place is in view."""

LOOK_INTERVAL = 1.0
"""Time in seconds between two looks that count as independent."""

MIN_PRESENT_PROBABILITY = 0.05
"""Probability below which an object is no longer expected."""

MIN_SHARE_IN_VIEW = 0.8
"""Minimum share of the place of an object at which all of it counts as in view."""

DESCRIBED = PLACES | frozenset(
    (
        "colour",
        "size",
        "shape",
        "material",
        "state",
        "other",
        "near",
        "on",
        "between",
        "around",
        "distance",
        *SUPERLATIVES,
    )
)
"""Claims about an object that are written to the blackboard one by one; the words have the others too."""

_INTRODUCED = frozenset(["a", "an", "another", "one", "some", "two", "three", "four", "five", "six", "seven", "eight"])
"""First words of phrases that introduce an object."""


class Standing(StrEnum):
    """Standing of an expected object."""

    EXPECTED = "expected"
    SEEN = "seen"
    CONTRADICTED = "contradicted"


@dataclass(frozen=True, slots=True)
class Sighting:
    """One look for an expected object.

    Attributes
    ----------
    thing
        Id on the blackboard of the thing that fits best; None if none may be the object.
    probability
        Probability of that thing by the grounding of the sentence.
    fits_place
        True if the thing lies where the object was said to be.
    in_view
        Share of the place of the object that is in view, in [0, 1].
    """

    thing: str | None
    probability: float
    fits_place: bool
    in_view: float


@dataclass(frozen=True, eq=False)
class ExpectedObject:
    """An object that a person said is there.

    Attributes
    ----------
    id
        Id on the blackboard, which no other thing ever has.
    role
        Name of the object in the script.
    script
        Facts and claims of the sentence.
    text
        Words that were said.
    by
        Name of the person.
    event
        Id of the sentence.
    since
        Time in seconds when it was said.
    probability
        Probability that the object is there; for one that was seen, that the thing is the object.
    standing
        Whether the object is still expected, was seen, or is contradicted.
    thing
        Id on the blackboard of the thing that it turned out to be.
    reason
        Reason of a contradiction in words.
    looked
        Time of the last look that counted; None before the first.
    first_look
        Time of the first look.
    looks
        Number of looks without the object.
    in_view
        Largest share of its place that was in view.
    """

    id: str
    role: str
    script: Script
    text: str
    by: str
    event: str
    since: float
    probability: float = PRIOR_PRESENT
    standing: Standing = Standing.EXPECTED
    thing: str | None = None
    reason: str | None = None
    looked: float | None = None
    first_look: float | None = None
    looks: int = 0
    in_view: float = 0.0

    @property
    def name(self) -> str:
        """Name of its kind."""
        return plain_name(self.role)

    @property
    def properties(self) -> tuple[tuple[str, str | None], ...]:
        """Places and properties that were said about it: names of relations and claims, with another object or a word.

        What was denied or hedged is left out.
        """
        found: dict[tuple[str, str | None], None] = {}
        for fact in self.script.facts:
            if fact.subject == self.role and fact.positive and fact.weight >= 1 and len(fact.relations) == 1:
                found[fact.relations[0].name, fact.object] = None
        for claim in self.script.claims:
            if claim.subjects == (self.role,) and claim.relation in DESCRIBED and claim.positive and claim.weight >= 1:
                words = " ".join((claim.value or "", *claim.arguments)).strip() or None
                found[claim.relation, words] = None
        return tuple(found)

    def after(self, sighting: Sighting, at: float, looks: int = 1) -> ExpectedObject:
        """Return the object after looks at the table.

        Parameters
        ----------
        sighting
            What was seen.
        at
            Time of the last look in seconds.
        looks
            Number of independent looks with the same result.

        Returns
        -------
        ExpectedObject
            The object, seen if a thing fits, contradicted if its place was empty for long enough.
        """
        if sighting.thing is not None and sighting.probability >= MIN_MATCH_PROBABILITY and sighting.fits_place:
            return replace(
                self, standing=Standing.SEEN, thing=sighting.thing, probability=min(sighting.probability, 1.0)
            )
        if looks < 1:
            return self
        in_view = max(self.in_view, 1.0 if sighting.in_view >= MIN_SHARE_IN_VIEW else sighting.in_view)
        count = self.looks + looks
        missed = 1.0 - in_view + in_view * (1.0 - DETECTION_PROBABILITY) ** count  # what is hidden stays possible
        left = PRIOR_PRESENT * missed / (PRIOR_PRESENT * missed + 1.0 - PRIOR_PRESENT)
        first = at if self.first_look is None else self.first_look
        looked = replace(self, probability=left, looked=at, first_look=first, looks=count, in_view=in_view)
        if left >= MIN_PRESENT_PROBABILITY:
            return looked
        return looked.contradicted(f"its place was in view and empty in {count} looks within {at - first:.0f} s")

    def contradicted(self, reason: str) -> ExpectedObject:
        """Return the object as contradicted.

        Parameters
        ----------
        reason
            The reason in words.

        Returns
        -------
        ExpectedObject
            The object.
        """
        return replace(self, standing=Standing.CONTRADICTED, reason=reason)


def introduced(script: Script) -> tuple[str, ...]:
    """Return the objects that an English text says are there, if it is about what is there.

    Parameters
    ----------
    script
        The text as it was read.

    Returns
    -------
    tuple of str
        Objects that the text introduces (*a ball*, *two forks*); nothing for a text in the layout language, one with a
        name, and one that states something of other objects, as descriptions of layouts do.

    Examples
    --------
    >>> from deixis.workflows.layouts.read import read_script
    >>> introduced(read_script(text="There is a red ball left of the plate.", english=True))
    ('ball',)
    >>> introduced(read_script(text="The ball is left of the plate.", english=True))
    ()
    """
    reading = script.reading
    if reading is None or script.name is not None:
        return ()
    new = [
        name
        for name, phrases in reading.mentions.items()
        if name in script.objects and phrases and phrases[0].lower().split()[0] in _INTRODUCED
    ]
    facts = {fact.subject for fact in script.facts}
    claims = {name for claim in script.claims for name in claim.subjects}
    return tuple(new) if (facts | claims) <= set(new) else ()


def described_predicates() -> frozenset[str]:
    """Return the predicates of what a description may say about an object: relations, places and properties.

    Returns
    -------
    frozenset of str
        Names of relations and claims.
    """
    from deixis.ontology.tbox import default_ontology

    relations = {relation.name for relation in default_ontology().relations.values()}
    return frozenset(relations) | DESCRIBED
