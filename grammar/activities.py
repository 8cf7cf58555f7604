"""Read told activities, *first the plate, then the forks*, and files of learned ones.

>>> [[str(item) for item in group] for group in read_activity("First the plate, then two forks. Finally the knife.")]
[['plate'], ['fork (2)'], ['knife']]
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from deixis.errors import DeixisError
from deixis.grammar.files import read_text
from deixis.ontology.inflection import is_plural, singular
from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.ontology.strict_json import parse_json
from deixis.reasoning.activities.activity import RELATIONS, Activity, LaidThing, Step, StepSequence, kind_of

_NUMBERS = {word: number for number, word in enumerate(("one", "two", "three", "four", "five", "six"), 1)}
_NEXT = r"(?:and )?(?:then|next|after that|afterwards|after this|finally|at last|lastly|last|at the end|in the end)"
_FIRST = r"(?:first of all|at first|first|firstly|to begin with)"
_BREAK = re.compile(rf"[.;!\n]+|,?\s*\b{_NEXT}\b,?", re.IGNORECASE)
_LEAD = re.compile(rf"^(?:{_FIRST})\b,?\s*", re.IGNORECASE)
_VERBS = re.compile(
    r"\b(?:i|you|we|she|he|they|one)\b|\b(?:put|puts|lay|lays|laid|place|places|placed|set|sets|bring|brings|brought|"
    r"add|adds|added|comes?|goes|go|is|are|follows?|take|takes|taken|down|on|onto|to|the table|table|in place)\b",
    re.IGNORECASE,
)
_ANNOUNCES = re.compile(
    rf"^(?:{_FIRST}|{_NEXT}|and|now|and now|here|here comes|here come)\b[,:]?\s*(?:comes?\b|(?:i|we|you|she|he)\s+"
    r"(?:put|puts|lay|lays|place|places|set|sets|bring|brings|add|adds|take|takes)\b)?",
    re.IGNORECASE,
)
_STATES = re.compile(r"\b(?:is|are|isn['’]t|aren['’]t|was|were)\b|['’]s\b", re.IGNORECASE)
"""Words of a sentence that states how things are, rather than what is being done."""

_ITEM = re.compile(
    r"^(?:(?P<det>the|a|an|my|your|all|all the|both|both the|(?:the )?(?:one|two|three|four|five|six|\d))\s+)?"
    r"(?P<noun>[a-z][a-z _-]*?)$",
    re.IGNORECASE,
)


class ActivityTextError(DeixisError, ValueError):
    """A described activity, or a file of activities, that cannot be read."""


@dataclass(frozen=True, slots=True)
class DescribedItem:
    """Things of a described activity: their kind, and how many; None for all that there are."""

    kind: str
    count: int | None

    def __str__(self) -> str:
        return self.kind if self.count == 1 else f"{self.kind} ({'all' if self.count is None else self.count})"


def read_activity(text: str) -> list[list[DescribedItem]]:
    """Read a described activity.

    Parameters
    ----------
    text
        Things in the order in which they are laid, with words such as *first*, *then*, *finally*, *before*, *after*.

    Returns
    -------
    list of list of DescribedItem
        Groups of things; nothing is said of the order within a group.

    Raises
    ------
    ActivityTextError
        If a part is not understood.
    """
    if not isinstance(text, str) or not text.strip():
        raise ActivityTextError("an activity must be a text, as in 'first the plate, then the forks'")
    groups: list[list[DescribedItem]] = []
    for clause in _BREAK.split(text):
        rest = _LEAD.sub("", clause.strip())
        if not rest:
            continue
        before = re.split(r"\bbefore\b", rest, maxsplit=1, flags=re.IGNORECASE)
        after = re.match(r"^after (?P<first>[^,]+),(?P<second>.+)$", rest, re.IGNORECASE)
        parts = [after["first"], after["second"]] if after else before
        groups += [_items(part, text) for part in parts]
    kinds = [item.kind for group in groups for item in group]
    twice = next((kind for kind in kinds if kinds.count(kind) > 1), None)
    if twice is not None:
        raise ActivityTextError(f"the description names '{twice}' twice; name each kind of thing once")
    return groups


def _items(part: str, text: str) -> list[DescribedItem]:
    items = []
    for phrase in re.split(r",|\band\b", _VERBS.sub(" ", part)):
        words = " ".join(phrase.split())
        if not words:
            continue
        found = _ITEM.match(words)
        if found is None or not found["noun"].strip():
            raise ActivityTextError(
                f"'{words}' in '{text.strip()[:60]}' is not a thing; write, say, 'first the plate, then the forks'"
            )
        noun, number = found["noun"].strip(), (found["det"] or "").split()[-1:]
        count = _NUMBERS.get(number[0].lower(), int(number[0]) if number[0].isdigit() else None) if number else None
        items.append(DescribedItem(kind_of(singular(noun)), count or (None if is_plural(noun) else 1)))
    if not items:
        raise ActivityTextError(f"'{text.strip()[:60]}' names no thing in '{part.strip()}'")
    return items


def announced_thing(text: str) -> str | None:
    """Return the thing that a person says she lays next, or has just laid.

    Parameters
    ----------
    text
        One sentence that begins with a word such as *first*, *then*, *now* or *finally*.

    Returns
    -------
    str or None
        Name of the one thing, in the singular; None for a question, several things, or a sentence of another kind.

    Examples
    --------
    >>> [announced_thing(text) for text in ("First the dinner plate.", "And now I put the fork on the left.")]
    ['dinner plate', 'fork']
    >>> [announced_thing(text) for text in ("The plate is white.", "Then two forks.", "And where is the cup?")]
    [None, None, None]
    """
    from deixis.grammar.english.parse import parse_english
    from deixis.grammar.english.tree import Mood

    announced = _ANNOUNCES.match(text.strip())
    if announced is None or _STATES.search(text):
        return None
    sentences = parse_english(text.strip()[announced.end() :])
    if len(sentences) != 1 or sentences[0].words != sentences[0].words_understood:
        return None
    (sentence,) = sentences
    if sentence.clauses:
        clause, *others = sentence.clauses
        said = clause.mood is Mood.STATEMENT and clause.positive and all(one.positive for one in clause.predicates)
        phrase = clause.subject if said and not others else None
    else:
        phrase = sentence.fragment
    if phrase is None or not phrase.head or phrase.negated or phrase.plural or phrase.count not in (None, 1):
        return None
    return phrase.head


def told_activity(text: str, seen: StepSequence, name: str = "told") -> Activity:
    """Return a described activity with as many steps as a sequence has things of the described kinds.

    Parameters
    ----------
    text
        The described activity.
    seen
        The sequence, in which *the forks* are counted.
    name
        Name of the activity.

    Returns
    -------
    Activity
        The activity; a thing of which there is none is one step.
    """
    groups = []
    for group in read_activity(text):
        steps = []
        for item in group:
            there = sum(step.thing == item.kind for step in seen.steps)
            steps += [Step(item.kind, number=number) for number in range(1, (item.count or max(there, 1)) + 1)]
        groups.append(steps)
    return Activity.in_order(name, groups)


def read_activities(path: str | Path) -> tuple[Activity, ...]:
    """Read a file of learned activities.

    Parameters
    ----------
    path
        The file, which :func:`write_activities` wrote.

    Returns
    -------
    tuple of Activity
        The activities.

    Raises
    ------
    ActivityTextError
        If the file is not one of activities.
    """
    data = parse_json(read_text(Path(path), str(path)), str(path), ActivityTextError, "is not a number")
    try:
        return tuple(_activity(entry) for entry in data["activities"])
    except KeyError as error:
        raise ActivityTextError(f"{path}: not a file of activities: the key {error} is missing") from error
    except (TypeError, ValueError, IndexError) as error:
        raise ActivityTextError(f"{path}: not a file of activities ({str(error).splitlines()[0]})") from error


def _activity(entry: dict[str, Any]) -> Activity:
    steps = tuple(Step(*step) for step in entry["steps"])
    n = len(steps)
    counts = np.zeros((n, n, RELATIONS))
    for a, b, relation, number in entry["counts"]:
        counts[a, b, relation] = number
    present = np.array(entry["present"], dtype=np.float64)
    if present.shape != (n,) or (counts < 0).any() or not int(entry["examples"]) > 0:
        raise ValueError("its numbers do not fit its steps")
    stated = np.full((n, n), ALL_ALLEN, dtype=np.uint16)
    layings = tuple(tuple(_laid(*thing) for thing in laying) for laying in entry.get("layings", ()))
    return Activity(str(entry["name"]), steps, stated, present, counts, int(entry["examples"]), layings)


def _laid(kind: str, place: list[float] | None) -> LaidThing:
    if place is None:
        return LaidThing(str(kind), None)
    x, y = map(float, place)
    return LaidThing(str(kind), (x, y))


def write_activities(path: str | Path, activities: tuple[Activity, ...]) -> None:
    """Write learned activities to a file.

    Parameters
    ----------
    path
        The file.
    activities
        The activities.
    """
    entries = [
        {
            "name": each.name,
            "examples": each.examples,
            "steps": [[step.thing, step.predicate, step.object, step.number] for step in each.steps],
            "present": each.present.tolist(),
            "layings": [[[thing.kind, thing.place] for thing in laying] for laying in each.layings],
            "counts": [[*map(int, at), float(each.counts[tuple(at)])] for at in np.argwhere(each.counts > 0)],
        }
        for each in activities
    ]
    Path(path).write_text(json.dumps({"activities": entries}, indent=1) + "\n", encoding="utf-8")
