"""Record a laid table with a simulated depth camera, with the ground truth."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.grammar.read import read_script_file
from deixis.grammar.script import Script
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.scene import Scene
from deixis.perception.simulator.cameras.camera import HEIGHT, KINECT, Camera, chair_camera, check_place
from deixis.perception.simulator.cameras.depth import FIRST_THING, DepthSensor, see
from deixis.perception.simulator.laying import truth_scene
from deixis.workflows.layouts.lay_table import LaidScript, lay_script, require_seed


@dataclass(frozen=True, slots=True)
class CameraSetup:
    """Position and noise of the camera that looks at a table; lengths in metres, the azimuth in radians.

    Raises SimulationError for an impossible position, before the table is laid.
    """

    height: float = HEIGHT
    back: float = 0.0
    azimuth: float = 0.0
    lens: Intrinsics = KINECT
    sensor: DepthSensor = field(default_factory=DepthSensor)

    def __post_init__(self) -> None:
        check_place(self.height, self.back, self.azimuth)


@dataclass(frozen=True, eq=False, repr=False)
class Simulation(Answer):
    """Recording of a laid table. ``cloud`` is in the camera's frame, ``truth`` in the table's.

    A point's label is 0 for the table, k for the thing ``o{k}`` of the truth, -1 where nothing was measured.

    Attributes
    ----------
    laid
        The laid table.
    camera
        The camera with its pose.
    cloud
        The measured points, in metres.
    truth
        The true scene.
    view
        From where the table was looked at, and how well.
    seed
        Seed of the noise.

    Examples
    --------
    >>> import deixis
    >>> look = deixis.simulate(deixis.read_script(text="fork left of plate"), seed=1)
    >>> look.summary().split(", ")[0], len(look.cloud)
    ('2 things', 307200)
    >>> [(thing["name"], thing["label"]) for thing in look.to_dict()["things"]]
    [('fork', 1), ('plate', 2)]
    >>> bool((look.points > 100).all())
    True
    """

    laid: LaidScript
    camera: Camera
    cloud: PointCloud
    truth: Scene
    view: CameraSetup
    seed: int

    @property
    def points(self) -> NDArray[np.int64]:
        """Number of points of each thing, in the order of the truth, shape (n,)."""
        assert self.cloud.labels is not None
        counts: NDArray[np.int64] = np.bincount(self.cloud.labels + 1, minlength=len(self.truth.objects) + 2)
        return counts[1 + FIRST_THING :]

    def summary(self) -> str:
        """Return the numbers of things and points."""
        measured = int(self.cloud.finite.sum())
        return f"{count(len(self.truth.objects), 'thing')}, {measured} of {len(self.cloud)} points measured"


@checks_arguments
def simulate(layout: LaidScript | Script | str | Path, view: CameraSetup | None = None, seed: int = 0) -> Simulation:
    """Lay a table as a script says, and look at it with a simulated depth camera.

    The same seed gives the same cloud.

    Parameters
    ----------
    layout
        A table that is laid already, a script, or its file.
    view
        Camera and sensor; default: a Kinect.
    seed
        Seed of the sizes, the places and the noise.

    Returns
    -------
    Simulation
        The cloud in the camera's frame, in metres, with the true scene.

    Raises
    ------
    NoTableError
        If no table satisfies the script.
    SimulationError
        If the camera or the seed is invalid.

    Examples
    --------
    >>> import deixis
    >>> look = simulate(deixis.read_script(text="fork left of plate"), seed=1)
    >>> look.cloud.organised, [thing.label for thing in look.truth.objects], bool((look.points > 100).all())
    ((480, 640), ['fork', 'plate'], True)
    """
    require_seed(seed)
    view = view or CameraSetup()
    if isinstance(layout, LaidScript):
        laid = layout
    else:
        laid = lay_script(layout if isinstance(layout, Script) else read_script_file(str(layout)), seed)
    camera = chair_camera(laid.table, view.height, view.back, view.azimuth, view.lens)
    cloud = see(laid.table, camera, view.sensor, seed)
    return Simulation(laid, camera, cloud, truth_scene(laid.table, laid.viewpoint), view, seed)
