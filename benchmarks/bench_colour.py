"""Measure colour beside shape: objects on ten Kinect tables, each table named by the views of the others.

DEIXIS_DATA leads to ``mosd-tabletop``, whose truth gives the points of each object. Which object it is was read off the
colour images (``SAME``): 45 views of 13 objects, under one lamp, partly hidden by others. Each table is named after all
others were taught; "unknown" leaves out the object itself. Points are put in the table's frame by the true table.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from common import data_folder
from numpy.typing import NDArray
from records import command_line, figure, recorded, share

from deixis.learning.views.views import COLOUR, FORM, SPIN_IMAGE_ROOTS, UPRIGHT, Comparison, known_by
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.recognition.calibration import auroc, expected_calibration_error
from deixis.perception.recognition.instances import InstanceCategory

FOLDER = "mosd-tabletop"
SAME = {
    "cookie tin": ("34:2", "40:2", "44:2", "46:2", "48:2", "52:2"),
    "spotted can": ("34:3", "40:4", "44:6", "48:6", "54:6"),
    "nut can": ("34:4", "40:3", "46:3", "48:5"),
    "mug": ("34:5", "34:6", "54:8"),
    "crisps": ("24:2", "50:8", "52:7"),
    "chocolate bars": ("46:6", "48:7", "50:3", "52:4", "54:2"),
    "handbook": ("50:2", "52:5"),
    "white tube": ("50:4", "52:3"),
    "cereal": ("44:4", "46:5", "48:3"),
    "wheat biscuits": ("50:6", "52:6", "54:5"),
    "muesli": ("50:7", "52:8", "54:7"),
    "flakes": ("44:3", "46:7", "48:4"),
    "juice bag": ("44:5", "46:8", "48:8"),
}
"""The tables and objects (a segment's label over ten) where each object is seen."""

TABLE_LABELS = (1, 9)
CLOSE = 0.01
"""Distance in metres from the plane within which a point counts as part of the table."""

WAYS: dict[str, Comparison] = {
    "spin images": (SPIN_IMAGE_ROOTS,),
    "spin images and colour": (SPIN_IMAGE_ROOTS, COLOUR),
    "upright and form": (UPRIGHT, FORM),
    "default: and colour": (UPRIGHT, FORM, COLOUR),
}
Views = list[tuple[str, str, PointCloud]]


def views_of_tables(folder: Path) -> Views:
    """Return the object, table and cloud of every view, in the frame of its table."""
    places = sorted((place.split(":"), thing) for thing, listed in SAME.items() for place in listed)
    found: Views = []
    for table in dict.fromkeys(table for (table, _), _ in places):
        cloud = read_cloud(folder / f"test{table}.pcd")
        assert cloud.labels is not None
        low, high = TABLE_LABELS
        turn, middle = frame_of(cloud.points[(cloud.labels >= low) & (cloud.labels <= high) & cloud.finite])
        for (own, number), thing in places:
            if own == table:
                part = cloud.take((cloud.labels // 10 == int(number)) & cloud.finite)
                points = ((part.points - middle) @ turn.T).astype(np.float32)
                x, y, z = (turn @ -middle).tolist()
                found.append((thing, table, PointCloud(points, part.colours, origin=(x, y, z))))
    return found


def frame_of(table: NDArray[np.float32]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return rotation and origin of the frame in which the table is z = 0 and the camera is above it, at negative y."""
    points = table.astype(np.float64)[::10]
    near = points
    for _ in range(5):
        middle = near.mean(axis=0)
        up = np.linalg.svd(near - middle, full_matrices=False)[2][2]
        near = points[np.abs((points - middle) @ up) < CLOSE]
    up *= np.sign(-middle @ up)
    forth = middle - (middle @ up) * up
    forth /= np.linalg.norm(forth)
    return np.stack([np.cross(forth, up), forth, up]), middle


def answers(views: Views, way: Comparison) -> Iterator[tuple[float, ...]]:
    """Yield the results of each view.

    They are: whether its object is nearest, and named; least ND with the object and without it; confidence and whether
    the answer is right, with and without; and the weight of the last descriptor.
    """
    described = [[each.describe(cloud) for each in way] for _, _, cloud in views]
    for table in dict.fromkeys(table for _, table, _ in views):
        taught = [number for number, (_, own, _) in enumerate(views) if own != table]
        categories = [
            tuple(
                InstanceCategory.of(name, [(str(n), described[n][part]) for n in taught if views[n][0] == name])
                for part in range(len(way))
            )
            for name in sorted({views[number][0] for number in taught})
        ]
        known = known_by(way, categories).calibrated().recogniser
        for number, (thing, own, _) in enumerate(views):
            if own != table:
                continue
            found = known.recognise(described[number])
            first = found.candidates[0]
            others = np.array([one.normalised for one in found.candidates if one.category != thing])
            *shares, none = known.calibration.probabilities(others).tolist()
            yield (
                first.category == thing,
                found.label == thing,
                first.normalised,
                float(others.min()),
                max(first.probability, found.unknown),
                first.category == thing and first.probability >= found.unknown,
                max(*shares, none),
                none > max(shares),
                known.calibration.weights[-1],
            )


def report(title: str, rows: Sequence[tuple[float, ...]]) -> None:
    nearest, named, least, others, sure, right, alone, unknown, weight = np.array(rows, np.float64).T
    error = expected_calibration_error(np.concatenate([sure, alone]), np.concatenate([right, unknown]) > 0)
    share(f"{title}: nearest category right", int(nearest.sum()), len(nearest))
    share(f"{title}: named right", int(named.sum()), len(named))
    figure(f"{title}: AUROC of the unknown", auroc(least, others), "share")
    figure(f"{title}: calibration error", error, "share")
    print(
        f"{title:22}  {nearest.mean():7.3f}  {named.mean():5.3f}  {auroc(least, others):5.3f}  {error:17.3f}"
        f"  {np.median(weight):.2f}",
        flush=True,
    )


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        folder = data_folder(FOLDER)
        if folder is None:
            return
        views = views_of_tables(folder)
        print(f"{len(views)} views of {len(SAME)} things on {len({table for _, table, _ in views})} tables")
        print("way                     nearest  named  AUROC  calibration error  weight of the last")
        for title, way in WAYS.items():
            report(title, list(answers(views, way)))


if __name__ == "__main__":
    main()
