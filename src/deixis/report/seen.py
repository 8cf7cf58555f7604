"""What was perceived, taught and recognised, as lines of text and as plain data for JSON."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deixis.learning.views import Recognised, Taught
    from deixis.perception.recognition.recogniser import Recognition
    from deixis.perception.scene import Scene


def scene_lines(scene: Scene) -> list[str]:
    """Return a line per object: its id, the sides of its box and where its centre is."""
    unit, scale, digits = ("px", 1, 0) if scene.unit == "px" else ("cm", 100, 1)
    lines = []
    for thing in scene.objects:
        low, high = ([scale * value for value in corner] for corner in (thing.minimum, thing.maximum))
        sides = " x ".join(f"{b - a:.{digits}f}" for a, b in zip(low, high, strict=True))
        x, y = ((low[k] + high[k]) / 2 for k in (0, 1))
        lines.append(f"{thing.id:<5} {sides:>20} {unit} at {x:6.{digits}f}, {y:6.{digits}f}")
    return lines or ["Nothing was found."]


_SHOWN = {
    "table": "The cloud shows a table.",
    "tables": "The cloud shows several tables, of which one was looked at.",
    "object": "The cloud shows one object, without a table.",
    "room": "The cloud shows a room.",
    "nothing": "The cloud shows neither a table nor an object.",
}


def shows_line(shows: str) -> str:
    """Return what a cloud shows, as a sentence."""
    return _SHOWN[shows]


def taught_line(taught: Taught, name: str) -> str:
    """Return what a view that was taught is of, and how many views there are now."""
    corrected = f", and no longer of '{taught.before}'" if taught.before else ""
    return f"{name} is a view of '{taught.category}'{corrected}; {taught.views} in all."


def meant_lines(said: str, known: str) -> list[str]:
    """Return a line that says so where a word is taken for a category that is spelled otherwise."""
    return [] if said == known else [f"'{said}' is taken for '{known}', from which only its case differs."]


MAX_NAMES = 3
"""Number of candidates that a line lists, at most."""

MIN_LISTED = 0.05
"""Probability from which a candidate is listed."""


def answer_line(name: str, answer: Recognition) -> str:
    """Return the line of one object: its label, its probability, and the reasons."""
    return f"{name:<5} {answer_words(answer)}   {'; '.join(answer.reasons)}"


def recognised_lines(found: Recognised) -> list[str]:
    """Return a line for each object that has a cloud."""
    lines = [answer_line(name, answer) for name, answer in found.answers.items()]
    return lines or ["Nothing in this scene has a cloud: only what perceive -o wrote can be recognised."]


def answer_words(answer: Recognition) -> str:
    """Return a label and its probability.

    Without a label the likeliest candidates stand in its place, after ``unknown``, which means none of them.
    """
    listed = [one for one in answer.candidates[:MAX_NAMES] if one.probability >= MIN_LISTED]
    perhaps = "".join(f", {one.category} {one.probability:.2f}" for one in listed) if answer.label is None else ""
    return f"{answer.label or 'unknown':<20} {answer.probability:.2f}{perhaps}"


def recognised_to_dict(found: Recognised) -> dict[str, Any]:
    """Return each thing's name, its probability, and the distances behind it.

    The probabilities of the candidates and ``unknown``, that of none of them, sum to 1. A label is given from
    ``min_probability`` on.
    """
    from deixis.perception.recognition.settings import MIN_LABEL_PROBABILITY

    return {
        "objects": [
            {
                "object": id,
                "label": answer.label,
                "probability": round(answer.probability, 6),
                "unknown": round(answer.unknown, 6),
                "min_probability": MIN_LABEL_PROBABILITY,
                "reasons": list(answer.reasons),
                "candidates": [_candidate(candidate) for candidate in answer.candidates],
            }
            for id, answer in found.answers.items()
        ]
    }


def _candidate(candidate: Any) -> dict[str, Any]:
    finite = math.isfinite(candidate.distance)
    return {
        "category": candidate.category,
        "D_C": round(candidate.distance, 6) if finite else None,
        "ICD": None if candidate.spread.width.icd is None else round(candidate.spread.width.icd, 6),
        "divisor": round(candidate.spread.value, 6),
        "divisor_from": candidate.spread.source,
        "ND": round(candidate.normalised, 6) if finite else None,
        "nearest": candidate.nearest,
        "views": candidate.views,
        "probability": round(candidate.probability, 6),
    }
