"""The things that learners look at: tableware of the simulator, and meshes of other people's."""

from __future__ import annotations

import csv
import os
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from deixis.errors import DeixisError
from deixis.experiments.open_ended.mesh_list import EXCLUDED, MENDED
from deixis.experiments.open_ended.shown import ThingViews
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.simulator.tableware import make
from deixis.perception.simulator.views import views_of

FOLDER = "tabletop-meshes"
SETTING = "place_setting"
"""A whole table, not a thing."""

MAX_EXTENT = 0.5
"""Metres that a thing on a table measures at most."""

Y_UP = "sweethome3d"
"""Where the source says so, y points up; else z does."""


class MeshListError(DeixisError, ValueError):
    """A folder of meshes whose list cannot be read."""


def simulated(kinds: Iterable[str], instances: int, views: int, seed: int) -> Iterator[ThingViews]:
    """So many instances of each kind, in so many views each."""
    for kind in kinds:
        for number in range(instances):
            one = 10_000 * seed + number
            yield ThingViews(
                kind, f"{kind} {number}", views_of(make(kind, seed=one).mesh, views, seed=one, upright=True)
            )


def meshes_folder() -> Path | None:
    """Return where the meshes are, or None where DEIXIS_DATA does not lead to them."""
    folder = Path(os.environ.get("DEIXIS_DATA") or ".") / FOLDER
    return folder if os.environ.get("DEIXIS_DATA") and (folder / "index.csv").is_file() else None


def rows_of(folder: Path) -> list[tuple[str, Path, bool]]:
    """Category, file and whether y is up, of every thing in the list; raises MeshListError where it is none."""
    try:
        with open(folder / "index.csv", encoding="utf-8", newline="") as file:
            return [
                (row["category"], folder / row["file"], Y_UP in row["source"])
                for row in csv.DictReader(file)
                if row["category"] != SETTING
            ]
    except (OSError, KeyError, TypeError, UnicodeDecodeError, csv.Error) as error:
        columns = "columns category, file and source are wanted"
        raise MeshListError(f"{folder / 'index.csv'}: this list of meshes cannot be read; {columns}") from error


def from_meshes(folder: Path, views: int, seed: int) -> Iterator[ThingViews]:
    """Yield every thing of each category that has two or more, in as many views as give ``views`` a category."""
    rows = rows_of(folder)
    counts = Counter(category for category, _, _ in rows)
    for number, (category, file, y_up) in enumerate(rows):
        if counts[category] > 1:
            each = -(-views // counts[category])
            mesh = upright(in_metres(read_mesh(file)), y_up)
            yield ThingViews(category, file.name, views_of(mesh, each, seed=10_000 * seed + number, upright=True))


def listed_meshes(folder: Path) -> Iterator[tuple[str, str, Mesh]]:
    """Yield category, file and mesh (metres, z up) of every thing that :mod:`.mesh_list` leaves in, mended by it."""
    for category, file, y_up in rows_of(folder):
        name = file.relative_to(folder).as_posix()
        if name in EXCLUDED:
            continue
        mend = MENDED.get(name)
        mesh = upright(in_metres(read_mesh(file)), y_up if mend is None or mend.y_up is None else mend.y_up)
        if mend is not None and mend.longest is not None:
            mesh = Mesh(mesh.vertices * (mend.longest / np.ptp(mesh.vertices, axis=0).max()), mesh.faces)
        yield category, name, mesh


def in_metres(mesh: Mesh) -> Mesh:
    """The mesh in metres: its unit is taken for the metre where it is then no larger than ``MAX_EXTENT``, and else for
    the largest decimal part of a metre (decimetre, centimetre, millimetre and so on) in which it is.

    >>> cup = Mesh(np.diag([8.0, 8.0, 9.5]), np.array([[0, 1, 2]], np.int32))
    >>> in_metres(cup).vertices.max().round(3)
    np.float64(0.095)
    """
    largest = float(np.ptp(mesh.vertices, axis=0).max())
    scale = 1.0 if largest <= MAX_EXTENT else 10.0 ** np.floor(np.log10(MAX_EXTENT / largest))
    return Mesh(mesh.vertices * scale, mesh.faces)


def upright(mesh: Mesh, y_up: bool) -> Mesh:
    """Return the mesh with z up."""
    return Mesh(mesh.vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0], mesh.faces) if y_up else mesh
