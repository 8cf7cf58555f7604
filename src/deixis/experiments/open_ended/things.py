"""Provide the things that learners look at: tableware of the simulator, and meshes by other makers."""

from __future__ import annotations

import csv
import os
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from deixis.errors import DeixisError
from deixis.experiments.open_ended.described_views import ThingViews
from deixis.experiments.open_ended.mesh_list import CORRECTED, EXCLUDED
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes.tableware import make

FOLDER = "tabletop-meshes"
SETTING = "place_setting"
"""Kind of the simulator that is a whole table, not a thing."""

MAX_EXTENT = 0.5
"""Maximum extent of a thing on a table, in metres."""

Y_UP = "sweethome3d"
"""Source whose y axis points up; z points up in all others."""


class MeshListError(DeixisError, ValueError):
    """A folder of meshes whose list cannot be read."""


def simulated(kinds: Iterable[str], instances: int, views: int, seed: int) -> Iterator[ThingViews]:
    """Yield ``instances`` things of each kind, each in ``views`` views.

    Parameters
    ----------
    kinds
        Kinds of things that the simulator can make.
    instances
        Number of things of each kind.
    views
        Number of views of each thing.
    seed
        Seed of the shapes and of the viewpoints.

    Yields
    ------
    ThingViews
        One thing with the clouds of its views.
    """
    for kind in kinds:
        for number in range(instances):
            one = 10_000 * seed + number
            yield ThingViews(
                kind, f"{kind} {number}", views_of(make(kind, seed=one).mesh, views, seed=one, upright=True)
            )


def meshes_folder() -> Path | None:
    """Return the folder of the meshes, or None if DEIXIS_DATA does not lead to them.

    Returns
    -------
    Path or None
        Existing folder of the meshes with its ``index.csv``.
    """
    folder = Path(os.environ.get("DEIXIS_DATA") or ".") / FOLDER
    return folder if os.environ.get("DEIXIS_DATA") and (folder / "index.csv").is_file() else None


def rows_of(folder: Path) -> list[tuple[str, Path, bool]]:
    """Return category, file and True if y is up, for every thing in the list.

    Parameters
    ----------
    folder
        Folder with ``index.csv``, which has the columns category, file and source.

    Returns
    -------
    list of tuple
        Rows in the order of the list, without those of the category that stands for whole settings.

    Raises
    ------
    MeshListError
        If the list cannot be read.
    """
    try:
        with (folder / "index.csv").open(encoding="utf-8", newline="") as file:
            return [
                (row["category"], folder / row["file"], Y_UP in row["source"])
                for row in csv.DictReader(file)
                if row["category"] != SETTING
            ]
    except (OSError, KeyError, TypeError, UnicodeDecodeError, csv.Error) as error:
        columns = "it must have the columns category, file and source"
        raise MeshListError(f"{folder / 'index.csv'}: this list of meshes cannot be read; {columns}") from error


def from_meshes(folder: Path, views: int, seed: int) -> Iterator[ThingViews]:
    """Yield every thing of each category with two or more, in enough views for ``views`` per category.

    Parameters
    ----------
    folder
        Folder with ``index.csv`` and the meshes.
    views
        Number of views of each category; its things share them, rounded up.
    seed
        Seed of the viewpoints.

    Yields
    ------
    ThingViews
        One thing with the clouds of its views.

    Raises
    ------
    MeshListError
        If the list cannot be read.
    """
    rows = rows_of(folder)
    counts = Counter(category for category, _, _ in rows)
    for number, (category, file, y_up) in enumerate(rows):
        if counts[category] > 1:
            each = -(-views // counts[category])
            mesh = upright(in_metres(read_mesh(file)), y_up)
            yield ThingViews(category, file.name, views_of(mesh, each, seed=10_000 * seed + number, upright=True))


def listed_meshes(folder: Path) -> Iterator[tuple[str, str, Mesh]]:
    """Yield category, file and mesh (metres, z up) of every thing that :mod:`.mesh_list` keeps, corrected by it.

    Parameters
    ----------
    folder
        Folder with ``index.csv`` and the meshes.

    Yields
    ------
    tuple
        Category, path relative to the folder, and mesh.

    Raises
    ------
    MeshListError
        If the list cannot be read.
    """
    for category, file, y_up in rows_of(folder):
        name = file.relative_to(folder).as_posix()
        if name in EXCLUDED:
            continue
        correction = CORRECTED.get(name)
        mesh = upright(
            in_metres(read_mesh(file)), y_up if correction is None or correction.y_up is None else correction.y_up
        )
        if correction is not None and correction.longest is not None:
            mesh = Mesh(mesh.vertices * (correction.longest / np.ptp(mesh.vertices, axis=0).max()), mesh.faces)
        yield category, name, mesh


def in_metres(mesh: Mesh) -> Mesh:
    """Return the mesh in metres.

    The unit is taken to be the metre if the mesh is then no larger than ``MAX_EXTENT``, otherwise the largest decimal
    part of a metre (decimetre, centimetre, millimetre and so on) for which it is.

    Parameters
    ----------
    mesh
        Mesh in an unknown unit.

    Returns
    -------
    Mesh
        Mesh with scaled vertices.

    Examples
    --------
    >>> cup = Mesh(np.diag([8.0, 8.0, 9.5]), np.array([[0, 1, 2]], np.int32))
    >>> in_metres(cup).vertices.max().round(3)
    np.float64(0.095)
    """
    largest = float(np.ptp(mesh.vertices, axis=0).max())
    scale = 1.0 if largest <= MAX_EXTENT else 10.0 ** np.floor(np.log10(MAX_EXTENT / largest))
    return Mesh(mesh.vertices * scale, mesh.faces)


def upright(mesh: Mesh, y_up: bool) -> Mesh:
    """Return the mesh with z up.

    Parameters
    ----------
    mesh
        Mesh with y or z up.
    y_up
        True if y is up.

    Returns
    -------
    Mesh
        Mesh turned by 90° about x if y was up, otherwise the mesh itself.
    """
    return Mesh(mesh.vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0], mesh.faces) if y_up else mesh
