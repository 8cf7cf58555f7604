"""Learn where a person puts things from examples, and say where other things go."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.grammar.formats.habits import StatedHabits, read_habits
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import require_time_limit
from deixis.reasoning.habits.habits import Habits, Placement, Rule

HABITS_TIME_LIMIT = 10.0
"""Default time limit in seconds."""


@dataclass(frozen=True, repr=False)
class Placements(Answer):
    """Rules about where a person puts things, and the places of further things.

    Examples
    --------
    >>> found = habits({"sneakers": "rack", "boots": "rack", "sweater": "chair"}, ["sandals"])
    >>> found, found.places, found.things[0].place
    (<Placements 1 rule, 1 thing placed>, ('rack', 'chair'), 'rack')
    """

    places: tuple[str, ...]
    rules: tuple[Rule, ...]
    exceptions: tuple[Placement, ...]
    """Examples that no rule explains, or that a rule puts elsewhere, where they were put."""

    things: tuple[Placement, ...]

    def summary(self) -> str:
        """Return the numbers of rules and of placed things."""
        return f"{count(len(self.rules), 'rule')}, {count(len(self.things), 'thing')} placed"


@checks_arguments
def habits(
    examples: Mapping[str, str] | str | Path,
    things: Sequence[str] = (),
    *,
    rules: Mapping[str, str] | None = None,
    places: Sequence[str] = (),
    time_limit: float = HABITS_TIME_LIMIT,
) -> Placements:
    """Learn rules from examples of where a person puts things, and place other things by them.

    Parameters
    ----------
    examples
        Places by thing, or the path of a file with a line ``thing: place`` for each.
    things
        Nouns, with or without adjectives, of the things to place.
    rules
        Places by the words of a rule that a person stated: ``{"soft toys": "shelf"}``. They hold against examples.
    places
        Further places, which have no example.
    time_limit
        Seconds for the search of rules; after it, the best rules so far count.

    Returns
    -------
    Placements
        The rules in words, the examples against them, and the places of the things with their probabilities.

    Raises
    ------
    DeixisError
        If the file cannot be read, nothing is stated, or a rule names nothing that the lexicon knows.

    Examples
    --------
    >>> found = habits({"sneakers": "rack", "boots": "rack", "sweater": "chair", "shorts": "chair"}, ["sandals"])
    >>> [(rule.concept, rule.place) for rule in found.rules], found.things[0].place
    ([('shoes', 'rack'), ('clothing', 'chair')], 'rack')
    """
    require_time_limit(time_limit)
    stated = StatedHabits(dict(examples), {}, ()) if isinstance(examples, Mapping) else read_habits(examples)
    learned = Habits(
        stated.examples,
        (*stated.places, *places),
        {**stated.rules, **(rules or {})},
        default_ontology(),
        Deadline.after(time_limit),
    )
    exceptions = tuple(learned.place_of(thing) for thing in learned.exceptions)
    return Placements(learned.places, learned.rules, exceptions, tuple(learned.place_of(thing) for thing in things))
