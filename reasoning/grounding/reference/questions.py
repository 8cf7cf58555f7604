"""Choose yes-or-no questions about the object that is meant, so that few are needed."""

from __future__ import annotations

from collections.abc import Iterator
from heapq import heappop, heappush
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.inflection import is_plural
from deixis.reasoning.grounding.reference.answer import DECIDED, Question
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.wording import named

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

WRONG_ANSWERS = 0.002
"""Share of wrong answers, which later answers can correct."""

MIN_PROBABILITY = 2e-3
"""Probability below which an object does not decide how clear a question is."""

COMPARED = 40
"""Number of questions with the greatest gain whose answers are looked ahead."""

MAX_LANDMARKS = 14
"""Maximum number of landmarks that questions compare."""

CLEAR = 1.15
"""Minimum ratio of two lengths that an answer tells apart."""


def best_question(probabilities: Array, room: Room, labelled: bool = True, enough: float = DECIDED) -> Question | None:
    """Return the question after which the fewest questions remain; None if no question tells two objects apart.

    Parameters
    ----------
    probabilities
        Probability of each object, shape (n,).
    room
        The scene.
    labelled
        Whether questions may use the labels of the scene.
    enough
        Probability of an object at which no more questions are asked.

    Returns
    -------
    Question or None
        The question, or None.

    Notes
    -----
    A question with a share q of the probability on *yes* gains the entropy of q. Of the COMPARED questions that
    gain most, the one is asked that leaves the least expected number of further questions (:func:`fewest_questions`
    of both answers). Only questions whose answer is clear for all likely objects are asked: two compared lengths
    differ by a factor of ``CLEAR``.

    The gain is the expected information of the answer (D. V. Lindley, "On a measure of the information provided by an
    experiment", Annals of Mathematical Statistics 27, 1956).
    """
    likely = np.flatnonzero(probabilities >= MIN_PROBABILITY)
    shares = probabilities[likely] / probabilities[likely].sum()
    known: dict[bytes, tuple[str, Mask, float]] = {}
    for text, yes, cost in _questions(room, likely, labelled):
        key = yes.tobytes()
        if not yes.all() and yes.any() and (key not in known or cost < known[key][2]):
            known[key] = (text, yes, cost)
    if not known:
        return None
    asked = [*known.values()]
    masks = np.array([mask for _, mask, _ in asked])
    costs = np.array([cost for *_, cost in asked])
    on_yes = masks @ shares
    gains = -on_yes * np.log2(on_yes) - (1 - on_yes) * np.log2(1 - on_yes) - costs
    best, chosen = np.inf, 0
    for place in np.argsort(-gains, kind="stable")[:COMPARED]:
        yes = masks[place]
        parts = (shares[yes], shares[~yes])
        left = sum(float(part.sum()) * fewest_questions(part, enough) for part in parts) + costs[place]
        if left < best - 1e-9:
            best, chosen = left, int(place)
    text, yes, _ = asked[chosen]
    return Question(text, tuple(room.ids[index] for index in likely[yes]))


def fewest_questions(shares: Array, enough: float = DECIDED) -> float:
    """Return the approximate minimum of the expected number of yes-or-no questions until an object is probable enough.

    It is the mean length of a Huffman code (1952) for the objects, without the least probable ones that together have
    less than the share ``1 - enough``: for these, no question needs to be asked.

    Parameters
    ----------
    shares
        Probabilities of the objects, shape (n,).
    enough
        Probability of an object at which no more questions are asked.

    Returns
    -------
    float
        Expected number of questions, at least 0.

    Examples
    --------
    >>> fewest_questions(np.array([0.96, 0.04])), fewest_questions(np.array([0.5, 0.3, 0.2]))
    (0.0, 1.5)
    """
    ranked = np.sort(shares)[::-1] / shares.sum()
    kept = int(np.searchsorted(np.cumsum(ranked), enough)) + 1
    heap = [float(share) for share in ranked[:kept][::-1]]
    total = 0.0
    while len(heap) > 1:
        joined = heappop(heap) + heappop(heap)
        total += joined
        heappush(heap, joined)
    return total / float(ranked[:kept].sum())


def answered(probabilities: Array, room: Room, question: Question, yes: bool) -> Array:
    """Return the probabilities after an answer, which is wrong in a share of WRONG_ANSWERS.

    Parameters
    ----------
    probabilities
        Probability of each object before the answer, shape (n,).
    room
        The scene.
    question
        The question.
    yes
        The answer.

    Returns
    -------
    ndarray
        Probabilities, shape (n,), which add up to 1.
    """
    among = np.isin(np.array(room.ids), question.yes)
    after = probabilities * np.where(among == yes, 1 - WRONG_ANSWERS, WRONG_ANSWERS)
    result: Array = after / after.sum()
    return result


def _questions(room: Room, likely: NDArray[np.intp], labelled: bool) -> Iterator[tuple[str, Mask, float]]:
    """Yield questions with the likely objects of the answer yes, and a cost in bits for long questions."""
    labels = [room.labels[index] for index in likely]
    if labelled and None not in labels:  # an object without a label may be of any class
        for label in dict.fromkeys(label for label in labels if label is not None):
            be = "Are they" if is_plural(label) else "Is it"
            yield f"{be} {named(label)}?", np.array([one == label for one in labels]), 0.0
    floor, top = room.boxes[likely, 0, 2] - room.bounds[0, 2], room.boxes[likely, 1, 2] - room.bounds[0, 2]
    measures = (
        ("Is it longer or wider than {}?", room.extents[likely, :2].max(axis=1)),
        ("Is it taller than {}?", room.extents[likely, 2]),
        ("Is its lower end higher than {} above the floor?", floor),
        ("Is its upper end higher than {} above the floor?", top),
        ("Is it farther than {} from the middle of the room?", _from(room, likely, room.middle)),
    )
    for wording, values in measures:
        for limit in _limits(values):
            yield wording.format(_metres(limit)), values > limit, 0.05
    if not labelled:
        big = int(np.argmax(np.where(room.surrounds, 0.0, np.prod(room.extents[:, :2], axis=1))))
        values = _from(room, likely, room.centres[big, :2])
        for limit in _limits(values):
            yield f"Is it farther than {_metres(limit)} from the largest object?", values > limit, 0.05
        return
    marks = _landmarks(room, likely)
    apart = {
        f"the {label}" if len(ones) == 1 else f"any {label}": room.gaps[np.ix_(likely, np.array(ones))].min(axis=1)
        * room.scale
        + 0.1
        for label, ones in marks.items()
    }
    for label, values in apart.items():
        ranked = np.sort(values)
        if len(ranked) > 1 and ranked[1] >= CLEAR * ranked[0]:
            yield f"Is it the one closest to {label}?", values == ranked[0], 0.0
        if len(ranked) > 1 and ranked[-1] >= CLEAR * ranked[-2]:
            yield f"Is it the one farthest from {label}?", values == ranked[-1], 0.0
        for limit in _limits(values):
            yield f"Is it within {_metres(limit)} of {label}?", values < limit, 0.05
    names = list(apart)
    for place, first in enumerate(names):
        for second in names[place + 1 :]:
            ratio = apart[first] / apart[second]
            if (np.maximum(ratio, 1 / ratio) >= CLEAR).all():
                yield f"Is it closer to {first} than to {second}?", ratio < 1, 0.02


def _landmarks(room: Room, likely: NDArray[np.intp]) -> dict[str, list[int]]:
    """Return the objects of each label that none of the likely objects has; those of the largest objects."""
    found: dict[str, list[int]] = {}
    for index, label in enumerate(room.labels):
        if label is not None and not room.surrounds[index]:
            found.setdefault(label, []).append(index)
    known = {room.labels[index] for index in likely}
    volume = np.prod(room.extents + 0.1, axis=1)
    others = [label for label in found if label not in known]
    others.sort(key=lambda label: (len(found[label]) > 1, -float(volume[found[label]].max())))
    return {label: found[label] for label in others[:MAX_LANDMARKS]}


def _from(room: Room, likely: NDArray[np.intp], place: Array) -> Array:
    result: Array = np.linalg.norm(room.centres[likely, :2] - place, axis=1)
    return result


def _limits(values: Array) -> Iterator[float]:
    """Yield limits between values that are clearly apart."""
    ranked = np.sort(values)
    for low, high in pairwise(ranked):
        if high > CLEAR * low and high - low > 0.05:
            middle = (max(low, 1e-3) * high) ** 0.5
            digits = 1 if middle >= 1 else 2
            rounded = round(float(middle), digits)
            yield rounded if low < rounded < high else float(middle)


def _metres(length: float) -> str:
    return f"{length:.2g} m" if length >= 1 else f"{100 * length:.0f} cm"
