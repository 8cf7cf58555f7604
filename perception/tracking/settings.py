"""Settings of the tracker; lengths in metres, angles in radians, times in seconds."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from deixis.perception.detection.settings import DetectionSettings


@dataclass(frozen=True, slots=True)
class ParticleSettings:
    """Options of the particle filter.

    Parameters
    ----------
    shift, turn
        Standard deviations of the movement between two frames in each direction and about each axis, beyond what the
        velocity predicts, for a thing that was at rest.
    unsteadiness
        What is added to ``shift`` as a share of the predicted way; ``most_shift`` is the largest sum.
    layers, shrink
        Number of rounds of resampling for each frame, and the factor on the movement from round to round.
    sharpness
        Logarithm of the odds of two particles whose mean scores differ by 1, in the last round.
    bin_shift, bin_turn
        Sides of the bins by which the number of particles is chosen.
    error, confidence
        Largest divergence from the true posterior, in nats, and the quantile of the normal distribution of the
        probability with which it is kept.
    fewest, most
        Least and largest number of particles.
    guided
        Share of the particles that are proposed from the data: a point of the thing is put on a measured point of
        similar colour.
    guided_lost, turn_lost
        The same share for a thing that the frame before did not show, and the standard deviation of the turn about the
        vertical of these particles.
    points
        Largest number of points of a thing that are compared.
    """

    shift: float = 0.011
    turn: float = np.deg2rad(5.0)
    unsteadiness: float = 0.3
    most_shift: float = 0.028
    layers: int = 4
    shrink: float = 0.45
    sharpness: float = 90.0
    bin_shift: float = 0.02
    bin_turn: float = np.deg2rad(15.0)
    error: float = 0.15
    confidence: float = 2.33
    fewest: int = 150
    most: int = 1200
    guided: float = 0.25
    guided_lost: float = 0.6
    turn_lost: float = np.deg2rad(25.0)
    points: int = 160


@dataclass(frozen=True, slots=True)
class TrackingSettings:
    """Options of the tracker.

    Parameters
    ----------
    detection
        Options of the detection of new things.
    particles
        Options of the particle filter.
    stride
        Every how many rows and columns of the image are compared; detection uses all.
    tolerance, noise_ratio
        Difference of two depths that counts as a change: at least ``tolerance``, and this multiple of the noise.
    colour
        Difference of two colours that counts as a change, as a distance in RGB from 0 to 255.
    steady
        Time for which a change must last before it is segmented, and after which the mean of the first frames corrects
        the first look.
    recent
        Number of the last frames whose mean is segmented.
    least_pixels
        Least number of pixels of a new thing in the image that is compared.
    margin
        Distance from the box of a thing within which points may be its own.
    turned_margin, turned_for
        The same for a thing that has come to rest within the second, and may show another side, such as a handle.
    doubtful, moved
        A resting thing is looked for elsewhere if less than the first share of its pixels is unchanged, and has moved
        if the table is seen behind more than the second share of those that are not hidden.
    fit, visible
        Least mean score of the points of a moving thing that are not hidden, and least share of its points within the
        image that are seen, for its place to be certain.
    jump
        Distance in metres from the predicted place beyond which a moving thing must be seen well to be found.
    still, still_for
        A moving thing has come to rest if it moves by less than the first in the second.
    complete_after
        Time of rest after which thin parts of a thing that one frame did not show are added to it.
    gone_after
        Time without a hand in view after which a thing that is not found is gone.
    away_after
        The same time for a thing that was carried out of the image of a moving camera, above the table where it may be
        set down.
    lost_after
        Time after which a thing that left its place and is not found is gone, also if a hand is in view.
    workers
        Number of threads that the pipelines share.
    seed
        Seed of the particle filters.
    """

    detection: DetectionSettings = field(default_factory=DetectionSettings)
    particles: ParticleSettings = field(default_factory=ParticleSettings)
    stride: int = 2
    tolerance: float = 0.004
    noise_ratio: float = 4.0
    colour: float = 40.0
    steady: float = 0.45
    recent: int = 6
    least_pixels: int = 25
    margin: float = 0.008
    turned_margin: float = 0.03
    turned_for: float = 2.5
    doubtful: float = 0.4
    moved: float = 0.35
    fit: float = 0.45
    visible: float = 0.15
    jump: float = 0.12
    still: float = 0.004
    still_for: float = 0.3
    complete_after: float = 1.0
    gone_after: float = 0.8
    away_after: float = 3.0
    lost_after: float = 6.0
    workers: int = 2
    seed: int = 0
