"""Estimate the pose of a moving thing by a particle filter with an adaptive number of particles.

For each frame, particles move as the velocity of the thing predicts, and some are proposed from the data. Their number
follows from the number of bins that they fill, so that the divergence from the true posterior stays small (KLD
sampling: Fox, Adapting the Sample Size in Particle Filters Through KLD-Sampling, 2003). They are then weighted and
resampled in several rounds with decreasing movements and increasingly sharp weights (annealing: Deutscher, Blake and
Reid 2000).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.settings import ParticleSettings

Floats = NDArray[np.float64]

Weigh = Callable[[Floats, Floats], Floats]
"""Function that returns the mean scores (n,) of places (n, 3) and turns (n, 4)."""

Guide = Callable[[Floats, np.random.Generator], Floats]
"""Function that proposes places (n, 3) for turns (n, 4)."""


def systematic_resample(weights: Floats, count: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Draw indices with probabilities in proportion to weights, by systematic resampling.

    Parameters
    ----------
    weights
        Weights of shape (n,), at least 0 and not all 0.
    count
        Number of draws.
    rng
        Source of the one random number.

    Returns
    -------
    ndarray
        Indices of shape (count,), in order. An index of probability p is drawn floor(count p) or ceil(count p) times.

    Notes
    -----
    Kitagawa, Monte Carlo Filter and Smoother for Non-Gaussian Nonlinear State Space Models (1996).

    Examples
    --------
    >>> systematic_resample(np.array([0.5, 0.25, 0.25]), 4, np.random.default_rng(0)).tolist()
    [0, 0, 1, 2]
    """
    steps = (rng.random() + np.arange(count)) / count
    upper = np.cumsum(weights / weights.sum())
    upper[-1] = 1.0
    drawn: NDArray[np.int64] = np.searchsorted(upper, steps, side="right").astype(np.int64)
    return np.minimum(drawn, len(weights) - 1)


def kld_samples(bins: int, error: float, confidence: float) -> int:
    """Return how many samples keep the divergence of a discrete posterior small.

    Parameters
    ----------
    bins
        Number of bins that contain samples.
    error
        Largest Kullback-Leibler divergence of the estimate from the posterior, in nats.
    confidence
        Quantile of the standard normal distribution of the probability with which it is kept.

    Returns
    -------
    int
        Number of samples, by the Wilson-Hilferty approximation of the chi-squared quantile.

    Examples
    --------
    >>> kld_samples(1, 0.05, 2.33), kld_samples(50, 0.05, 2.33)
    (1, 750)
    """
    if bins <= 1:
        return 1
    free = bins - 1
    part = 2 / (9 * free)
    return int(np.ceil(free / (2 * error) * (1 - part + np.sqrt(part) * confidence) ** 3))


def turned_by(vectors: Floats, turns: Floats) -> Floats:
    """Return orientations turned by rotation vectors.

    Parameters
    ----------
    vectors
        Rotation vectors of shape (n, 3), in radians, in the outer frame.
    turns
        Unit quaternions of shape (n, 4), real part first.

    Returns
    -------
    ndarray
        Unit quaternions of shape (n, 4).
    """
    angle = np.linalg.norm(vectors, axis=1, keepdims=True)
    half = angle / 2
    share = np.where(angle > 1e-9, np.sin(half) / np.maximum(angle, 1e-9), 0.5)
    a, b = np.hstack([np.cos(half), share * vectors]), turns
    product = np.stack(
        [
            a[:, 0] * b[:, 0] - a[:, 1] * b[:, 1] - a[:, 2] * b[:, 2] - a[:, 3] * b[:, 3],
            a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0] + a[:, 2] * b[:, 3] - a[:, 3] * b[:, 2],
            a[:, 0] * b[:, 2] - a[:, 1] * b[:, 3] + a[:, 2] * b[:, 0] + a[:, 3] * b[:, 1],
            a[:, 0] * b[:, 3] + a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1] + a[:, 3] * b[:, 0],
        ],
        axis=1,
    )
    result: Floats = product / np.linalg.norm(product, axis=1, keepdims=True)
    return result


@dataclass(frozen=True, eq=False)
class Estimate:
    """Position (3,) and unit quaternion (4,) of a thing, with the mean score and particle number of round 1."""

    place: Floats
    turn: Floats
    score: float
    particles: int

    @property
    def pose(self) -> Floats:
        """Transform (4, 4) from the thing's own frame to the table's."""
        from scipy.spatial.transform import Rotation

        pose = np.eye(4)
        pose[:3, :3] = Rotation.from_quat(self.turn[[1, 2, 3, 0]]).as_matrix()
        pose[:3, 3] = self.place
        return pose


class ParticleFilter:
    """Posterior of the pose of one thing, as weighted particles.

    Parameters
    ----------
    pose
        Pose (4, 4) at the start.
    settings
        Options of the filter.
    seed
        Seed of its draws.
    """

    def __init__(self, pose: Floats, settings: ParticleSettings, seed: int) -> None:
        from scipy.spatial.transform import Rotation

        self._settings, self._rng = settings, np.random.default_rng(seed)
        self._places = pose[None, :3, 3].copy()
        self._turns = Rotation.from_matrix(pose[:3, :3]).as_quat()[None, [3, 0, 1, 2]]
        self._weights = np.ones(1)
        self.velocity = np.zeros(3)
        """Velocity in metres per second, shape (3,)."""
        self._shift = settings.shift

    def step(self, weigh: Weigh, guide: Guide | None, seconds: float, lost: bool = False) -> Estimate:
        """Move the particles to the next frame, and weigh them.

        Parameters
        ----------
        weigh
            Function that scores particles against the frame.
        guide
            Function that proposes places from the data, or None.
        seconds
            Time since the last frame.
        lost
            True if the frame before did not show the thing: more particles are proposed from the data, with other turns
            about the vertical.

        Returns
        -------
        Estimate
            Mean of the particles around the best one.
        """
        limits = self._settings
        before = self._weights @ self._places
        way = float(np.linalg.norm(self.velocity)) * seconds
        self._shift = min(limits.shift + limits.unsteadiness * way, limits.most_shift)
        places, turns = self._proposed(guide, seconds, lost)
        drawn = len(places)
        for layer in range(limits.layers):
            share = limits.shrink**layer
            if layer:
                chosen = systematic_resample(self._weights, len(places), self._rng)
                places = places[chosen] + self._normal(len(chosen)) * self._shift * share
                turns = turned_by(self._normal(len(chosen)) * limits.turn * share, turns[chosen])
            found = weigh(places, turns)
            sharp = limits.sharpness * limits.shrink ** (limits.layers - 1 - layer)
            self._weights = np.exp(sharp * (found - found.max()))
            self._weights /= self._weights.sum()
        best = int(np.argmax(found))
        near = np.linalg.norm(places - places[best], axis=1) < limits.shift
        near &= np.abs(turns @ turns[best]) > np.cos(limits.turn)
        weights = self._weights * near
        weights /= weights.sum()
        place = weights @ places
        turn = (weights[:, None] * turns * np.sign(turns @ turns[best])[:, None]).sum(axis=0)
        self._places, self._turns = places, turns
        if seconds > 0:
            self.velocity = 0.3 * self.velocity + 0.7 * (place - before) / seconds
        return Estimate(place, turn / np.linalg.norm(turn), float(found[best]), drawn)

    def expected(self, seconds: float) -> Floats:
        """Return the predicted mean place (3,) of the particles.

        Parameters
        ----------
        seconds
            Time since the last frame.

        Returns
        -------
        ndarray
            Place in metres.
        """
        place: Floats = self._weights @ self._places + self.velocity * seconds
        return place

    def reset(self, pose: Floats) -> None:
        """Put all particles on one pose, at rest.

        Parameters
        ----------
        pose
            Pose (4, 4).
        """
        fresh = ParticleFilter(pose, self._settings, 0)
        self._places, self._turns, self._weights = fresh._places, fresh._turns, fresh._weights
        self.velocity = np.zeros(3)

    def _proposed(self, guide: Guide | None, seconds: float, lost: bool) -> tuple[Floats, Floats]:
        """Return places and turns of particles for the next frame; KLD sampling decides how many."""
        limits, chunk = self._settings, max(self._settings.fewest // 2, 16)
        ahead = self.velocity * seconds
        places, turns, filled = [], [], set[bytes]()
        count = 0
        while count < limits.most:
            chosen = systematic_resample(self._weights, chunk, self._rng)
            moved = self._places[chosen] + ahead + self._normal(chunk) * self._shift
            turned = turned_by(self._normal(chunk) * limits.turn, self._turns[chosen])
            moved[0], turned[0] = self._places[chosen[0]], self._turns[chosen[0]]  # it may not have moved at all
            guided = int((limits.guided_lost if lost else limits.guided) * chunk) if guide is not None else 0
            if guide is not None and guided:
                if lost:
                    about = self._rng.normal(0.0, limits.turn_lost, guided)[:, None] * np.array([0.0, 0.0, 1.0])
                    turned[-guided:] = turned_by(about, turned[-guided:])
                moved[-guided:] = guide(turned[-guided:], self._rng)
            places.append(moved)
            turns.append(turned)
            signed = turned * np.where(turned[:, :1] < 0, -1, 1)
            cells = np.hstack([moved / limits.bin_shift, 2 * signed[:, 1:] / limits.bin_turn])
            filled.update(map(bytes, np.floor(cells[: chunk - guided]).astype(np.int16)))
            count += chunk
            if count >= max(kld_samples(len(filled), limits.error, limits.confidence), limits.fewest):
                break
        return np.concatenate(places), np.concatenate(turns)

    def _normal(self, count: int) -> Floats:
        drawn: Floats = self._rng.standard_normal((count, 3))
        return drawn
