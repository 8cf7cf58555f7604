"""Read described activities, *first the plate, then the forks*, and files of learned ones.

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
from deixis.ontology.strict_json import json_type, parse_json
from deixis.printable import shortened
from deixis.reasoning.activities.activity import RELATIONS, Activity, LaidThing, Laying, Step, StepSequence, kind_of
from deixis.text_files import replace_text

_COUNTED = "one two three four five six seven eight nine ten eleven twelve"
_NUMBERS = {word: number for number, word in enumerate(_COUNTED.split(), 1)}
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
    rf"^(?:(?P<det>(?:the )?(?:{'|'.join(_NUMBERS)}|\d\d?)|the|a|an|my|your|all the|all|both the|both)\s+)?"
    r"(?P<noun>[a-z][a-z _-]*?)$",
    re.IGNORECASE,
)


class ActivityTextError(DeixisError, ValueError):
    """A described activity, or a file of activities, that cannot be read or written."""


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
        Groups of things; nothing is said about the order within a group.

    Raises
    ------
    ActivityTextError
        If a part is not understood.
    """
    if not isinstance(text, str) or not text.strip():
        raise ActivityTextError("an activity must be a string, as in 'first the plate, then the forks'")
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
        is_stated = clause.mood is Mood.STATEMENT and clause.positive and all(one.positive for one in clause.predicates)
        phrase = clause.subject if is_stated and not others else None
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
    entries = data.get("activities") if isinstance(data, dict) else None
    if not isinstance(entries, list):
        raise ActivityTextError(f"{path}: not a file of activities: it must be an object with the list 'activities'")
    found: dict[str, Activity] = {}
    for number, entry in enumerate(entries, 1):
        try:
            activity = _activity(entry)
            if activity.name in found:
                raise ActivityTextError("an earlier one has this name; rename one of them")
        except ActivityTextError as error:
            name = entry.get("name") if isinstance(entry, dict) else None
            which = f"'{shortened(name, 60)}'" if isinstance(name, str) and name.strip() else str(number)
            raise ActivityTextError(f"{path}: not a file of activities: activity {which}: {error}") from error
        found[activity.name] = activity
    return tuple(found.values())


def _activity(entry: Any) -> Activity:
    """Return the activity of an entry of a file; raise ActivityTextError if it is not one."""
    _require(isinstance(entry, dict), f"it must be an object, got {json_type(entry)}")
    missing = [key for key in ("name", "examples", "steps", "present", "counts") if key not in entry]
    _require(not missing, f"the key '{', '.join(missing)}' is missing")
    name, examples = entry["name"], entry["examples"]
    _require(isinstance(name, str) and bool(name.strip()), f"'name' must be a string, got {json_type(name)}")
    _require(_is_whole(examples, 1), "'examples' must be a whole number of at least 1")
    lists = {key: entry.get(key, []) for key in ("steps", "present", "counts", "layings")}
    for key, value in lists.items():
        _require(isinstance(value, list), f"'{key}' must be a list, got {json_type(value)}")
    steps = tuple(map(_step, lists["steps"]))
    n = len(steps)
    _require(len(set(steps)) == n, "'steps' must differ from each other")
    present = lists["present"]
    _require(
        len(present) == n and all(_is_number(each) and 0 <= each <= examples for each in present),
        "'present' must have a number from 0 to 'examples' for each step",
    )
    counts = np.zeros((n, n, RELATIONS))
    for count in lists["counts"]:
        fits = isinstance(count, list) and len(count) == 4 and all(_is_whole(place, 0) for place in count[:3])
        fits = fits and max(count[:2]) < n and count[2] < RELATIONS and _is_number(count[3]) and count[3] >= 0
        _require(fits, "each of 'counts' must be two steps, a relation (0 to 12) and a number of at least 0")
        counts[count[0], count[1], count[2]] = count[3]
    stated = np.full((n, n), ALL_ALLEN, dtype=np.uint16)
    layings = tuple(map(_laying, lists["layings"]))
    return Activity(name, steps, stated, np.array(present, np.float64), counts, examples, layings)


def _step(entry: Any) -> Step:
    fits = isinstance(entry, list) and len(entry) == 4 and isinstance(entry[0], str) and _is_whole(entry[3], 1)
    fits = fits and all(part is None or isinstance(part, str) for part in entry[1:3])
    _require(fits, "each of 'steps' must be a thing, a predicate or null, an object or null, and a number")
    return Step(*entry)


def _laying(entry: Any) -> Laying:
    _require(isinstance(entry, list), "each of 'layings' must be a list")
    things = []
    for thing in entry:
        fits = isinstance(thing, list) and len(thing) == 2 and isinstance(thing[0], str)
        place = thing[1] if fits else None
        if isinstance(place, list) and len(place) == 2 and all(map(_is_number, place)):
            things.append(LaidThing(thing[0], (float(place[0]), float(place[1]))))
            continue
        _require(fits and place is None, "a thing of 'layings' must be a kind and either two numbers or null")
        things.append(LaidThing(thing[0], None))
    return tuple(things)


def _is_number(value: Any) -> bool:
    return json_type(value) == "a number"


def _is_whole(value: Any, least: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= least


def _require(holds: bool, what: str) -> None:
    """Raise ActivityTextError with what a file of activities must have, unless it does."""
    if not holds:
        raise ActivityTextError(what)


def write_activities(path: str | Path, activities: tuple[Activity, ...]) -> None:
    """Write learned activities to a file, in one step.

    Parameters
    ----------
    path
        The file.
    activities
        The activities.

    Raises
    ------
    ActivityTextError
        If the file cannot be written; an earlier file is then unchanged.
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
    try:
        replace_text(path, json.dumps({"activities": entries}, indent=1) + "\n")
    except OSError as error:
        raise ActivityTextError(f"{path}: the activities cannot be written: {error.strerror}") from error
