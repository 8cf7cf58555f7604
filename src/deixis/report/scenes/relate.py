"""The relations of a scene as lines, as a matrix and as JSON, line by line, as a large scene has millions."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from deixis.reasoning.grounding.evidence.claims.scene_words import SceneWords
    from deixis.reasoning.qualitative.relate import Related


def pair_lines(
    related: Related, subject: str | None = None, object: str | None = None, words: SceneWords | None = None
) -> Iterator[str]:
    """Yield a line for every ordered pair: subject, relation, object, and the likely words with their probabilities.

    Parameters
    ----------
    related
        Relations of all pairs of n things in one calculus.
    subject, object
        Id of the only subject or object to list, or None for all.
    words
        Probabilities of the words of each pair, or None to leave the words out.

    Yields
    ------
    str
        A line for each pair, in aligned columns; then one for each likely *between*.

    Raises
    ------
    UnknownTermError
        If no thing has the id of ``subject`` or ``object``.
    """
    place = {name: i for i, name in enumerate(related.ids)}
    wide_object = max((len(related.ids[i]) for i in related.places(object)), default=0)
    rows, columns = related.places(subject), related.places(object)
    wide = max((len(related.ids[i]) for i in rows), default=0)
    mid = max((_widest(related, i, columns) for i in rows), default=0)
    empty = True
    for a, sign, b in related.pairs(subject, object):
        empty = False
        if words is None:
            yield f"{a:<{wide}}  {sign:<{mid}}  {b}"
        else:
            degrees = ", ".join(f"{word} {share:.2f}" for word, share in words.of(place[a], place[b]).items())
            yield f"{a:<{wide}}  {sign:<{mid}}  {b:<{wide_object}}  {degrees}".rstrip()
    if empty:
        yield "There are no pairs."
    for i, j, k, share in words.triples() if words is not None else ():
        if (subject is None or i in related.places(subject)) and (object is None or place[object] in (j, k)):
            yield f"{related.ids[i]:<{wide}}  between {related.ids[j]} and {related.ids[k]} {share:.2f}"


def _widest(related: Related, row: int, columns: range) -> int:
    """Return the length of the longest sign between a subject and the other objects."""
    there = np.array([column for column in columns if column != row], dtype=np.int64)
    return max((len(related.signs[code]) for code in np.unique(related.codes[row, there]).tolist()), default=0)


def matrix_lines(related: Related) -> Iterator[str]:
    """Yield a matrix with subjects in rows and objects in columns, and dots on the diagonal.

    Parameters
    ----------
    related
        Relations of all pairs of n things in one calculus.

    Yields
    ------
    str
        The header with the ids, then n rows in aligned columns.
    """
    if not related.ids:
        yield "There are no objects."
        return
    lengths = np.array([len(sign) for sign in related.signs])[related.codes].max(axis=0).tolist()
    widths = [max(len(name), length) for name, length in zip(related.ids, lengths, strict=True)]
    first = max(map(len, related.ids))
    yield _row("", related.ids, first, widths)
    for i, name in enumerate(related.ids):
        signs = [related.signs[code] for code in related.codes[i].tolist()]
        signs[i] = "."
        yield _row(name, signs, first, widths)


def _row(head: str, cells: Sequence[str], first: int, widths: list[int]) -> str:
    padded = (f"{cell:<{width}}" for cell, width in zip(cells, widths, strict=True))
    return "  ".join((f"{head:<{first}}", *padded)).rstrip()


def json_lines(
    related: Related, subject: str | None = None, object: str | None = None, words: SceneWords | None = None
) -> Iterator[str]:
    """Yield the calculus, the objects, and every ordered pair, as the lines of one JSON object.

    Parameters
    ----------
    related
        Relations of all pairs of n things in one calculus.
    subject, object
        Id of the only subject or object to list, or None for all.
    words
        Probabilities of the words of each pair, or None to leave the words out.

    Yields
    ------
    str
        Lines without their ends, one pair at a time, so that many pairs need little memory.

    Raises
    ------
    UnknownTermError
        If no thing has the id of ``subject`` or ``object``.
    """
    place = {name: i for i, name in enumerate(related.ids)}
    ids = {name: _json(name) for name in related.ids}
    signs = {sign: _json(sign) for sign in related.signs}
    head = json.dumps({"calculus": related.calculus, "objects": list(related.ids)}, indent=2, ensure_ascii=False)
    yield head.removesuffix("\n}") + ","
    previous = '  "pairs": ['
    for a, sign, b in related.pairs(subject, object):
        yield previous
        words_json = ""
        if words is not None:
            known = {word: round(share, 4) for word, share in words.of(place[a], place[b]).items()}
            words_json = f',\n      "words": {json.dumps(known)}'
        pair = f'"subject": {ids[a]},\n      "relation": {signs[sign]},\n      "object": {ids[b]}{words_json}'
        yield f"    {{\n      {pair}"
        previous = "    },"
    end = "" if words is None else ","
    yield ('  "pairs": []' if previous != "    }," else "    }\n  ]") + end
    if words is not None:
        between = [
            {"subject": related.ids[i], "objects": [related.ids[j], related.ids[k]], "probability": round(share, 4)}
            for i, j, k, share in words.triples()
            if (subject is None or related.ids[i] == subject) and (object is None or place[object] in (j, k))
        ]
        yield f'  "between": {json.dumps(between, ensure_ascii=False)}'
    yield "}"


def related_to_dict(related: Related) -> dict[str, Any]:
    """Return the relations of all pairs as plain data, with the keys of :func:`json_lines`.

    Parameters
    ----------
    related
        Relations of all pairs of n things in one calculus.

    Returns
    -------
    dict
        Data for JSON with the keys ``calculus``, ``objects`` and ``pairs``.
    """
    return {"calculus": related.calculus, "objects": list(related.ids), "pairs": list(related_rows(related))}


def related_rows(related: Related) -> Iterator[dict[str, Any]]:
    """Yield a row for every ordered pair.

    Parameters
    ----------
    related
        Relations of all pairs of n things in one calculus.

    Yields
    ------
    dict
        ``subject``, ``relation`` and ``object``.
    """
    for subject, relation, other in related.pairs():
        yield {"subject": subject, "relation": relation, "object": other}


def _json(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
