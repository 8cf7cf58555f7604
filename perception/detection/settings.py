"""Settings of detection: what it may be told, and every threshold, by the step that uses it.

Lengths are metres, areas square metres, angles radians, differences of colour those of CIE L*a*b* (Euclidean, CIE76)
with the lightness scaled by ``supervoxels.lightness_weight``. The values were chosen on the scenes 16, 34, 44, 46 and
50 of mosd-tabletop and on simulated formal settings (``docs/explanation/detection.md`` has both).

Under each threshold stand its unit, its reason, and what shows it: how many things, or in ``JoiningSettings`` parts
before the table's outline is looked at, there are with another value in scenes of mosd-tabletop ("mosd 44") or in
formal settings laid with a seed ("simulated setting 3"); or the test (of ``tests/perception/detection``) that fails
with a tenth or ten times of it. Where neither shows it, that is said.

>>> from dataclasses import replace
>>> finer = replace(DetectionSettings(), supervoxels=SupervoxelSettings(min_spacing=0.005))
>>> finer.supervoxels.min_spacing, finer.joining == JoiningSettings()
(0.005, True)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from numbers import Integral, Real

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
    """Metres: half of a cloud nearer to its middle is refused, as its unit is another. Shown by
    test_a_cloud_in_another_unit_is_refused_with_a_hint[0.001]."""
    max_median_radius: float = 20.0
    """Metres: half of a cloud farther from its middle is refused, as millimetres are. A few far points do not count.
    No scene or test tried shows it."""
    min_table_length: float = 0.3
    """Metres: what is shorter in both directions is hardly a table: a note, or one thing alone. Shown by
    test_a_table_too_small_for_one_is_noted, test_what_is_as_wide_as_a_table_is_no_thing_alone."""
    min_bare_table_length: float = 0.1
    """Metres: what is taken for a table, is shorter and has nothing on it, is none. No scene or test tried shows it."""
    max_table_length: float = 6.0
    """Metres: nothing that a robot lays is longer: a note doubts the unit. Shown by
    test_a_table_that_no_robot_lays_is_noted."""
    max_small_length: float = 0.4
    """Metres: a cloud that is no longer, and otherwise narrower than a table, is one object. Shown by
    test_a_cloud_no_larger_than_a_thing_is_one_thing_without_a_table."""
    max_object_length: float = 1.2
    """Metres: a longer cloud is no object that is seen alone. Shown by test_what_a_cloud_shows_is_told."""
    max_sheet_thickness: float = 0.03
    """Metres: what is thinner and as wide as a table is a bare table. Shown by test_what_a_cloud_shows_is_told."""
    object_gap: float = 0.02
    """Metres of the grid on which one object is connected. Shown by test_what_a_cloud_shows_is_told."""
    min_connected_share: float = 0.85
    """Share of the points of one object that are connected. Shown by test_what_a_cloud_shows_is_told."""
    min_inset: float = 0.03
    """Metres from the outline of a face of an object to what stands on it. Shown by test_what_a_cloud_shows_is_told."""
    min_inset_share: float = 0.3
    """Share of the points of what stands there that are so far inside: an adjoining face has hardly any. Shown by
    test_what_a_cloud_shows_is_told."""
    min_rim_share: float = 0.7
    """Area of what seems to stand on a face by that of the face, from which it is its rim, or that of the face upside
    down, as of a tray. Shown by test_the_rim_of_a_tray_is_no_thing_on_a_table."""
    min_table_share: float = 0.12
    """Share of what is seen that is on the table or stands there, else it is a room. No scene or test tried shows
    it."""
    min_room_width: float = 1.5
    """Metres: what is as large along two axes, and shows no table, is a room. Shown by
    test_what_a_cloud_shows_is_told."""
    min_floor_drop: float = 1.1
    """Metres that a sensor is above a floor at least: above a table it is mostly less. No scene or test tried shows
    it."""
    min_floor_length: float = 2.2
    """Metres that are seen of a floor at least. No scene or test tried shows it."""
    outlier_percent: float = 0.5
    """Percent of the points at either end that say nothing of how large a thing is: strays of a sensor. No scene or
    test tried shows it."""


@dataclass(frozen=True, slots=True)
class PlaneSettings(_Thresholds):
    """The table's plane among others (RANSAC), and other tables beside it."""

    sample_size: int = 10_000
    """Points that planes are looked for among: enough for a table of a twentieth of the view, and it bounds the time.
    No scene or test tried shows it."""
    refinement_size: int = 20_000
    """Points that the table's plane is fitted to: more of them change it by less than noise does. No scene or test
    tried shows it."""
    ransac_trials: int = 300
    """Triples of points that are tried for each plane: one that holds 15 % of the sample is met with 64 %, one of 25 %
    with 99 %. No scene or test tried shows it."""
    tolerance: float = 0.01
    """Metres within which a point lies on a plane at first, at one metre from the sensor; it grows with the square of
    the distance, as noise does. Shown by test_a_noisy_plane_among_outliers_is_recovered."""
    max_noise_distance: float = 2.5
    """Metres up to which noise is reckoned with: what seems farther may have been moved. No scene or test tried shows
    it."""
    max_planes: int = 5
    """Planes that are taken out: a table, a floor, walls and what is large and flat on the table. Shown by
    test_a_table_with_little_on_it_is_preferred_to_a_much_larger_floor_with_a_wall_on_it."""
    min_inlier_share: float = 0.04
    """Share of the points that a plane holds at least, to be the table's. No scene or test tried shows it."""
    min_standing_height: float = 0.008
    """Metres above a plane from which a point stands on it: more than noise, less than a plate. No scene or test tried
    shows it."""
    max_standing_height: float = 0.35
    """Metres above a plane up to which a point stands on it: as high as a bottle. No scene or test tried shows it."""
    min_standing_share: float = 0.002
    """Share of all points that stand on what is no floor: some things, even few. Shown by
    test_a_table_with_little_on_it_is_preferred_to_a_much_larger_floor_with_a_wall_on_it, and
    test_what_is_bare_or_as_low_as_a_floor_is_no_second_table."""
    floor_drop: float = 0.4
    """Metres that a floor lies below a table at least, so that a second table may be higher or lower by less. Shown by
    test_what_is_bare_or_as_low_as_a_floor_is_no_second_table."""
    min_normal_cosine: float = 0.95
    """Cosine between the normals of two planes that are equally level: 18 degrees. Shown by
    test_a_second_table_is_told_of_and_can_be_looked_at."""
    table_band: float = 0.01
    """Metres from the plane within which a point is the table's, as far as its outline goes: the noise at two metres.
    No scene or test tried shows it."""
    next_table_sample_size: int = 30_000
    """Points by which another table is judged. No scene or test tried shows it."""


@dataclass(frozen=True, slots=True)
class ViewpointSettings(_Thresholds):
    """Whether a cloud was seen from its origin, and from where else."""

    max_direction_change: float = 0.05
    """Share by which the angle from pixel to pixel changes to the next, at most: 0.002 to 0.014 was measured from where
    images were taken, 0.3 and more from 30 cm beside it. Noise is along the rays, and from elsewhere across. No scene
    or test tried shows it."""
    image_lines: int = 40
    """Rows and columns of an image that are looked at: so many settle directions to a hundredth of a degree. No scene
    or test tried shows it."""
    image_steps: int = 80
    """Places in each of these that are looked at. No scene or test tried shows it."""
    max_pinhole_misfit: float = 2.5
    """Pixels by which points of an image are off, seen by the camera that fits best, where noise across the rays makes
    the directions uneven: a millimetre at 80 cm makes 1.6 of it. Shown by
    test_noise_in_all_directions_hides_no_viewpoint."""
    max_smooth_misfit: float = 0.8
    """Pixels of that misfit by the share by which directions change from pixel to pixel: 0.45 was measured in noise,
    1.2 to 14 from a wrong place. Shown by test_noise_in_all_directions_hides_no_viewpoint."""
    pinhole_quantile: float = 0.95
    """Share of the points for which that holds: what stands on a table is at least the rest of them. No scene or test
    tried shows it."""
    pinhole_sample_size: int = 2000
    """Points that this camera is fitted to. No scene or test tried shows it."""
    sample_size: int = 10_000
    """Points of a cloud that is no image that are looked at. No scene or test tried shows it."""
    neighbours: int = 8
    """Neighbours in direction that are looked at, as many as a pixel has. No scene or test tried shows it."""
    far_ratio: float = 3.0
    """A neighbour in direction is far if so many times as far away as the farthest of as many nearest in space. Shown
    by test_points_seen_from_elsewhere_have_neighbours_that_are_apart."""
    max_far_share: float = 0.05
    """Share of such neighbours in one view: 0.002 to 0.02 was measured from the right place, 0.6 from a wrong one on
    the table. Shown by test_points_seen_from_elsewhere_have_neighbours_that_are_apart."""
    doubtful_far_share: float = 0.022
    """Share from which another place is looked for that has half of it: 0.03 and more was measured where one cloud
    holds looks from two places. No scene or test tried shows it."""
    min_eye_height: float = 0.05
    """Metres above the table from which its top is seen at all. No scene or test tried shows it."""
    assumed_distance: float = 1.5
    """Metres from the middle of the table at which an unknown viewpoint is looked for: as far as cameras stand. Shown
    by test_a_cloud_whose_origin_is_no_viewpoint_keeps_its_own_y_axis."""
    assumed_azimuths: int = 8
    """Places around the table at which it is looked for, beside the one straight above. Shown by
    test_a_cloud_whose_origin_is_no_viewpoint_keeps_its_own_y_axis."""
    assumed_elevation: float = math.radians(45.0)
    """Radians above the table at which it is looked for. Shown by
    test_a_cloud_whose_origin_is_no_viewpoint_keeps_its_own_y_axis."""


@dataclass(frozen=True, slots=True)
class HeightSettings(_Thresholds):
    """What rises above the table, in the sensor's noise."""

    smoothing_rounds: int = 2
    """Rounds of averaging over neighbours: two are about 5 by 5 pixels, and leave a tenth of the noise. Shown by
    test_a_strip_of_a_few_millimetres_survives_and_the_table_does_not[0.0014]."""
    upper_threshold: float = 4.5
    """Standard deviations of averaged heights above which a point is surely no table: of 300,000 points, one is by
    chance. Shown by test_a_strip_of_a_few_millimetres_survives_and_the_table_does_not."""
    lower_threshold: float = 2.25
    """Standard deviations above which a point is no table where it is connected with such a one (Canny's hysteresis).
    Doubled, mosd 44 and 54 have a thing fewer at half resolution."""
    noise_band: float = 0.006
    """Metres from the plane, at one metre from the sensor, within which noise is estimated: four times a Kinect's.
    Shown by test_a_strip_of_a_few_millimetres_survives_and_the_table_does_not[0.0014]."""
    min_noise: float = 1e-4
    """Metres at one metre from the sensor: less noise is not reckoned with, since no table is so flat. Shown by
    test_a_strip_of_a_few_millimetres_survives_and_the_table_does_not[0.0]."""
    min_noise_distance: float = 0.3
    """Metres: nearer to the sensor, noise becomes no less. No scene or test tried shows it."""
    object_noise_ratio: float = 1.5
    """How often a thing is as high as what may be taken for a point above the table: a ripple of noise is not. A tenth
    of it, mosd 44 has two things more at half resolution; three times it, mosd 54 has one fewer."""
    object_quantile: float = 0.9
    """Quantile of a thing's heights that is compared: neither its lowest places nor its stray points count. At a third
    of it, simulated setting 0 loses three things at half resolution."""
    min_share_above_table: float = 0.5
    """Share of a thing's points above the outline of the table: what is beside the table is none of its things. No
    scene or test tried shows it."""


@dataclass(frozen=True, slots=True)
class SurfaceSettings(_Thresholds):
    """The plane around each point, and which points are neighbours on it."""

    max_neighbour_ratio: float = 6.0
    """Points of a cloud that is no image are no neighbours beyond so many times the usual distance of the nearest.
    Shown by test_without_its_order_an_image_shows_the_same_things."""
    min_neighbours: int = 5
    """Neighbours that a point has at least, of eight. Shown by
    test_a_table_is_seen_though_lines_of_the_image_are_missing."""
    min_neighbours_share: float = 0.8
    """Share of the points that have them; else neighbours are looked for beyond the pixels around, or nearest in space
    instead of in direction. Shown by test_a_table_is_seen_though_lines_of_the_image_are_missing."""
    neighbour_sample_size: int = 10_000
    """Pixels of which these are counted. No scene or test tried shows it."""
    max_pixel_steps: int = 4
    """Pixels up to which they are looked for. Shown by
    test_a_table_is_seen_though_lines_of_the_image_are_missing."""
    radius_noise_ratio: float = 6.0
    """Radius of the plane around a point in standard deviations of its noise: with fewer normals are mostly noise.
    Doubled, mosd 44 has three things fewer at half resolution."""
    min_radius: float = 0.005
    """Metres of that radius at least: a fork's handle is one to two centimetres wide. Doubled, mosd 44 and 54 have a
    thing fewer at half resolution."""
    max_radius: float = 0.018
    """Metres of that radius at most: a larger plane rounds the edges of plates off. Halving or doubling it changes none
    of the scenes tried, which have less noise."""
    radius_spacing_ratio: float = 2.5
    """That radius in distances between neighbours at least, so that a plane has points enough. Doubled, simulated
    setting 0 loses three things at half resolution."""
    max_plane_points: int = 250
    """Points that a plane is laid through at most: it bounds the time where points are scattered. Shown by
    test_scattered_depth_takes_no_minutes."""
    min_jump: float = 0.006
    """Metres: neighbours that are less far apart are on one surface. Doubled, mosd 16 has two things fewer at half
    resolution."""
    jump_noise_ratio: float = 7.0
    """Standard deviations of the noise by which two neighbours on one surface may be apart. Doubled, mosd 44 has a
    thing fewer at half resolution."""
    jump_spacing_ratio: float = 3.5
    """Usual distances between neighbours by which they may be apart: a surface that is seen aslant, up to 73 degrees.
    Halved, mosd 34 has two things more at half resolution; doubled, mosd 16 has two fewer."""


@dataclass(frozen=True, slots=True)
class SupervoxelSettings(_Thresholds):
    """Patches of surface: how far apart their seeds are, and what a path from a seed pays."""

    spacing_noise_ratio: float = 8.0
    """Distance of seeds in standard deviations of the noise: a patch's mean normal has little noise left. Doubled, a
    thing more falls apart in mosd 54 at half resolution."""
    min_spacing: float = 0.008
    """Metres between seeds at least: patches are narrower than a handle. Doubled, mosd 34 has a thing too many at half
    resolution; docs/explanation/detection.md (Limits) says what less does."""
    max_spacing: float = 0.03
    """Metres between seeds at most, in much noise: a cup still has some patches. Halving or doubling it changes none of
    the scenes tried, which have less noise."""
    spacing_neighbour_ratio: float = 4.5
    """Distance of seeds in distances between neighbours at least, so that a patch has some twenty points. Doubled,
    simulated setting 0 has three things too many at half resolution."""
    turn_cost: float = 1.5
    """What a path pays for a radian by which the normal turns, in spacings of seeds, so that patches end at edges.
    Halved, mosd 44 has a thing fewer at half resolution. Shown by test_surfaces_part_in_a_valley_and_not_on_a_ridge."""
    step_cost: float = 400.0
    """What it pays for a metre of height between the planes of neighbours: a step of 2.5 mm costs a spacing. Halved,
    mosd 44 has a thing fewer at half resolution; doubled, two fewer."""
    colour_cost: float = 0.05
    """What it pays for a difference of colour of 1: one of 20 costs a spacing. Doubled, mosd 44 has a thing fewer at
    half resolution."""
    colour_noise: float = 2.0
    """Difference of colour that noise alone makes, and that costs nothing. Doubled, mosd 44 has a thing fewer at half
    resolution."""
    lightness_weight: float = 0.35
    """Weight of lightness in a difference of colour: a shadow on one thing is mostly that. Doubled, a thing more falls
    apart in mosd 54 and in simulated setting 0, at half resolution."""
    min_colour_height: float = 1e-4
    """Metres: what a point on the table counts for in a mean of colours, which is weighted by height, since at its
    border a low thing's points are mixed with the table's. Any small number does: halving or doubling it changes no
    scene."""


@dataclass(frozen=True, slots=True)
class BoundarySettings(_Thresholds):
    """What speaks for two things where patches meet, and how long regions are merged."""

    jump_evidence: float = 1.2
    """Evidence for two things where the depth jumps; 1 is enough. Halved, mosd 44 has a thing fewer at half resolution;
    doubled, mosd 54 has two more."""
    max_evidence: float = 1.5
    """The most evidence that one place gives, so that it does not outweigh a long boundary. Halved, mosd 44 has a thing
    fewer at half resolution."""
    step_noise_ratio: float = 2.5
    """A step is larger than so many standard deviations of the noise. Doubled, mosd 16 has a thing less at half
    resolution."""
    step_distance_ratio: float = 0.3
    """A step is larger than that share of the distance of patches, since coarse patches are not on one plane. Halved,
    mosd 54 has a thing more at half resolution."""
    off_edge_share: float = 0.35
    """Difference of the distances of two patches' middles from their common edge, by the sum, that is no step. Doubled,
    mosd 54 has a thing fewer at half resolution."""
    merge_limit: float = 0.6
    """Mean evidence along a boundary up to which regions are merged. Halved, mosd 54 has three things more at half
    resolution; doubled, simulated settings 0 and 3 lose two things."""
    colour_delay: float = 0.3
    """Evidence by which regions of other colours are merged later: where a knife ends on the rim of a plate nothing
    else tells the two apart. Shown by test_colour_decides_what_is_merged_first."""
    full_colour_difference: float = 6.0
    """Difference of colour that makes that delay whole. Shown by test_colour_decides_what_is_merged_first."""


@dataclass(frozen=True, slots=True)
class JoiningSettings(_Thresholds):
    """Which parts are one thing although their surfaces do not meet convexly."""

    fragment_area: float = 7e-4
    """Square metres: a smaller piece of surface is no thing of its own where it meets another (2.6 cm square). Halved,
    mosd 44 has 5 parts more; doubled, it has 3 fewer."""
    max_parts: int = 250
    """Parts that are joined by more than their size, the largest ones: tables show less than a hundred, depth without
    sense tens of thousands. Shown by test_scattered_depth_takes_no_minutes."""
    min_near_points: int = 10
    """Points of a part that is joined with one that it does not meet: what has fewer is noise. No scene or test tried
    shows it."""
    # Colour.
    max_same_colour: float = 9.0
    """Difference of colour below which parts are of one colour. Halved, simulated setting 11 has three parts more."""
    min_other_colour: float = 12.0
    """Difference of colour above which they are not, if each is plain; between the two nothing is said. Halved,
    simulated setting 0 has 8 parts more; doubled, 8 fewer; see test_colours_differ_only_by_more_than_they_vary."""
    max_plain_variation: float = 7.0
    """Standard deviation up to which a part has one colour; the mean of a motley one says nothing. Halved, simulated
    setting 11 has three parts more; doubled, mosd 44 has three fewer."""
    same_colour_evidence: float = 1.15
    """Evidence below which two parts of one colour are one: for two things more has to speak. Halved, simulated setting
    5 has three parts more."""
    resting_rise: float = 0.005
    """Metres: where a part is by so much higher than another, on the average of where they meet, it lies on it. Halved,
    simulated settings 2, 4 to 7, 9 and 10 have a part more."""
    # Hollow things: the well of a plate, the inside of a cup.
    well_rise: float = 0.001
    """Metres by which a well may be above its rim where they meet: noise of the mean over a boundary. Tenfold, mosd 46
    is divided otherwise."""
    well_top_tolerance: float = 0.005
    """Metres by which a well may be higher than its rim. No scene or test tried shows it."""
    max_well_bulge: float = 0.1
    """Bulge (1 a sphere from outside) up to which a part is a well, and nothing that lies in one. At 0, simulated
    settings 3 and 7 have two parts more."""
    min_inside_share: float = 0.8
    """Share of a part within the outline of another that makes it lie inside: a well in its rim, a neck on its bottle.
    Halved, mosd 44 and 54 have a part fewer; doubled, so that it cannot be, simulated setting 3 has five more."""
    inside_tolerance: float = 0.004
    """Metres beyond an outline that count as within: half a patch. Halved, simulated setting 3 has a part more;
    doubled, mosd 50 has one fewer."""
    min_cavity_depth: float = 0.03
    """Metres from top to bottom of a hollow thing that is seen from inside: cups are, plates are not. Halved, simulated
    setting 5 has a part fewer; doubled, mosd 34 and 54 have one more."""
    min_cavity_bend: float = 0.1
    """How far a part is curved inwards (1 a sphere from inside) to be an inside: a handle may be part of it. Tenfold,
    mosd 34 has two parts more, and simulated settings 0 to 7 one."""
    level_tolerance: float = 0.012
    """Metres by which two pieces of one rim differ in height. At 0, mosd 34 has two parts more, and simulated settings
    0 to 7 one."""
    # What something lies on: a plate below a knife or a napkin.
    covering_rise: float = 5e-4
    """Metres by which what lies on a part is higher where they meet. Doubled, mosd 50 has a part more."""
    max_hidden_gap: float = 0.11
    """Metres of a surface of one colour that something on it hides: a napkin on a plate. Doubled, simulated setting 2
    has a part fewer."""
    hidden_gap_spread: float = 0.015
    """Metres: a hidden surface goes on where its pieces are nearest, or so much farther apart. Doubled, mosd 40 has a
    part fewer, and mosd 50 one more."""
    coplanar_step: float = 0.004
    """Metres between the planes of two pieces of one surface. Halved, mosd 24, 50 and 52 and simulated setting 9 have a
    part more; doubled, simulated setting 5 has one fewer."""
    coplanar_angle: float = math.radians(25.0)
    """Radians between their normals: 25 degrees. Halved, simulated settings 2 and 9 have a part more; doubled, mosd 54
    has two fewer."""
    min_coplanar_share: float = 0.5
    """Share of the nearest patches of two pieces that lie in one plane. Halved, mosd 50 has two parts fewer; doubled,
    so that it cannot be, mosd 24 and 34 have two more."""
    min_covered_share: float = 0.5
    """Share of the places between two pieces that what lies on them hides. Doubled, so that it cannot be, mosd 24 and
    34 have two parts more."""
    rim_tolerance: float = 0.1
    """How far the edge of a round rim may be off a circle, in its radius: patches are coarse. Tenfold, mosd 40 and 46
    have two parts fewer."""
    min_rim_share: float = 0.5
    """Share of a round rim that is to be seen, in two pieces, for these to be one. Halved, mosd 40 has a part fewer."""
    # Glasses and bottles.
    foot_height: float = 0.022
    """Metres: most of the foot of a glass is lower; the glass is on the mean more than twice as high. Doubled, mosd 44
    and 52 have a part more."""
    stem_rise: float = 0.006
    """Metres by which what meets or hides a foot is higher: a stem, a bowl. Halved, mosd 44 has a part fewer; doubled,
    mosd 52 has one more."""
    foot_width_ratio: float = 1.2
    """Width of a foot by that of the glass on it, at most: a plate is wider. Halved, most simulated settings have a
    part more: the foot of the glass."""
    min_foot_inside_share: float = 0.1
    """Share of a foot that is below its glass: the rest may be seen beside it. Tenfold, so that it cannot be, simulated
    settings 0 to 5 have a part more."""
    bottle_slenderness: float = 1.2
    """Height of a bottle by its width, at least: things on cups are none of their necks. Shown by
    test_a_neck_is_the_bottles_on_whose_middle_it_is[a thing on a cup]."""
    neck_offset_ratio: float = 0.2
    """Distance of a neck from the middle of its bottle, by the bottle's width, at most. Shown by
    test_a_neck_is_the_bottles_on_whose_middle_it_is[a thing on the edge of another]."""
    shoulder_depth: float = 0.02
    """Metres below the top of a bottle's body from which its neck may begin. No scene or test tried shows it."""
    # Handles, necks and sides.
    attachment_ratio: float = 0.6
    """Width and area of a handle or a neck by those of what it is on, at most. Halved, mosd 52 and 54 have a part more;
    doubled, mosd 48 has three fewer."""
    handle_clearance: float = 0.012
    """Metres by which a handle begins higher than what it is on: what stands beside a thing is another. Shown by
    test_what_stands_on_nothing_beside_a_thing_is_its_handle; doubled, mosd 54 has a part more."""
    max_handle_inside_share: float = 0.5
    """Share of a handle within the outline of what it is on: more of it lies on that. Halved, mosd 52 has a part more;
    doubled, mosd 54 has one fewer."""
    attachment_gap: float = 0.02
    """Metres from a handle or a side to what it is on, as seen from above; its ends may be too thin to be seen. Halved,
    mosd 48 has two parts more; doubled, mosd 46 has three fewer."""
    max_sheet_normal: float = 0.5
    """Vertical component of the normal of what is upright: 60 degrees and more. Halved, simulated setting 3 has a part
    more; doubled, simulated setting 5 has five fewer."""
    patch_width: float = 0.01
    """Metres: what is narrower than a patch is taken to be as wide, and is a sheet. Halved, mosd 50 has a part more;
    doubled, mosd 34 has one more."""
    # Cutlery in two pieces.
    max_cutlery_height: float = 0.03
    """Metres: cutlery is no higher. Halved, simulated settings 5 and 11 have a part more; see
    test_the_head_of_a_spoon_goes_on_in_its_handle."""
    min_cutlery_slenderness: float = 3.0
    """Length of two pieces of cutlery together by their width, at least. Halved, mosd 44 has a part fewer; doubled,
    mosd 34 has one more."""
    max_cutlery_width: float = 0.045
    """Metres between the middles of patches at either side: a spoon's bowl is no wider. Halved, simulated settings 5
    and 11 have a part more; see test_the_head_of_a_spoon_goes_on_in_its_handle."""
    max_cutlery_gap: float = 0.03
    """Metres of a spoon's neck that may not be seen. Halved, mosd 34 has a part more; doubled, mosd 44 has one fewer;
    see test_the_head_of_a_spoon_goes_on_in_its_handle."""
    end_overlap_share: float = 0.3
    """Share of the shorter piece by which two pieces in a line overlap at most: others lie side by side. No scene or
    test tried shows it."""
    resting_difference: float = 0.009
    """Metres: the lowest places of the head and the handle of what lies on one thing differ by less, however it is
    arched; those of cutlery on the rim of a plate and of cutlery beside the plate by more. Doubled, simulated settings
    1 and 7 have a part fewer; see test_two_pieces_in_a_line_are_one_where_they_can_lie_so_as_one."""


@dataclass(frozen=True, slots=True)
class TableTopSettings(_Thresholds):
    """Which points are on the table's top, and what is above its outline."""

    max_cells: int = 80
    """Cells of the image, along its longer side, in which the plane is looked for: 1.5 cm at one metre."""
    min_cell_side: float = 4.0
    """Points along the side of a cell, on the average, so that a cell of the table is hardly ever without one."""
    plan_cell: float = 0.03
    """Metres of the grid on which the points of a table are connected where it is not known from where they were seen:
    holes below things are narrower. Shown by test_what_is_bare_or_as_low_as_a_floor_is_no_second_table."""
    min_level_share: float = 0.25
    """Share of a cell's points that are level with the plane where it shows the table: noise leaves half of them at two
    metres and a half."""
    min_part_cells: int = 3
    """Cells of a part of the table at least; what is less is noise."""
    max_covered_share: float = 0.8
    """Share of a part that has something right above it: of a table it is less, of a strip of a wall all. Shown by
    test_a_strip_of_a_wall_at_the_height_of_the_table_is_no_part_of_it."""
    max_below_share: float = 0.1
    """Share of a line between two parts of a table on which something lower is seen. Shown by
    test_parts_of_a_table_are_one_if_a_pile_is_between_them."""
    max_empty_share: float = 0.34
    """Share of such a line on which nothing is seen: the shadow of what hides the rest. Shown by
    test_a_second_table_is_told_of_and_can_be_looked_at."""
    outline_sample_size: int = 30_000
    """Points of a table that its outline is drawn from. No scene or test tried shows it."""
    slack: float = 0.02
    """Metres by which a thing's point may lie beyond the table's outline: things reach over the edge. No scene or test
    tried shows it."""
    margin: float = 0.3
    """Metres around the table's outline that are looked at for what reaches over its edge. No scene or test tried shows
    it."""


@dataclass(frozen=True, slots=True)
class OutlineSettings(_Thresholds):
    """The outlines of things as seen from above, and their boxes."""

    trim_share: float = 0.002
    """Share of the points at either end of an axis that are taken for noise. Shown by
    test_a_stray_point_in_a_thousand_does_not_stretch_a_box."""
    rim_tolerance: float = 0.05
    """How far the edge of what is round may be off a circle, in its radius: noise, but no corner. Shown by
    test_the_rim_of_a_plate_goes_on_behind_what_stands_on_it."""
    min_rim_radius: float = 0.015
    """Metres: of what is smaller, little is hidden. Shown by
    test_the_rim_of_a_plate_goes_on_behind_what_stands_on_it."""
    max_rim_radius: float = 0.2
    """Metres: what is larger is no tableware. Shown by test_the_rim_of_a_plate_goes_on_behind_what_stands_on_it."""
    min_rim_sectors: int = 12
    """Sectors of 36, one beside the other but for gaps, that show where the rest of a circle is. Shown by
    test_the_rim_of_a_plate_goes_on_behind_what_stands_on_it."""
    rim_gap_sectors: int = 2
    """Sectors that one gap among these has at most: what stands before the edge. Shown by
    test_the_rim_of_a_plate_goes_on_behind_what_stands_on_it."""
    rim_inset: float = 0.01
    """Metres at the edge of a circle within which the table may be seen: noise at the border. Shown by
    test_where_the_table_is_seen_no_rim_goes_on."""
    bare_cell: float = 0.005
    """Metres of the grid in which what is seen of the table within a circle is counted. Shown by
    test_where_the_table_is_seen_no_rim_goes_on."""
    bare_share: float = 0.03
    """Share of a circle's area within which the table may be seen, for strays. Shown by
    test_where_the_table_is_seen_no_rim_goes_on."""


@dataclass(frozen=True, slots=True)
class NoteSettings(_Thresholds):
    """What is said of that which is not reported."""

    min_piece_points: int = 200
    """Points of what is left out that is worth a note: fewer are hardly a thing. Shown by
    test_what_is_not_reported_is_said."""
    min_high_share: float = 0.02
    """Points that are too high above the table, by those of its top. Shown by test_what_is_not_reported_is_said."""
    min_discarded_share: float = 0.05
    """Share of the points above the table that are in pieces too small or too low for things. Shown by
    test_what_is_not_reported_is_said."""
    overhang: float = 0.1
    """Metres beyond the table's outline from which a piece reaches over its edge. Shown by
    test_what_is_not_reported_is_said."""
    min_overhang_share: float = 0.1
    """Share of such a piece that is as far outside, and share that is inside. Shown by
    test_what_is_not_reported_is_said."""
    hole_cell: int = 8
    """Pixels along the side of a cell in which depth may be missing. Shown by test_what_is_not_reported_is_said."""
    max_hole_share: float = 0.1
    """Share of the cells of a table that have no depth. Shown by test_what_is_not_reported_is_said."""
    min_usual_length: float = 0.03
    """Metres that things are long in the median, at least. Shown by test_what_is_not_reported_is_said."""
    max_usual_length: float = 0.6
    """Metres that they are long in the median, at most. Shown by test_what_is_not_reported_is_said."""


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
    top: TableTopSettings = field(default_factory=TableTopSettings)
    heights: HeightSettings = field(default_factory=HeightSettings)
    surface: SurfaceSettings = field(default_factory=SurfaceSettings)
    supervoxels: SupervoxelSettings = field(default_factory=SupervoxelSettings)
    boundaries: BoundarySettings = field(default_factory=BoundarySettings)
    joining: JoiningSettings = field(default_factory=JoiningSettings)
    outlines: OutlineSettings = field(default_factory=OutlineSettings)
    notes: NoteSettings = field(default_factory=NoteSettings)

    def __post_init__(self) -> None:
        for name in ("height", "reach", "least_length", "concavity", "step"):
            value = getattr(self, name)
            if not (_is_finite(value) and value > 0):
                raise CloudError(f"detection's {name} is a number above 0, not {value}")
        if not _is_whole(self.seed) or self.seed < 0:
            raise CloudError(f"detection's seed is a whole number of 0 or more, not {self.seed}")
        if not _is_whole(self.table) or self.table < 1:
            raise CloudError(f"tables are numbered from 1, not from {self.table}")
        if not _is_whole(self.least_points) or self.least_points < 1:
            raise CloudError(f"a thing has 1 point or more, not {self.least_points}")
        for name in ("viewer", "up"):
            vector = getattr(self, name)
            if vector is not None and not (
                hasattr(vector, "__len__") and len(vector) == 3 and all(map(_is_finite, vector))
            ):
                raise CloudError(f"detection's {name} is three finite numbers, not {vector}")
        if self.up is not None and not any(self.up):
            raise CloudError("detection's up is a direction, not (0, 0, 0)")
        for each in fields(self):
            group = each.default_factory
            if isinstance(group, type) and not isinstance(getattr(self, each.name), group):
                raise CloudError(f"detection's {each.name} must be {group.__name__}, got {getattr(self, each.name)!r}")


def _is_finite(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _is_whole(value: object) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)
