"""A robot's conclusions about a table, and its lessons from a description, as lines of text, plain data and rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.marks import doubt, violation

if TYPE_CHECKING:
    from deixis.robot.looking import Look
    from deixis.robot.robot import Told


def look_lines(look: Look) -> Iterator[str]:
    """Yield the layout, a line for each thing, and a line for each mistake.

    Parameters
    ----------
    look
        Answer of :meth:`deixis.robot.robot.Robot.look`.

    Yields
    ------
    str
        The lines; unknown things are marked as doubt, mistakes as violations.
    """
    if look.layout is None:
        yield doubt("No known layout explains this table.")
    else:
        yield f"This table is laid as '{look.layout}' says, probability {look.layouts[look.layout]:.2f}."
    for thing, names in look.names.items():
        listed = ", ".join(f"{name} {share:.2f}" for name, share in list(names.items())[:3] if share >= 0.005)
        line = f"{thing:<6}{listed or 'unknown'}"
        yield line if look.name(thing) is not None else doubt(line)
    for fault in look.faults():
        yield violation(f"{str(fault)[0].upper()}{str(fault)[1:]}.")


def look_to_dict(look: Look) -> dict[str, Any]:
    """Return the layouts, the things and the mistakes as plain data.

    Parameters
    ----------
    look
        Answer of :meth:`deixis.robot.robot.Robot.look`.

    Returns
    -------
    dict
        Data for JSON. Probabilities are rounded to 6 digits.
    """
    return {
        "layout": look.layout,
        "layouts": [{"name": name, "probability": _rounded(share)} for name, share in look.layouts.items()],
        "things": [
            {
                "id": thing,
                "name": look.name(thing),
                "names": [{"name": name, "probability": _rounded(share)} for name, share in names.items()],
            }
            for thing, names in look.names.items()
        ],
        "faults": [
            {"kind": fault.kind.value, "names": list(fault.names), "things": list(fault.things), "text": str(fault)}
            for fault in look.faults()
        ],
    }


def look_rows(look: Look) -> list[dict[str, Any]]:
    """Return a row for each thing.

    Parameters
    ----------
    look
        Answer of :meth:`deixis.robot.robot.Robot.look`.

    Returns
    -------
    list of dict
        Id, name, the probability of the name, and the mistakes that the thing is part of.
    """
    faults = look.faults()
    return [
        {
            "id": thing,
            "name": (name := look.name(thing)),
            "probability": None if name is None else _rounded(names[name]),
            "faults": "; ".join(str(fault) for fault in faults if thing in fault.things),
        }
        for thing, names in look.names.items()
    ]


def told_lines(told: Told) -> Iterator[str]:
    """Yield what was learned, a line for each known role, and a line for each one that waits.

    Parameters
    ----------
    told
        Answer of :meth:`deixis.robot.robot.Robot.told`.

    Yields
    ------
    str
        The lines; roles that wait are marked as doubt.
    """
    yield f"Learned '{told.lesson.layout}' as lesson {told.lesson.id}"
    for role, settled in told.lesson.settled.items():
        yield f"{role:<24} {settled.thing:<8} {settled.probability:.2f}"
    for role, among in told.lesson.waiting.items():
        listed = ", ".join(f"{thing or 'none of them'} {share:.2f}" for thing, share in list(among.items())[:4])
        yield doubt(f"{role:<24} waits: {listed}")
    if told.contradiction is not None:
        yield doubt(f"The description contradicts an earlier one: {told.contradiction}")


def told_to_dict(told: Told) -> dict[str, Any]:
    """Return the lesson with its known and its waiting roles as plain data.

    Parameters
    ----------
    told
        Answer of :meth:`deixis.robot.robot.Robot.told`.

    Returns
    -------
    dict
        Data for JSON. Probabilities are rounded to 6 digits.
    """
    return {
        "layout": told.lesson.layout,
        "lesson": told.lesson.id,
        "taught": [
            {"role": role, "thing": known.thing, "by": known.by.value, "probability": _rounded(known.probability)}
            for role, known in told.lesson.settled.items()
        ],
        "waiting": [
            {
                "role": role,
                "among": [{"thing": thing, "probability": _rounded(share)} for thing, share in among.items()],
            }
            for role, among in told.lesson.waiting.items()
        ],
        "contradiction": told.contradiction,
    }


def told_rows(told: Told) -> list[dict[str, Any]]:
    """Return a row for each role.

    Parameters
    ----------
    told
        Answer of :meth:`deixis.robot.robot.Robot.told`.

    Returns
    -------
    list of dict
        Role, the thing that it most probably is, the probability, and whether the role waits.
    """
    known = [
        {"role": role, "thing": settled.thing, "probability": _rounded(settled.probability), "waiting": False}
        for role, settled in told.lesson.settled.items()
    ]
    waiting = []
    for role, among in told.lesson.waiting.items():
        thing, share = max(among.items(), key=lambda item: item[1], default=(None, 0.0))
        waiting.append({"role": role, "thing": thing, "probability": _rounded(share), "waiting": True})
    return known + waiting


def _rounded(probability: float) -> float:
    return round(min(probability, 1.0), 6)
