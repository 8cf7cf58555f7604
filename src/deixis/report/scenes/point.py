"""Gestures and taught names as lines of text, plain data and rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.perception.pointing.aim import Pointing
    from deixis.workflows.scenes.point import PointedLabel, Shown


def shown_lines(found: Shown) -> Iterator[str]:
    """Yield a line for each gesture, for each name, and for each contradiction and note.

    Parameters
    ----------
    found
        Answer of ``deixis point``.

    Yields
    ------
    str
        The lines; doubtful ones are marked.
    """
    if not found.pointings:
        yield doubt("No gesture was found: no arm was moved and then held still.")
    for pointing in found.pointings:
        gesture = pointing.gesture
        when = f"{gesture.start:.1f} to {gesture.finish:.1f} s, {gesture.person}, {gesture.side} arm"
        if pointing.decided is not None:
            yield f"{when}: {pointing.decided}, probability {pointing.probabilities[pointing.decided]:.2f}"
        else:
            yield doubt(f"{when}: undecided, {pointing.refused}")
    if found.labels:
        yield ""
    for label in found.labels:
        yield _line(label)
    for text in (*found.contradictions, *found.notes):
        yield doubt(text)


def _line(label: PointedLabel) -> str:
    utterance = f"'{label.utterance.text}' at {label.utterance.at:g} s"
    if label.refused is not None:
        asked = f" {label.question}" if label.question else ""
        return doubt(f"{utterance}: refused, {label.refused}.{asked}")
    name = label.name if label.positive else f"not {label.name}"
    return f"{utterance}: {label.target} is taught as {name}, probability {label.probability:.2f}"


def shown_to_dict(found: Shown) -> dict[str, Any]:
    """Return the gestures, the labels, the contradictions and the notes.

    Parameters
    ----------
    found
        Answer of ``deixis point``.

    Returns
    -------
    dict
        Data for JSON. Times are in seconds; probabilities are rounded to 6 digits.
    """
    return {
        "gestures": [_gesture(pointing) for pointing in found.pointings],
        "labels": [_label(label) for label in found.labels],
        "contradictions": list(found.contradictions),
        "notes": list(found.notes),
    }


def shown_rows(found: Shown) -> list[dict[str, Any]]:
    """Return a row for each label.

    Parameters
    ----------
    found
        Answer of ``deixis point``.

    Returns
    -------
    list of dict
        The labels, as in :func:`shown_to_dict`.
    """
    return [_label(label) for label in found.labels]


def _gesture(pointing: Pointing) -> dict[str, Any]:
    gesture = pointing.gesture
    return {
        "person": gesture.person,
        "side": gesture.side,
        "start": round(gesture.start, 3),
        "finish": round(gesture.finish, 3),
        "decided": pointing.decided,
        "probabilities": [{"id": name, "probability": round(p, 6)} for name, p in pointing.probabilities.items()],
        "none": round(pointing.none, 6),
        "question": pointing.question,
        "refused": pointing.refused,
    }


def _label(label: PointedLabel) -> dict[str, Any]:
    return {
        "text": label.utterance.text,
        "at": label.utterance.at,
        "speaker": label.utterance.speaker,
        "name": label.name,
        "positive": label.positive,
        "target": label.target if label.refused is None else None,
        "probability": round(label.probability, 6),
        "refused": label.refused,
        "question": label.question,
    }
