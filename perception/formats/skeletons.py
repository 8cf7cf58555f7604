"""Read and write recordings of skeletons (``.skeleton.jsonl``): a JSON object on each line.

A line has the time ``at`` in seconds and the ``joints``, each with x, y and z in metres in the frame of the scene, and
optionally the ``person``. A joint that was not seen is null or left out. ``docs/schema/skeleton.schema.json`` is the
schema of a line.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deixis.ontology.strict_json import json_type, read_json_lines
from deixis.perception.checks import shown
from deixis.perception.errors import PointingError
from deixis.perception.pointing.skeleton import MAX_REACH, Position, Skeleton
from deixis.text_files import read_lines

MAX_LINE_CHARACTERS = 100_000
MAX_LINES = 1_000_000
_KEYS = {"at", "joints", "person"}


@dataclass(frozen=True)
class SkeletonFile:
    """Skeletons of a file in order of time, and notes about what was left out."""

    skeletons: tuple[Skeleton, ...]
    notes: tuple[str, ...]


def read_skeletons(path: str | Path, refused: list[str] | None = None) -> SkeletonFile:
    """Read a recording of skeletons.

    A joint whose coordinates are not finite counts as not seen, and a frame whose time is not after the one before, of
    one person, is left out; notes count both.

    Parameters
    ----------
    path
        The file.
    refused
        List that gets the message about each line that is not a skeleton, which is left out then; None to raise an
        error about the first one.

    Returns
    -------
    SkeletonFile
        The skeletons and the notes.

    Raises
    ------
    PointingError
        If the file cannot be read, or a line is not a skeleton; with file and line.
    """
    undecoded = "strict" if refused is None else "surrogateescape"
    return skeletons_of_lines(read_lines(path, PointingError, MAX_LINE_CHARACTERS, undecoded), str(path), refused)


def skeletons_of_lines(
    lines: Iterable[str], file: str = "<skeletons>", refused: list[str] | None = None
) -> SkeletonFile:
    """Return the skeletons of lines of JSON, as :func:`read_skeletons` does.

    Parameters
    ----------
    lines
        Lines; blank ones are skipped.
    file
        Name of their file in messages.
    refused
        As for :func:`read_skeletons`.

    Returns
    -------
    SkeletonFile
        The skeletons and the notes.

    Raises
    ------
    PointingError
        If a line is not a skeleton.

    Examples
    --------
    >>> found = skeletons_of_lines(['{"at": 0.5, "joints": {"head": [0, -0.4, 0.6], "left_hand": null}}'])
    >>> found.skeletons[0].joints
    {'head': (0.0, -0.4, 0.6)}
    """
    skeletons: list[Skeleton] = []
    last: dict[str, float] = {}
    unseen: list[int] = []
    late: list[int] = []
    found = read_json_lines(_within_limits(lines, file), file, _skeleton, PointingError, None, refused)
    for number, (skeleton, complete) in found:
        if not complete:
            unseen.append(number)
        if skeleton.at <= last.get(skeleton.person, -math.inf):
            late.append(number)
            continue
        last[skeleton.person] = skeleton.at
        skeletons.append(skeleton)
    notes = [*_note(unseen, "a joint without finite coordinates counts as not seen"), *_note(late, LATE)]
    return SkeletonFile(tuple(skeletons), tuple(f"{file}: {note}" for note in notes))


LATE = "the time does not increase, so the frame is left out"


def _note(lines: list[int], what: str) -> Iterator[str]:
    if len(lines) == 1:
        yield f"line {lines[0]}: {what}"
    elif lines:
        yield f"{len(lines)} lines, the first is {lines[0]}: {what}"


def _within_limits(lines: Iterable[str], file: str) -> Iterator[str]:
    """Yield the lines; raise an error at one that is too long or beyond the maximum number."""
    for number, line in enumerate(lines, 1):
        if number > MAX_LINES and line.strip():
            raise PointingError(f"{file}:{number}: more than {MAX_LINES:,} lines; split the file")
        if len(line) > MAX_LINE_CHARACTERS and line.strip():
            raise PointingError(
                f"{file}:{number}: more than {MAX_LINE_CHARACTERS:,} characters in a line; a line is one frame"
            )
        yield line


def _skeleton(data: Any, where: str) -> tuple[Skeleton, bool]:
    """Return the skeleton in a line, and False if the coordinates of a joint are not finite."""
    if not isinstance(data, dict):
        raise PointingError(f"{where}: a line must be an object {{…}}, got {json_type(data)}")
    for key in data:
        if key not in _KEYS:
            raise PointingError(f"{where}: unknown key '{shown(key)}'; a skeleton has {', '.join(sorted(_KEYS))}")
    at, joints, person = data.get("at"), data.get("joints"), data.get("person", "person")
    if isinstance(at, bool) or not isinstance(at, int | float) or not math.isfinite(at):
        raise PointingError(f"{where}: 'at' must be a finite number of seconds, got {shown(at)}")
    if not isinstance(joints, dict):
        raise PointingError(f"{where}: 'joints' must be an object with a place for each joint, got {json_type(joints)}")
    if not isinstance(person, str) or not person.strip():
        raise PointingError(f"{where}: 'person' must be a name, got {shown(person)}")
    seen: dict[str, Position] = {}
    complete = True
    for name, place in joints.items():
        if place is None:
            continue
        numbers = isinstance(place, list) and all(isinstance(v, int | float) and not isinstance(v, bool) for v in place)
        if not numbers or len(place) != 3:
            raise PointingError(
                f"{where}: joint '{shown(name)}' must be 3 numbers in metres or null, got {shown(place)}"
            )
        x, y, z = (float(value) for value in place)
        if not all(map(math.isfinite, (x, y, z))):
            complete = False
        elif max(abs(x), abs(y), abs(z)) > MAX_REACH:
            raise PointingError(f"{where}: joint '{shown(name)}' is beyond {MAX_REACH:g} m; give the places in metres")
        else:
            seen[name] = (x, y, z)
    return Skeleton(float(at), seen, person), complete
