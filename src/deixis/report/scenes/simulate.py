"""Simulated looks at a table as lines of text, plain data and rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.knowledge.rows import Row, scene_rows

if TYPE_CHECKING:
    from deixis.workflows.scenes.simulate import Simulation


def simulation_lines(found: Simulation) -> Iterator[str]:
    """Yield a line for each thing on the table, then the camera and the facts that do not hold.

    Parameters
    ----------
    found
        Answer of ``deixis simulate``.

    Yields
    ------
    str
        Lines in centimetres.
    """
    things = zip(found.truth.objects, found.laid.table.things, found.points.tolist(), strict=True)
    for seen, thing, points in things:
        middle = [(low + high) / 2 for low, high in zip(seen.minimum, seen.maximum, strict=True)]
        place = f"at {100 * middle[0]:.1f}, {100 * middle[1]:.1f}"
        shape = f"{thing.shape}{', as there is no shape for its kind' if thing.generic else ''}"
        yield f"{seen.id:<4} {thing.name:<22} {place:<16} {points:>7} points  {shape}"
    if found.laid.top_name is not None:
        yield f"{found.laid.top_name} is the table itself, not one of the things on it."
    if found.laid.beside:
        yield f"In the air beside the table: {', '.join(found.laid.beside)}."
    x, y, z = found.camera.eye.tolist()
    measured = int(found.cloud.finite.sum())
    yield f"Camera at {100 * x:.1f}, {100 * y:.1f}, {100 * z:.1f} cm; {measured} of {len(found.cloud)} points measured."
    for fact in found.laid.missed:
        yield f"Does not hold: {fact}"


def simulation_to_dict(found: Simulation) -> dict[str, Any]:
    """Return a simulation without its points as plain data: the camera with its pose, and each thing with its label.

    Parameters
    ----------
    found
        Answer of ``deixis simulate``.

    Returns
    -------
    dict
        Data for JSON.
    """
    from deixis.ontology.graph.export import fact_to_dict
    from deixis.perception.formats.scene_json import scene_to_dict

    camera, sensor = found.camera, found.view.sensor
    lens, names = camera.lens, ("width", "height", "fx", "fy", "cx", "cy")
    things = zip(found.truth.objects, found.laid.table.things, found.points.tolist(), strict=True)
    return {
        "simulated": True,
        "seed": found.seed,
        "camera": {**{name: getattr(lens, name) for name in names}, "pose": camera.pose.tolist()},
        "sensor": {"noise": sensor.noise, "missing": sensor.missing, "quantised": sensor.quantised},
        "table": {
            "name": found.laid.top_name,
            "min": list(found.laid.table.top.low),
            "max": list(found.laid.table.top.high),
        },
        "things": [
            {
                "id": seen.id,
                "name": thing.name,
                "kind": thing.kind,
                "shape": thing.shape,
                "generic": thing.generic,
                "label": number,
                "points": points,
            }
            for number, (seen, thing, points) in enumerate(things, start=1)
        ],
        "points": {"all": len(found.cloud), "measured": int(found.cloud.finite.sum())},
        "beside": list(found.laid.beside),
        "missed": [fact_to_dict(fact) for fact in found.laid.missed],
        "scene": scene_to_dict(found.truth),
    }


def simulation_rows(found: Simulation) -> Iterator[Row]:
    """Yield a row for each thing on the table.

    Parameters
    ----------
    found
        Answer of ``deixis simulate``.

    Yields
    ------
    dict
        The columns of :func:`deixis.report.knowledge.rows.scene_rows`, and ``points``, the number of measured points.
    """
    for row, points in zip(scene_rows(found.truth), found.points.tolist(), strict=True):
        yield row | {"points": points}
