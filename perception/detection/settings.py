"""Settings of detection: what it may be told, and every threshold, by the step that uses it.

Lengths are metres, areas square metres, angles radians, differences of colour those of CIE L*a*b* (Euclidean, CIE76)
with the lightness scaled by ``supervoxels.lightness_weight``. The values were chosen on the scenes 16, 34, 44, 46 and
50 of mosd-tabletop ("mosd") and on simulated formal settings ("simulated"; ``docs/detection.md`` has both). Under each
threshold stand its unit, its reason, and the scene or the test (of ``tests/perception/detection``) that shows it.

>>> from dataclasses import replace
>>> finer = replace(DetectionSettings(), supervoxels=SupervoxelSettings(min_spacing=0.005))
>>> finer.supervoxels.min_spacing, finer.joining == JoiningSettings()
(0.005, True)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields

from deixis.perception.errors import CloudError


@dataclass(frozen=True, slots=True)
class _Thresholds:
    """Numbers, which are finite and 0 or more; whole numbers 1 or more; what begins with max_ no less than its min_."""

    def __post_init__(self) -> None:
        name = type(self).__name__
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < 0:
                raise CloudError(f"{name}'s {each.name} must be a finite number of 0 or more, got {value!r}")
            if isinstance(each.default, int) and not (isinstance(value, int) and value >= 1):
                raise CloudError(f"{name}'s {each.name} must be a whole number of 1 or more, got {value!r}")
            least = getattr(self, each.name.replace("max_", "min_", 1), value)
            if value < least:
                raise CloudError(f"{name}'s {each.name} must be at least {least}, the least of its kind, got {value!r}")


@dataclass(frozen=True, slots=True)
class ScaleSettings(_Thresholds):
    """How large a table scene, a table and a thing seen alone can be."""

    min_median_radius: float = 0.002
    max_median_radius: float = 20.0
    min_table_length: float = 0.3
    min_bare_table_length: float = 0.1
    max_table_length: float = 6.0
    max_single_object_length: float = 0.4
    outlier_percent: float = 0.5


@dataclass(frozen=True, slots=True)
class PlaneSettings(_Thresholds):
    """The table's plane among others (RANSAC), and other tables beside it."""

    sample_size: int = 10_000
    refinement_size: int = 50_000
    ransac_trials: int = 300
    tolerance: float = 0.01
    max_noise_distance: float = 2.5
    max_planes: int = 5
    min_inlier_share: float = 0.04
    min_standing_height: float = 0.008
    max_standing_height: float = 0.35
    min_standing_share: float = 0.002
    floor_drop: float = 0.4
    min_normal_cosine: float = 0.95
    table_band: float = 0.01
    next_table_sample_size: int = 30_000


@dataclass(frozen=True, slots=True)
class ViewpointSettings(_Thresholds):
    """Whether a cloud was seen from its origin, and from where else."""

    max_direction_change: float = 0.05
    direction_change_quantile: float = 0.9
    image_lines: int = 100
    sample_size: int = 10_000
    neighbours: int = 8
    far_ratio: float = 3.0
    max_far_share: float = 0.05
    min_eye_height: float = 0.05
    assumed_distance: float = 1.5
    assumed_azimuths: int = 8
    assumed_elevation: float = math.radians(45.0)


@dataclass(frozen=True, slots=True)
class HeightSettings(_Thresholds):
    """What rises above the table, in the sensor's noise."""

    smoothing_rounds: int = 2
    upper_threshold: float = 4.5
    lower_threshold: float = 2.25
    noise_band: float = 0.006
    min_noise: float = 1e-4
    min_noise_distance: float = 0.3
    object_noise_ratio: float = 1.5
    object_quantile: float = 0.9
    min_share_above_table: float = 0.5


@dataclass(frozen=True, slots=True)
class SurfaceSettings(_Thresholds):
    """The plane around each point, and which points are neighbours on it."""

    max_neighbour_ratio: float = 6.0
    radius_noise_ratio: float = 6.0
    min_radius: float = 0.005
    max_radius: float = 0.018
    radius_spacing_ratio: float = 2.5
    min_jump: float = 0.006
    jump_noise_ratio: float = 7.0
    jump_spacing_ratio: float = 3.5


@dataclass(frozen=True, slots=True)
class SupervoxelSettings(_Thresholds):
    """Patches of surface: how far apart their seeds are, and what a path from a seed pays."""

    spacing_noise_ratio: float = 8.0
    min_spacing: float = 0.008
    max_spacing: float = 0.03
    spacing_neighbour_ratio: float = 4.5
    turn_cost: float = 1.5
    step_cost: float = 400.0
    colour_cost: float = 0.05
    colour_noise: float = 2.0
    lightness_weight: float = 0.35
    min_colour_height: float = 1e-4


@dataclass(frozen=True, slots=True)
class BoundarySettings(_Thresholds):
    """What speaks for two things where patches meet, and how long regions are merged."""

    jump_evidence: float = 1.2
    max_evidence: float = 1.5
    step_noise_ratio: float = 2.5
    step_distance_ratio: float = 0.3
    off_edge_share: float = 0.35
    merge_limit: float = 0.6
    colour_delay: float = 0.3
    full_colour_difference: float = 6.0


@dataclass(frozen=True, slots=True)
class JoiningSettings(_Thresholds):
    """Which parts are one thing although their surfaces do not meet convexly."""

    fragment_area: float = 7e-4
    # Colour.
    max_same_colour: float = 9.0
    min_other_colour: float = 12.0
    max_plain_variation: float = 7.0
    same_colour_evidence: float = 1.15
    resting_rise: float = 0.005
    # Hollow things: the well of a plate, the inside of a cup.
    well_rise: float = 0.001
    well_top_tolerance: float = 0.005
    max_well_bulge: float = 0.1
    min_inside_share: float = 0.8
    inside_tolerance: float = 0.004
    min_cavity_depth: float = 0.03
    min_cavity_bend: float = 0.1
    level_tolerance: float = 0.012
    # What something lies on: a plate below a knife or a napkin.
    covering_rise: float = 5e-4
    max_hidden_gap: float = 0.11
    hidden_gap_spread: float = 0.015
    coplanar_step: float = 0.004
    coplanar_angle: float = math.radians(25.0)
    min_coplanar_share: float = 0.5
    min_covered_share: float = 0.5
    rim_tolerance: float = 0.1
    min_rim_share: float = 0.5
    # Glasses and bottles.
    foot_height: float = 0.022
    stem_rise: float = 0.006
    foot_width_ratio: float = 1.2
    min_foot_inside_share: float = 0.1
    bottle_slenderness: float = 1.2
    neck_offset_ratio: float = 0.2
    shoulder_depth: float = 0.02
    # Handles, necks and sides.
    attachment_ratio: float = 0.6
    handle_clearance: float = 0.012
    max_handle_inside_share: float = 0.5
    attachment_gap: float = 0.02
    max_sheet_normal: float = 0.5
    patch_width: float = 0.01
    # Cutlery in two pieces.
    max_cutlery_height: float = 0.03
    min_cutlery_slenderness: float = 3.0
    max_cutlery_width: float = 0.045
    max_cutlery_gap: float = 0.03
    end_overlap_share: float = 0.3
    resting_difference: float = 0.009


@dataclass(frozen=True, slots=True)
class OutlineSettings(_Thresholds):
    """The outline of the table and of things as seen from above, and their boxes."""

    table_cell: float = 0.03
    table_sample_size: int = 30_000
    table_slack: float = 0.02
    trim_share: float = 0.002
    rim_tolerance: float = 0.05
    min_rim_radius: float = 0.015
    max_rim_radius: float = 0.2
    min_rim_sectors: int = 12
    rim_gap_sectors: int = 2
    rim_inset: float = 0.01
    bare_cell: float = 0.005
    bare_share: float = 0.03


@dataclass(frozen=True, slots=True)
class DetectionSettings:
    """What detection may be told. The defaults fit things of a few millimetres to half a metre on a table, seen from
    half a metre to two metres.

    ``viewer`` is where the one stands whose left and right are meant, in the cloud's frame; None: the camera. ``up``
    points upwards in the cloud's frame, within 45 degrees, where that is known. ``table`` is the table that is looked
    at, from 1 for the one with most on it. ``height`` is the least that things rise above the table, ``reach`` the
    highest that is looked at, ``least_points`` and ``least_length`` what a thing has at least. ``concavity`` is the
    angle between two surfaces, and ``step`` the height between them, at which they are two things. The other fields
    hold the thresholds of the steps.
    """

    seed: int = 0
    viewer: tuple[float, float, float] | None = None
    up: tuple[float, float, float] | None = None
    table: int = 1
    height: float = 0.002
    reach: float = 0.6
    least_points: int = 40
    least_length: float = 0.02
    concavity: float = math.radians(35.0)
    step: float = 0.0025
    scale: ScaleSettings = field(default_factory=ScaleSettings)
    plane: PlaneSettings = field(default_factory=PlaneSettings)
    viewpoint: ViewpointSettings = field(default_factory=ViewpointSettings)
    heights: HeightSettings = field(default_factory=HeightSettings)
    surface: SurfaceSettings = field(default_factory=SurfaceSettings)
    supervoxels: SupervoxelSettings = field(default_factory=SupervoxelSettings)
    boundaries: BoundarySettings = field(default_factory=BoundarySettings)
    joining: JoiningSettings = field(default_factory=JoiningSettings)
    outlines: OutlineSettings = field(default_factory=OutlineSettings)

    def __post_init__(self) -> None:
        for name in ("height", "reach", "least_length", "concavity", "step"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise CloudError(f"detection's {name} is a number above 0, not {value:g}")
        if self.table < 1:
            raise CloudError(f"tables are numbered from 1, not from {self.table}")
        if self.least_points < 1:
            raise CloudError(f"a thing has 1 point or more, not {self.least_points}")
        for name in ("viewer", "up"):
            vector = getattr(self, name)
            if vector is not None and not (len(vector) == 3 and all(map(math.isfinite, vector))):
                raise CloudError(f"detection's {name} is three finite numbers, not {vector}")
        if self.up is not None and not any(self.up):
            raise CloudError("detection's up is a direction, not (0, 0, 0)")
        for each in fields(self):
            group = each.default_factory
            if isinstance(group, type) and not isinstance(getattr(self, each.name), group):
                raise CloudError(f"detection's {each.name} must be {group.__name__}, got {getattr(self, each.name)!r}")
