"""A reference as lines of text and as plain data for JSON."""

from __future__ import annotations

from typing import Any

from deixis.reasoning.grounding.reference.answer import DECIDED, Reference
from deixis.report.marks import doubt

MAX_LISTED = 3
"""Maximum number of alternatives that the text lists."""


def reference_lines(found: Reference) -> list[str]:
    """Return the target with its probability, what was understood, and the question if in doubt.

    Parameters
    ----------
    found
        Answer of ``deixis refer``.

    Returns
    -------
    list of str
        One line with the reason if there is no target; otherwise the target, the alternatives if it is undecided, the
        paraphrase, the frame of directions, the question, and notes.
    """
    if found.target is None:
        return [f"No object: {'; '.join(found.notes)}."]
    sure = f"{found.target}  probability {found.probability:.2f}"
    lines = [sure if found.decided else doubt(f"{sure}, undecided (below {DECIDED:g})")]
    if not found.decided:
        others = [f"{name} ({probability:.2f})" for name, probability in found.alternatives[:MAX_LISTED]]
        lines.append(f"Alternatives: {', '.join(others)}." if others else "No alternatives.")
    lines.append(f"Understood as: {found.paraphrase} ({100 * found.understood:.0f} % of the words).")
    if found.frame is not None:
        lines.append(f"Directions are taken in the frame of the {found.frame}.")
    if found.question is not None:
        lines.append(f"To ask: {found.question.text}")
    return [*lines, *(f"Note: {note}." for note in found.notes)]


def reference_to_dict(found: Reference) -> dict[str, Any]:
    """Return the answer as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis refer``.

    Returns
    -------
    dict
        Data for JSON. Probabilities and the share of understood words are in [0, 1]; ``target`` and ``question`` may be
        None.
    """
    question = found.question
    return {
        "text": found.text,
        "target": found.target,
        "probability": found.probability,
        "decided": found.decided,
        "alternatives": [{"id": name, "probability": probability} for name, probability in found.alternatives],
        "understood": found.understood,
        "paraphrase": found.paraphrase,
        "frame": None if found.frame is None else str(found.frame),
        "question": None if question is None else {"text": question.text, "yes": list(question.yes)},
        "questions": [{"text": turn.question.text, "answer": "yes" if turn.yes else "no"} for turn in found.turns],
        "notes": list(found.notes),
    }


def reference_rows(found: Reference) -> list[dict[str, Any]]:
    """Return a row for the target and for each alternative.

    Parameters
    ----------
    found
        Answer of ``deixis refer``.

    Returns
    -------
    list of dict
        Rows with ``id`` and ``probability``, the target first; empty without a target and alternatives.
    """
    listed = [] if found.target is None else [(found.target, found.probability)]
    return [{"id": name, "probability": probability} for name, probability in (*listed, *found.alternatives)]
