"""Settings of detection: the options, and the thresholds of each step.

Lengths are in metres, areas in square metres, angles in radians. Colour differences are those of CIE L*a*b* (Euclidean,
CIE76) with the lightness scaled by ``supervoxels.lightness_weight``. The values were chosen on the scenes 16, 34, 44,
46 and 50 of mosd-tabletop and on simulated formal settings (see ``docs/explanation/detection.md``).

The docstring of each threshold gives its unit, its reason, and evidence for its value. The evidence is the change in
the number of objects with another value, in scenes of mosd-tabletop ("mosd 44") or in formal settings laid with a seed
("simulated setting 3"); in ``JoiningSettings``, it is the change in the number of parts before the outline of the table
is used. Or it is a test of ``tests/perception/detection`` that fails with a tenth or ten times of the value. Some
thresholds have no evidence, and say so.

>>> from dataclasses import replace
>>> finer = replace(DetectionSettings(), supervoxels=SupervoxelSettings(min_spacing=0.005))
>>> finer.supervoxels.min_spacing, finer.joining == JoiningSettings()
(0.005, True)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from numbers import Integral, Real

import numpy as np

from deixis.perception.errors import CloudError


@dataclass(frozen=True, slots=True)
class _Thresholds:
    """Base of the thresholds: finite numbers of at least 0, integers of at least 1, and each max_ at least its min_."""

    def __post_init__(self) -> None:
        name = type(self).__name__
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < 0:
                raise CloudError(f"`{each.name}` of {name} must be a finite number of at least 0, got {value!r}")
            if isinstance(each.default, int) and not (isinstance(value, int) and value >= 1):
                raise CloudError(f"`{each.name}` of {name} must be a whole number of at least 1, got {value!r}")
            least = getattr(self, each.name.replace("max_", "min_", 1), value)
            if value < least:
                raise CloudError(
                    f"`{each.name}` of {name} must be at least the corresponding minimum, {least}, got {value!r}"
                )


@dataclass(frozen=True, slots=True)
class ScaleSettings(_Thresholds):
    """Plausible sizes of a scene, a table and a single object."""

    min_median_radius: float = 0.002
    """Metres. A cloud with half of its points nearer to its middle is refused, because its unit must be wrong. Tested
    by test_a_cloud_in_another_unit_is_refused_with_a_hint[0.001]."""
    max_median_radius: float = 20.0
    """Metres. A cloud with half of its points farther from its middle is refused, such as one in millimetres. A few far
    points do not count. No scene or test tried depends on it."""
    max_radius: float = 50.0
    """Metres from the middle of a cloud, along each axis, beyond which points are left out: depth cameras do not
    measure so far, and some write their largest number where they measure nothing. Tested by
    test_points_far_from_the_others_are_left_out_and_noted."""
    min_table_length: float = 0.3
    """Metres. A shorter surface is hardly a table: it gets a note, or is a single object. Tested by
    test_a_very_small_table_gets_a_note, test_a_surface_as_wide_as_a_table_is_not_one_object."""
    min_bare_table_length: float = 0.1
    """Metres. A shorter surface with nothing on it is not a table. No scene or test tried depends on it."""
    max_table_length: float = 6.0
    """Metres. A robot does not lay longer tables, so a note suggests a wrong unit. Tested by
    test_a_very_large_table_gets_a_note."""
    max_small_length: float = 0.4
    """Metres. A cloud that is shorter, and otherwise narrower than a table, is one object. Tested by
    test_a_small_cloud_is_one_object_without_a_table."""
    max_object_length: float = 1.2
    """Metres. A longer cloud is not a single object. Tested by test_the_kind_of_a_cloud_is_reported."""
    min_sheet_share: float = 0.7
    """Fraction of the points on one plane above which a cloud as wide as a table is a table: the faces of a box hold
    less. Tested by test_a_table_with_objects_only_at_its_edge_is_a_table."""
    min_whole_table_length: float = 0.48
    """Metres. A shorter surface that is wholly in view is an object, such as a tray or a board. Tested by
    test_a_flat_thing_without_a_table_is_one_object."""
    object_gap: float = 0.02
    """Metres. Cell size of the grid on which one object is connected. Tested by
    test_the_kind_of_a_cloud_is_reported."""
    min_connected_share: float = 0.85
    """Fraction of the points of one object that must be connected. Tested by test_the_kind_of_a_cloud_is_reported."""
    min_inset: float = 0.03
    """Metres from the outline of a face of an object to an object that stands on it. Tested by
    test_the_kind_of_a_cloud_is_reported."""
    min_inset_share: float = 0.3
    """Fraction of the points of a standing object that must be so far inside; an adjoining face has hardly any. Tested
    by test_the_kind_of_a_cloud_is_reported."""
    min_rim_share: float = 0.7
    """Area of a supposed object on a face relative to that of the face, above which it is the rim of the face, or its
    other side, as of a tray; also the share of the directions in which something rises at the outline of a tray. Tested
    by test_the_rim_of_a_tray_is_not_an_object_on_a_table, test_a_flat_thing_without_a_table_is_one_object."""
    min_table_share: float = 0.12
    """Fraction of the points that must be on the table or its objects; below it, the cloud shows a room. No scene or
    test tried depends on it."""
    min_room_width: float = 1.5
    """Metres. A cloud as wide along two axes, and without a table, shows a room. Tested by
    test_the_kind_of_a_cloud_is_reported."""
    min_floor_drop: float = 1.1
    """Metres from a floor up to the sensor, at least; from a table they are mostly less. No scene or test tried depends
    on it."""
    min_floor_length: float = 2.2
    """Metres of visible floor, at least. No scene or test tried depends on it."""
    outlier_percent: float = 0.5
    """Percent of the points at either end that do not count for the size of an object: outliers of the sensor. No scene
    or test tried depends on it."""


@dataclass(frozen=True, slots=True)
class PlaneSettings(_Thresholds):
    """Search for the plane of the table among others (RANSAC), and for other tables beside it."""

    sample_size: int = 10_000
    """Number of points in which planes are searched: enough for a table of a twentieth of the view, with bounded time.
    No scene or test tried depends on it."""
    refinement_size: int = 20_000
    """Number of points to which the plane of the table is fitted; more of them change it by less than the noise. No
    scene or test tried depends on it."""
    ransac_trials: int = 300
    """Number of triples of points for each plane. A plane with 15 % of the sample is found with a probability of 64 %,
    one with 25 % with 99 %. No scene or test tried depends on it."""
    tolerance: float = 0.01
    """Metres from a plane within which a point first counts as on it, at one metre from the sensor; it grows with the
    square of the distance, like the noise. Tested by test_a_noisy_plane_among_outliers_is_recovered."""
    max_noise_distance: float = 2.5
    """Metres up to which the noise grows; a cloud that seems farther away may have been moved. No scene or test tried
    depends on it."""
    max_planes: int = 5
    """Maximum number of planes: a table, a floor, walls, and large flat objects on the table. Tested by
    test_a_table_with_few_objects_is_preferred_to_a_larger_floor."""
    min_inlier_share: float = 0.04
    """Fraction of the points that the plane of a table must hold. No scene or test tried depends on it."""
    min_standing_height: float = 0.008
    """Minimum height in metres of a point that stands on a plane: more than noise, less than a plate. No scene or test
    tried depends on it."""
    max_standing_height: float = 0.35
    """Metres above a plane up to which a point stands on it: the height of a bottle. No scene or test tried depends on
    it."""
    outline_sides: int = 8
    """Number of directions in which a plane is measured for its outline, which has twice as many sides. No scene or
    test tried depends on it."""
    outline_inset: float = 0.01
    """Metres inside its outline at which points are above or below a plane: those nearer are often the edge of the
    table. Tested by test_the_edge_of_a_table_does_not_stand_on_its_underside."""
    below_ratio: float = 1.5
    """Tolerances below a plane at which a point is below it. No scene or test tried depends on it."""
    min_standing_share: float = 0.002
    """Fraction of all points that must stand on a plane that is not a floor: some objects, even few. Tested by
    test_a_table_with_few_objects_is_preferred_to_a_larger_floor, and
    test_an_empty_surface_or_a_floor_is_not_a_second_table."""
    floor_drop: float = 0.4
    """Metres from a table down to a floor, at least; a second table may be higher or lower by less. Tested by
    test_an_empty_surface_or_a_floor_is_not_a_second_table."""
    min_normal_cosine: float = 0.95
    """Cosine between the normals of two parallel planes, at least: 18 degrees. Tested by
    test_a_second_table_gets_a_note_and_can_be_used."""
    table_band: float = 0.01
    """Metres from the plane within which a point is on the table, inside its outline: the noise at two metres. No scene
    or test tried depends on it."""
    next_table_sample_size: int = 30_000
    """Number of points by which another table is judged. No scene or test tried depends on it."""


@dataclass(frozen=True, slots=True)
class ViewpointSettings(_Thresholds):
    """Check of the origin of a cloud as its viewpoint, and search for another viewpoint."""

    max_direction_change: float = 0.05
    """Maximum relative change between successive angles from pixel to pixel: 0.002 to 0.014 was measured from the true
    viewpoint, 0.3 and more from 30 cm beside it. Noise is along the rays from the true viewpoint, and across them from
    others. No scene or test tried depends on it."""
    image_lines: int = 40
    """Number of rows and columns of an image that are used: enough to fix directions to a hundredth of a degree. No
    scene or test tried depends on it."""
    image_steps: int = 80
    """Number of positions in each of these lines. No scene or test tried depends on it."""
    max_pinhole_misfit: float = 2.5
    """Pixels. Maximum misfit of the best camera for an image with noise across the rays, which makes the directions
    uneven: a millimetre at 80 cm makes 1.6 pixels. Tested by
    test_the_viewpoint_is_found_despite_noise_in_all_directions."""
    max_smooth_misfit: float = 0.8
    """Maximum ratio of that misfit in pixels to the relative change of directions: 0.45 was measured in noise, 1.2 to
    14 from a wrong place. Tested by test_the_viewpoint_is_found_despite_noise_in_all_directions."""
    pinhole_quantile: float = 0.95
    """Fraction of the points that must fit; objects on a table are at least the rest. No scene or test tried depends on
    it."""
    pinhole_sample_size: int = 2000
    """Number of points to which this camera is fitted. No scene or test tried depends on it."""
    sample_size: int = 10_000
    """Number of points of an unorganised cloud that are used. No scene or test tried depends on it."""
    neighbours: int = 8
    """Number of neighbours in direction that are compared, as many as a pixel has. No scene or test tried depends on
    it."""
    far_ratio: float = 3.0
    """Ratio of the distance of a far neighbour in direction to that of the farthest of as many nearest neighbours in
    space. Tested by test_neighbours_from_a_wrong_viewpoint_are_far_apart."""
    max_far_share: float = 0.05
    """Maximum fraction of far neighbours from the true viewpoint: 0.002 to 0.02 was measured there, 0.6 from a wrong
    one on the table. Tested by test_neighbours_from_a_wrong_viewpoint_are_far_apart."""
    doubtful_far_share: float = 0.022
    """Fraction of far neighbours above which another viewpoint with half of it is searched: 0.03 and more was measured
    in a cloud that combines two views. No scene or test tried depends on it."""
    min_eye_height: float = 0.05
    """Minimum height in metres of the camera above the table at which the table top is visible. No scene or test tried
    depends on it."""
    assumed_distance: float = 1.5
    """Metres from the middle of the table at which an unknown viewpoint is searched: the usual distance of cameras.
    Tested by test_a_cloud_with_a_wrong_origin_keeps_its_own_y_axis."""
    assumed_azimuths: int = 8
    """Number of positions around the table at which it is searched, besides the one straight above. Tested by
    test_a_cloud_with_a_wrong_origin_keeps_its_own_y_axis."""
    assumed_elevation: float = math.radians(45.0)
    """Radians above the table at which it is searched. Tested by
    test_a_cloud_with_a_wrong_origin_keeps_its_own_y_axis."""


@dataclass(frozen=True, slots=True)
class DensitySettings(_Thresholds):
    """Thinning of bare points that are far denser on some surfaces than on others."""

    sample_size: int = 3_000
    """Number of points around which the spacing is measured. No scene or test tried depends on it."""
    neighbours: int = 4
    """Number of nearest points that give the spacing: those beside a point of a grid. No scene or test tried depends on
    it."""
    max_spacing: float = 0.05
    """Metres. Points farther apart are not a surface on which objects can be seen. No scene or test tried depends on
    it."""
    dense_share: float = 0.1
    """Fraction of the points that must be as dense as the densest surface. No scene or test tried depends on it."""
    min_ratio: float = 6.0
    """Ratio of the usual spacing to that of the densest points above which they are thinned; a camera gives up to 3
    between directions. Tested by test_things_denser_than_their_table_are_found."""
    thinned_ratio: float = 4.0
    """Ratio of these spacings after thinning, at least. Tested by test_things_denser_than_their_table_are_found."""
    max_cell: float = 0.005
    """Metres. Maximum distance of thinned points, so that small objects keep enough of them. Tested by
    test_things_denser_than_their_table_are_found."""


@dataclass(frozen=True, slots=True)
class HeightSettings(_Thresholds):
    """Separation of points above the table from the noise of the sensor."""

    smoothing_rounds: int = 2
    """Number of rounds of averaging over neighbours: two cover about 5 by 5 pixels, and leave a tenth of the noise.
    Tested by test_a_strip_of_a_few_millimetres_is_kept_without_the_table[0.0014]."""
    upper_threshold: float = 4.5
    """Standard deviations of averaged heights above which a point is above the table: by chance, this is true of one in
    300,000 points. Tested by test_a_strip_of_a_few_millimetres_is_kept_without_the_table."""
    lower_threshold: float = 2.25
    """Standard deviations above which a point connected to such a point is above the table too (Canny's hysteresis). If
    doubled, mosd 44 and 54 have one object fewer each at half resolution."""
    noise_band: float = 0.006
    """Metres from the plane, at one metre from the sensor, within which noise is estimated: four times that of a
    Kinect. Tested by test_a_strip_of_a_few_millimetres_is_kept_without_the_table[0.0014]."""
    min_noise: float = 1e-4
    """Minimum noise in metres at one metre from the sensor, because tables are not perfectly flat. Tested by
    test_a_strip_of_a_few_millimetres_is_kept_without_the_table[0.0]."""
    min_noise_distance: float = 0.3
    """Metres from the sensor below which noise no longer decreases. No scene or test tried depends on it."""
    object_noise_ratio: float = 1.5
    """Minimum height of an object relative to the threshold for a point above the table, so that a ripple of noise is
    not an object. At a tenth of it, mosd 44 has two objects more at half resolution; at three times it, mosd 54 has one
    fewer."""
    object_quantile: float = 0.9
    """Quantile of the heights of an object that is compared: neither its lowest places nor its outliers count. At a
    third of it, simulated setting 0 loses three objects at half resolution."""
    min_share_above_table: float = 0.5
    """Fraction of the points of an object that must be above the outline of the table. No scene or test tried depends
    on it."""


@dataclass(frozen=True, slots=True)
class SurfaceSettings(_Thresholds):
    """Plane around each point, and its neighbours on the surface."""

    max_neighbour_ratio: float = 6.0
    """Maximum distance of a neighbour in an unorganised cloud, relative to the usual distance of the nearest points.
    Tested by test_an_image_without_its_order_gives_the_same_objects."""
    min_neighbours: int = 5
    """Minimum number of neighbours of a point, of eight. Tested by
    test_a_table_is_found_despite_missing_lines_of_the_image."""
    min_neighbours_share: float = 0.8
    """Fraction of the points that must have them; else neighbours are searched beyond the adjacent pixels, or in space
    instead of in direction. Tested by test_a_table_is_found_despite_missing_lines_of_the_image."""
    neighbour_sample_size: int = 10_000
    """Number of pixels whose neighbours are counted. No scene or test tried depends on it."""
    max_pixel_steps: int = 4
    """Pixels up to which neighbours are searched. Tested by
    test_a_table_is_found_despite_missing_lines_of_the_image."""
    radius_noise_ratio: float = 6.0
    """Radius of the plane around a point in standard deviations of its noise; in a smaller one, normals are mostly
    noise. If doubled, mosd 44 has three objects fewer at half resolution."""
    min_radius: float = 0.005
    """Minimum of that radius in metres: the handle of a fork is one to two centimetres wide. If doubled, mosd 44 and 54
    have one object fewer each at half resolution."""
    max_radius: float = 0.018
    """Maximum of that radius in metres: a larger plane rounds the edges of plates off. Halving or doubling it changes
    none of the scenes tried, which have less noise."""
    radius_spacing_ratio: float = 2.5
    """Minimum of that radius in distances between neighbours, so that a plane has enough points. If doubled, simulated
    setting 0 loses three objects at half resolution."""
    max_plane_points: int = 120
    """Maximum number of points to which a plane is fitted; it bounds the time for scattered points. No plane in the
    scenes of mosd, or in the simulated ones, has more; with 90, a tenth of those in a room with jitter have. Tested by
    test_scattered_depth_takes_seconds."""
    max_pixels_per_spacing: float = 1.5
    """Pixels of an image within one usual distance between neighbours: fewer on a surface that faces the sensor than on
    a slanted one. In the scenes of mosd, 99.6 % of the planes are those of the points within their radius."""
    min_jump: float = 0.006
    """Metres up to which neighbours are always on one surface. If doubled, mosd 16 has two objects fewer at half
    resolution."""
    jump_noise_ratio: float = 7.0
    """Standard deviations of the noise up to which two neighbours are on one surface. If doubled, mosd 44 has one
    object fewer at half resolution."""
    jump_spacing_ratio: float = 3.5
    """Usual distances between neighbours up to which two of them are on one surface: a surface seen at a flat angle, up
    to 73 degrees. If halved, mosd 34 has two objects more at half resolution; if doubled, mosd 16 has two fewer."""


@dataclass(frozen=True, slots=True)
class SupervoxelSettings(_Thresholds):
    """Patches of surface: the distance of their seeds, and the cost of a path from a seed."""

    spacing_noise_ratio: float = 8.0
    """Distance of seeds in standard deviations of the noise, so that the mean normal of a patch has little noise. If
    doubled, one more object falls apart in mosd 54 at half resolution."""
    min_spacing: float = 0.008
    """Minimum distance of seeds in metres: patches are narrower than a handle. If doubled, mosd 34 has one object too
    many at half resolution; docs/explanation/detection.md (Limits) says what less does."""
    max_spacing: float = 0.03
    """Maximum distance of seeds in metres, in strong noise: a cup still has several patches. Halving or doubling it
    changes none of the scenes tried, which have less noise."""
    spacing_neighbour_ratio: float = 4.5
    """Minimum distance of seeds in distances between neighbours, so that a patch has about twenty points. If doubled,
    simulated setting 0 has three objects too many at half resolution."""
    turn_cost: float = 1.5
    """Cost of a path for each radian by which the normal turns, in spacings of seeds, so that patches end at edges. If
    halved, mosd 44 has one object fewer at half resolution. Tested by
    test_surfaces_separate_in_a_valley_and_not_on_a_ridge."""
    step_cost: float = 400.0
    """Cost of a path for each metre of height between the planes of neighbours: a step of 2.5 mm costs one spacing. If
    halved, mosd 44 has one object fewer at half resolution; if doubled, two fewer."""
    colour_cost: float = 0.05
    """Cost of a path for a colour difference of 1: one of 20 costs one spacing. If doubled, mosd 44 has one object
    fewer at half resolution."""
    colour_noise: float = 2.0
    """Colour difference that noise alone causes, without cost. If doubled, mosd 44 has one object fewer at half
    resolution."""
    lightness_weight: float = 0.35
    """Weight of lightness in a colour difference: a shadow on one object mainly changes lightness. If doubled, one more
    object falls apart in mosd 54 and in simulated setting 0, at half resolution."""
    min_colour_height: float = 1e-4
    """Metres. Minimum weight of a point in a mean of colours, which is weighted by height because points at the border
    of a low object mix with those of the table. Any small number works: halving or doubling it changes no scene."""


@dataclass(frozen=True, slots=True)
class BoundarySettings(_Thresholds):
    """Evidence for two objects along the boundaries of patches, and the limit up to which regions are merged."""

    jump_evidence: float = 1.2
    """Evidence for two objects where the depth jumps; 1 is enough. If halved, mosd 44 has one object fewer at half
    resolution; if doubled, mosd 54 has two more."""
    max_evidence: float = 1.5
    """Maximum evidence of one place, so that it does not outweigh a long boundary. If halved, mosd 44 has one object
    fewer at half resolution."""
    step_noise_ratio: float = 2.5
    """Minimum size of a step in standard deviations of the noise. If doubled, mosd 16 has one object fewer at half
    resolution."""
    step_distance_ratio: float = 0.3
    """Minimum size of a step relative to the distance of patches, because coarse patches are not on one plane. If
    halved, mosd 54 has one object more at half resolution."""
    off_edge_share: float = 0.35
    """Tolerated difference between the distances of two patches from their common edge, relative to their sum. If
    doubled, mosd 54 has one object fewer at half resolution."""
    merge_limit: float = 0.6
    """Mean evidence along a boundary up to which regions are merged. If halved, mosd 54 has three objects more at half
    resolution; if doubled, simulated settings 0 and 3 lose two objects."""
    colour_delay: float = 0.3
    """Evidence by which the merging of regions of different colours is delayed: where a knife ends on the rim of a
    plate, only the colour separates the two. Tested by test_colour_decides_the_order_of_merges."""
    full_colour_difference: float = 6.0
    """Colour difference at which that delay is complete. Tested by test_colour_decides_the_order_of_merges."""


@dataclass(frozen=True, slots=True)
class JoiningSettings(_Thresholds):
    """Joining of parts of one object whose surfaces do not meet convexly."""

    fragment_area: float = 7e-4
    """Square metres. A smaller piece of surface that meets another is not an object of its own (2.6 cm square). If
    halved, mosd 44 has 5 parts more; if doubled, it has 3 fewer."""
    max_parts: int = 250
    """Maximum number of parts that are joined by more than their size, the largest ones: tables show less than a
    hundred, meaningless depth tens of thousands. Tested by test_scattered_depth_takes_seconds."""
    min_near_points: int = 10
    """Minimum number of points of a part that is joined to one that it does not meet; a smaller one is noise. No scene
    or test tried depends on it."""
    # Colour.
    max_same_colour: float = 9.0
    """Colour difference below which parts have the same colour. If halved, simulated setting 11 has three parts
    more."""
    min_other_colour: float = 12.0
    """Colour difference above which plain parts have different colours; between the two thresholds, colour decides
    nothing. If halved, simulated setting 0 has 8 parts more; if doubled, 8 fewer; see
    test_colours_differ_only_by_more_than_they_vary."""
    max_plain_variation: float = 7.0
    """Standard deviation up to which a part has one colour; the mean of a mottled one is not used. If halved, simulated
    setting 11 has three parts more; if doubled, mosd 44 has three fewer."""
    same_colour_evidence: float = 1.15
    """Evidence below which two parts of the same colour are one object; for two objects, more is needed. If halved,
    simulated setting 5 has three parts more."""
    resting_rise: float = 0.005
    """Metres. A part that is higher than another by so much, as a mean along their boundary, lies on it. If halved,
    simulated settings 2, 4 to 7, 9 and 10 have one part more each."""
    # Hollow things: the well of a plate, the inside of a cup.
    well_rise: float = 0.001
    """Metres by which a well may be above its rim along their boundary: noise of the mean. If tenfold, mosd 46 is
    divided otherwise."""
    well_top_tolerance: float = 0.005
    """Metres by which the top of a well may be higher than that of its rim. No scene or test tried depends on it."""
    max_well_bulge: float = 0.1
    """Maximum bulge of a well (1 is a sphere from outside); a part with more lies in the well. At 0, simulated settings
    3 and 7 have two parts more."""
    min_inside_share: float = 0.8
    """Fraction of a part that must be inside the outline of another: a well in its rim, a neck on its bottle. If
    halved, mosd 44 and 54 have one part fewer each; if doubled (never true), simulated setting 3 has five more."""
    inside_tolerance: float = 0.004
    """Metres beyond an outline that count as inside: half a patch. If halved, simulated setting 3 has one part more; if
    doubled, mosd 50 has one fewer."""
    min_cavity_depth: float = 0.03
    """Minimum height in metres of a hollow object seen from inside: cups have it, plates do not. If halved, simulated
    setting 5 has one part fewer; if doubled, mosd 34 and 54 have one more."""
    min_cavity_bend: float = 0.1
    """Minimum concavity of an inside (1 is a sphere from inside); a handle may be part of it. If tenfold, mosd 34 has
    two parts more, and simulated settings 0 to 7 one."""
    level_tolerance: float = 0.012
    """Maximum difference in height of two parts of one rim, in metres. At 0, mosd 34 has two parts more, and simulated
    settings 0 to 7 one."""
    max_lip_height: float = 0.02
    """Metres by which the inside of a jug may begin higher than what is visible of its outside below its lip."""
    min_below_lip_share: float = 0.3
    """Minimum fraction of the outside of a jug that is below the outline of its inside and lip."""
    # Shoulders that carry nothing: the lid of a pot, the neck of a jug.
    min_shoulder_normal: float = 0.15
    """Minimum vertical component of the normal of a shoulder: less is a wall, on whose rim something may lie."""
    max_shoulder_normal: float = 0.9
    """Maximum vertical component of the normal of a shoulder: things rest on a surface of less than 26 degrees."""
    min_shoulder_patches: int = 5
    """Minimum number of patches that show a shoulder; the normals of fewer are noise."""
    min_steep_share: float = 0.7
    """Minimum fraction of the patches below a part that are a shoulder."""
    min_touching_share: float = 0.4
    """Minimum fraction of the boundary of a part with a shoulder at which the depth does not jump."""
    # Partly covered objects: a plate below a knife or a napkin.
    covering_rise: float = 5e-4
    """Metres by which a part that lies on another is higher along their boundary. If doubled, mosd 50 has one part
    more."""
    max_hidden_gap: float = 0.11
    """Metres of a surface of one colour that an object on it may hide: a napkin on a plate. If doubled, simulated
    setting 2 has one part fewer."""
    hidden_gap_spread: float = 0.015
    """Metres. A hidden surface continues where its parts are nearest, or up to so much farther apart. If doubled, mosd
    40 has one part fewer, and mosd 50 one more."""
    coplanar_step: float = 0.004
    """Maximum distance in metres between the planes of two parts of one surface. If halved, mosd 24, 50 and 52 and
    simulated setting 9 have one part more each; if doubled, simulated setting 5 has one fewer."""
    coplanar_angle: float = math.radians(25.0)
    """Maximum angle in radians between their normals: 25 degrees. If halved, simulated settings 2 and 9 have one part
    more each; if doubled, mosd 54 has two fewer."""
    min_coplanar_share: float = 0.5
    """Fraction of the nearest patches of two parts that must lie in one plane. If halved, mosd 50 has two parts fewer;
    if doubled (never true), mosd 24 and 34 have two more."""
    min_covered_share: float = 0.5
    """Fraction of the places between two parts that the object on them must hide. If doubled (never true), mosd 24 and
    34 have two parts more."""
    rim_tolerance: float = 0.1
    """Maximum distance of the edge of a round rim from a circle, relative to its radius: patches are coarse. If
    tenfold, mosd 40 and 46 have two parts fewer."""
    min_rim_share: float = 0.5
    """Fraction of a round rim that two parts must show to be joined. If halved, mosd 40 has one part fewer."""
    # Glasses and bottles.
    foot_height: float = 0.022
    """Metres. Most of the foot of a glass is lower; the mean height of the glass is more than twice as much. If
    doubled, mosd 44 and 52 have one part more each."""
    stem_rise: float = 0.006
    """Metres by which a stem or a bowl that meets or hides a foot is higher. If halved, mosd 44 has one part fewer; if
    doubled, mosd 52 has one more."""
    foot_width_ratio: float = 1.2
    """Maximum width of a foot relative to that of the glass on it: a plate is wider. If halved, most simulated settings
    have one part more each: the foot of the glass."""
    min_foot_inside_share: float = 0.1
    """Fraction of a foot that must be below its glass; the rest may be visible beside it. If tenfold (never true),
    simulated settings 0 to 5 have one part more each."""
    min_below_bowl_share: float = 0.5
    """Fraction of a foot that must be below its glass if the two do not meet, so that something beside a glass whose
    foot is hidden is not its foot. Tested by test_a_bowl_joins_the_foot_below_it_without_a_stem."""
    bottle_slenderness: float = 1.2
    """Minimum ratio of height to width of a bottle, so that objects on cups are not necks. Tested by
    test_a_neck_joins_the_bottle_below_its_middle[a thing on a cup]."""
    neck_offset_ratio: float = 0.2
    """Maximum distance of a neck from the middle of its bottle, relative to the width of the bottle. Tested by
    test_a_neck_joins_the_bottle_below_its_middle[a thing on the edge of another]."""
    shoulder_depth: float = 0.02
    """Minimum distance in metres from the top of the body of a bottle down to its neck. No scene or test tried depends
    on it."""
    # Handles, necks and sides.
    attachment_ratio: float = 0.6
    """Maximum width and area of a handle or a neck, relative to those of its body. If halved, mosd 52 and 54 have one
    part more each; if doubled, mosd 48 has three fewer."""
    handle_clearance: float = 0.012
    """Metres by which a handle begins higher than its body; an object that stands beside it does not. Tested by
    test_a_raised_part_beside_an_object_is_its_handle; if doubled, mosd 54 has one part more."""
    max_handle_inside_share: float = 0.5
    """Maximum fraction of a handle inside the outline of its body; an object on the body has more. If halved, mosd 52
    has one part more; if doubled, mosd 54 has one fewer."""
    attachment_gap: float = 0.02
    """Metres from a handle or a side to its body as seen from above; its ends may be too thin to be seen. If halved,
    mosd 48 has two parts more; if doubled, mosd 46 has three fewer."""
    max_attachment_gap: float = 0.035
    """Metres from a handle or a spout to its body if the two meet in the image: the body hides its own far side, and
    one end of the handle."""
    max_sheet_normal: float = 0.5
    """Maximum vertical component of the normal of an upright part: 60 degrees and more. If halved, simulated setting 3
    has one part more; if doubled, simulated setting 5 has five fewer."""
    patch_width: float = 0.01
    """Metres. A narrower part counts as this wide, and as a sheet. If halved, mosd 50 has one part more; if doubled,
    mosd 34 has one more."""
    # Cutlery in two pieces.
    max_cutlery_height: float = 0.03
    """Maximum height of cutlery in metres. If halved, simulated settings 5 and 11 have one part more each; see
    test_the_head_of_a_spoon_joins_its_handle."""
    min_cutlery_slenderness: float = 3.0
    """Minimum ratio of length to width of two parts of cutlery together. If halved, mosd 44 has one part fewer; if
    doubled, mosd 34 has one more."""
    max_cutlery_length: float = 0.3
    """Metres. Two parts that are longer together are two pieces of cutlery in one line. Tested by
    test_two_forks_in_a_line_are_not_one_piece."""
    max_cutlery_width: float = 0.045
    """Metres between the middles of patches at either side: the bowl of a spoon is not wider. If halved, simulated
    settings 5 and 11 have one part more each; see test_the_head_of_a_spoon_joins_its_handle."""
    max_cutlery_gap: float = 0.03
    """Metres of the neck of a spoon that may be invisible. If halved, mosd 34 has one part more; if doubled, mosd 44
    has one fewer; see test_the_head_of_a_spoon_joins_its_handle."""
    end_overlap_share: float = 0.3
    """Maximum overlap of two parts in a line, as a fraction of the shorter one; others lie side by side. No scene or
    test tried depends on it."""
    resting_difference: float = 0.009
    """Metres. The lowest places of the head and handle of one piece of cutlery differ by less, however it is arched;
    those of cutlery on the rim of a plate and of cutlery beside the plate differ by more. If doubled, simulated
    settings 1 and 7 have one part fewer each; see test_two_pieces_in_a_line_join_if_their_heights_allow_it."""


@dataclass(frozen=True, slots=True)
class LyingSettings(_Thresholds):
    """Separation of thin things of another colour from the thing that they lie on."""

    min_core_points: int = 12
    """Minimum number of connected points that clearly have another colour than the rest of an object."""
    max_pieces: int = 20
    """Maximum number of such pieces of an object that are examined, the largest ones; an object with more is motley."""
    edge: float = 0.004
    """Metres around a piece in which the points may show both it and what is below."""
    reach: float = 0.025
    """Metres around a piece in which the surface below it is compared."""
    min_ring_points: int = 80
    """Minimum number of points that show this surface."""
    min_level_normal: float = 0.85
    """Minimum vertical component of the mean normal of this surface: on a steeper one, things slide off."""
    min_level_share: float = 0.5
    """Fraction of the points of an object that must be as level, for something to be looked for on it."""
    min_inside_share: float = 0.9
    """Fraction of a piece that must be within the outline of this surface, so that its height below the piece is not
    extrapolated. Of a piece that is seen beyond it, other evidence is found at its ends."""
    min_rise: float = 0.0015
    """Metres by which a piece is higher than the surface below it, as a mean; a print is not. Tested by
    test_a_raised_strip_of_another_colour_is_separated."""
    max_rise: float = 0.02
    """Maximum of that height in metres; the shape of a higher thing shows that it is another one."""
    rise_noise_ratio: float = 5.0
    """Minimum of that height in standard deviations of its mean."""
    correlated_points: float = 9.0
    """Number of adjacent points that share their noise."""


@dataclass(frozen=True, slots=True)
class TableTopSettings(_Thresholds):
    """Selection of the points on the top of the table, and of those above its outline."""

    max_cells: int = 80
    """Maximum number of cells along the longer side of the image in which the plane is searched: 1.5 cm at one
    metre."""
    min_cell_side: float = 4.0
    """Mean number of points along the side of a cell, at least, so that a cell of the table is rarely empty."""
    plan_cell: float = 0.03
    """Metres. Cell size of the grid that connects the points of a table with an unknown viewpoint: holes below objects
    are narrower. Tested by test_an_empty_surface_or_a_floor_is_not_a_second_table."""
    min_level_share: float = 0.25
    """Fraction of the points of a cell that must be level with the plane for it to show the table: noise leaves half of
    them at two and a half metres."""
    min_part_cells: int = 3
    """Minimum number of cells of a part of the table; a smaller one is noise."""
    max_covered_share: float = 0.8
    """Maximum fraction of a part with something right above it: it is less for a table, and all for a strip of a wall.
    Tested by test_a_strip_of_a_wall_is_not_a_part_of_the_table."""
    max_below_share: float = 0.1
    """Maximum fraction of a line between two parts of a table on which something lower is visible. Tested by
    test_a_pile_does_not_divide_a_table."""
    max_empty_share: float = 0.34
    """Maximum fraction of such a line on which nothing is visible: the shadow of the object that hides the rest. Tested
    by test_a_second_table_gets_a_note_and_can_be_used."""
    outline_sample_size: int = 30_000
    """Minimum number of points of a table at which its outline is computed. No scene or test tried depends on it."""
    slack: float = 0.02
    """Metres by which a point of an object may be beyond the outline of the table: objects reach over the edge. No
    scene or test tried depends on it."""
    margin: float = 0.3
    """Metres around the outline of the table that are searched for objects that reach over its edge. No scene or test
    tried depends on it."""


@dataclass(frozen=True, slots=True)
class OutlineSettings(_Thresholds):
    """Outlines of objects seen from above, and their boxes."""

    trim_share: float = 0.002
    """Fraction of the points at either end of an axis that count as noise. Tested by
    test_a_stray_point_in_a_thousand_does_not_stretch_a_box."""
    rim_tolerance: float = 0.05
    """Maximum distance of the edge of a round object from a circle, relative to its radius: noise, but not a corner.
    Tested by test_the_rim_of_a_plate_continues_behind_an_object."""
    min_rim_radius: float = 0.015
    """Metres. Of smaller objects, little is hidden. Tested by test_the_rim_of_a_plate_continues_behind_an_object."""
    max_rim_radius: float = 0.2
    """Metres. Larger circles are not tableware. Tested by test_the_rim_of_a_plate_continues_behind_an_object."""
    min_rim_sectors: int = 12
    """Minimum number of visible sectors of 36, adjacent except for gaps, that determine the rest of a circle. Tested by
    test_the_rim_of_a_plate_continues_behind_an_object."""
    rim_gap_sectors: int = 2
    """Maximum number of sectors of a gap between these: an object in front of the edge. Tested by
    test_the_rim_of_a_plate_continues_behind_an_object."""
    rim_inset: float = 0.01
    """Metres at the edge of a circle within which the table may be visible: noise at the border. Tested by
    test_a_rim_does_not_continue_over_the_visible_table."""
    bare_cell: float = 0.005
    """Metres. Cell size of the grid in which the visible table inside a circle is counted. Tested by
    test_a_rim_does_not_continue_over_the_visible_table."""
    bare_share: float = 0.03
    """Maximum fraction of the area of a circle in which the table may be visible, for outliers. Tested by
    test_a_rim_does_not_continue_over_the_visible_table."""


@dataclass(frozen=True, slots=True)
class NoteSettings(_Thresholds):
    """Conditions for notes about points that are not reported as objects."""

    group_cell: float = 0.02
    """Metres. Side of the cells of the grid on which left-out points are connected to groups. Tested by
    test_every_raised_group_is_reported_or_counted."""
    min_discarded_share: float = 0.05
    """Fraction of the points above the table in pieces too small or too low for objects, above which a note is given
    even if they are scattered. Tested by test_points_in_very_small_pieces_get_a_note."""
    overhang: float = 0.1
    """Minimum distance in metres beyond the outline of the table that a piece over its edge reaches. Tested by
    test_unreported_points_get_a_note."""
    min_overhang_points: int = 200
    """Minimum number of points beyond the edge of a piece that reaches over it. Tested by
    test_unreported_points_get_a_note."""
    min_overhang_share: float = 0.1
    """Fraction of such a piece that must be so far outside, and fraction that must be inside. Tested by
    test_unreported_points_get_a_note."""
    hole_cell: int = 8
    """Pixels along the side of a cell in which depth may be missing. Tested by test_unreported_points_get_a_note."""
    max_hole_share: float = 0.1
    """Maximum fraction of the cells of a table without depth; more give a note. Tested by
    test_unreported_points_get_a_note."""
    max_unfilled_share: float = 0.25
    """Maximum fraction of the pixels without depth in the usual cell of a table; in Kinect images, the usual cell is
    full. Tested by test_scattered_pixels_without_depth_get_a_note."""
    min_usual_length: float = 0.03
    """Minimum median length of the objects, in metres. Tested by test_unreported_points_get_a_note."""
    max_usual_length: float = 0.6
    """Maximum median length of the objects, in metres. Tested by test_unreported_points_get_a_note."""


@dataclass(frozen=True, slots=True)
class DetectionSettings:
    """Options and thresholds of detection.

    The defaults fit objects of a few millimetres to half a metre on a table, seen from half a metre to two metres.

    Parameters
    ----------
    seed
        Seed of the random samples.
    viewer
        Position of the person whose left and right are meant, in the frame of the cloud; None for the camera.
    up
        Up direction in the frame of the cloud, within 45 degrees, or None if it is unknown.
    frame
        Rows of a known transform (4, 4) from the frame of the cloud to that of the table, such as the one of an earlier
        cloud; origin and axes follow it as far as the plane allows, so that what lies still keeps its place. None for a
        frame from the view.
    table
        Number of the table to use, from 1 for the one with the most objects on it.
    height
        Minimum height of objects above the table, in metres.
    reach
        Maximum height above the table in which objects are searched, in metres.
    least_points, least_length
        Minimum number of points of an object, and its minimum length in metres.
    concavity, step
        Angle between two surfaces in radians, and height between them in metres, at which they are two objects.
    scale, density, plane, viewpoint, top, heights
        Thresholds of the steps that find the table.
    surface, supervoxels, boundaries, joining, lying, outlines, notes
        Thresholds of the steps that find the objects.
    """

    seed: int = 0
    viewer: tuple[float, float, float] | None = None
    up: tuple[float, float, float] | None = None
    frame: tuple[tuple[float, ...], ...] | None = None
    table: int = 1
    height: float = 0.002
    reach: float = 0.6
    least_points: int = 40
    least_length: float = 0.02
    concavity: float = math.radians(35.0)
    step: float = 0.0025
    scale: ScaleSettings = field(default_factory=ScaleSettings)
    density: DensitySettings = field(default_factory=DensitySettings)
    plane: PlaneSettings = field(default_factory=PlaneSettings)
    viewpoint: ViewpointSettings = field(default_factory=ViewpointSettings)
    top: TableTopSettings = field(default_factory=TableTopSettings)
    heights: HeightSettings = field(default_factory=HeightSettings)
    surface: SurfaceSettings = field(default_factory=SurfaceSettings)
    supervoxels: SupervoxelSettings = field(default_factory=SupervoxelSettings)
    boundaries: BoundarySettings = field(default_factory=BoundarySettings)
    joining: JoiningSettings = field(default_factory=JoiningSettings)
    lying: LyingSettings = field(default_factory=LyingSettings)
    outlines: OutlineSettings = field(default_factory=OutlineSettings)
    notes: NoteSettings = field(default_factory=NoteSettings)

    def __post_init__(self) -> None:
        for name in ("height", "reach", "least_length", "concavity", "step"):
            value = getattr(self, name)
            if not (_is_finite(value) and value > 0):
                raise CloudError(f"`{name}` must be a number above 0, got {value}")
        if not _is_whole(self.seed) or self.seed < 0:
            raise CloudError(f"`seed` must be a whole number of at least 0, got {self.seed}")
        if not _is_whole(self.table) or self.table < 1:
            raise CloudError(f"`table` must be a whole number of at least 1, got {self.table}")
        if not _is_whole(self.least_points) or self.least_points < 1:
            raise CloudError(f"`least_points` must be a whole number of at least 1, got {self.least_points}")
        for name in ("viewer", "up"):
            vector = getattr(self, name)
            if vector is not None and not (
                hasattr(vector, "__len__") and len(vector) == 3 and all(map(_is_finite, vector))
            ):
                raise CloudError(f"`{name}` must be three finite numbers, got {vector}")
        if self.frame is not None and not (
            np.shape(self.frame) == (4, 4) and np.isfinite(np.array(self.frame, dtype=np.float64)).all()
        ):
            raise CloudError(f"`frame` must be four rows of four finite numbers, got {self.frame!r:.80}")
        if self.up is not None and not any(self.up):
            raise CloudError("`up` must have a length above 0, got (0, 0, 0); give a direction such as 0 0 1")
        for each in fields(self):
            group = each.default_factory
            if isinstance(group, type) and not isinstance(getattr(self, each.name), group):
                raise CloudError(f"`{each.name}` must be {group.__name__}, got {getattr(self, each.name)!r}")


def _is_finite(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _is_whole(value: object) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)
