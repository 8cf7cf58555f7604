"""Find which thing a gesture points at: the rays of the arm against boxes, each with its spread.

Three rays are measured: from the eye to the fingertip, along the forearm, and along the hand. Each misses what is
pointed at by some angle, because joints are measured with noise and because people aim by their own rule. The misses of
the three are correlated: they share the fingertip. Their joint distribution was fitted to simulated teachers
(``benchmarks/fit_pointing.py``), so that the rays are combined by how well each of them points. The line from eye to
fingertip is the best single ray, as for people (Nickel and Stiefelhagen 2007; Mayer and others 2015).

The probability of a thing is that of the measured rays, averaged over the places on it that a person may aim at, beside
the probabilities of an empty place of the table and of an arm that does not point.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import PointingError
from deixis.perception.pointing.gesture import Gesture, unit
from deixis.perception.scene import PerceivedObject, Scene

Array = NDArray[np.float64]

SURE = 0.95
"""Minimum probability of a decided thing."""

NONE = "none of them"
"""Name of the case that the gesture points at no thing of the scene."""

EMPTY_PRIOR, IDLE_PRIOR = 0.04, 0.05
"""Prior probabilities that a gesture points at an empty place, and that the arm does not point."""

CELL = 0.03
"""Distance between the empty places that are compared, in metres."""

MARGIN = 0.3
"""Distance from the things up to which empty places count, in metres."""

OFFSETS = np.linspace(-0.4, 0.4, 5)
"""Places along each side of a thing that a person may aim at, from its middle, as shares of the side."""

HEIGHTS = ((1.0, 0.4), (0.75, 0.3), (0.5, 0.2), (0.25, 0.1))
"""Heights on a thing that a person may aim at, as shares of its height, with their weights."""

AIM_SPREAD = 0.25
"""Standard deviation of the aimed place about the middle of a side, as a share of the side."""

NEAR = 0.04
"""Distance in metres below which the miss of a ray counts by its length rather than by its angle."""

TAIL = 8.0
"""Degrees of freedom of the t distribution of the misses."""

MIN_ASKED = 0.05
"""Minimum probability of a thing that a question names."""


@dataclass(frozen=True, eq=False)
class AimModel:
    """Distribution of the angles by which the rays miss what a person points at.

    Parameters
    ----------
    angles
        Covariances of the three rays, horizontally and vertically, shape (2, 3, 3), in radians squared.
    places
        Covariances of the places, shape (2, 3, 3), in metres squared; they count as angles seen from the distance.
    bias
        Mean misses, shape (2, 3), in radians.
    """

    angles: Array
    places: Array
    bias: Array

    def log_densities(self, gesture: Gesture, places: Array) -> Array:
        """Return the log densities of the measured rays of a gesture, for each place that it may aim at.

        Parameters
        ----------
        gesture
            The gesture.
        places
            Places, shape (k, 3), in metres.

        Returns
        -------
        ndarray
            Log densities per steradian of each ray that was seen, shape (k,).
        """
        from scipy.special import gammaln

        off, distance = misses(gesture, places)
        seen = np.isfinite(off[0, 0])
        m = 2 * int(seen.sum())
        scale = 1 / (distance**2 + NEAR**2)
        noise = np.diag(np.square(np.nan_to_num(gesture.scatter[seen], nan=0.0)))
        total, log_det = np.zeros(len(places)), np.zeros(len(places))
        for axis in (0, 1):
            kept = np.ix_(seen, seen)
            spread = self.angles[axis][kept] + noise + scale[:, None, None] * self.places[axis][kept]
            rest = (off[:, axis] - self.bias[axis])[:, seen]
            solved = np.linalg.solve(spread, rest[..., None])[..., 0]
            total += np.einsum("ki,ki->k", rest, solved)
            log_det += np.linalg.slogdet(spread)[1]
        constant = gammaln((TAIL + m) / 2) - gammaln(TAIL / 2) - m / 2 * np.log(TAIL * np.pi)
        result: Array = constant - log_det / 2 - (TAIL + m) / 2 * np.log1p(total / TAIL)
        return result

    def to_dict(self) -> dict[str, Any]:
        """Return the model as plain data.

        Returns
        -------
        dict
            Lists of numbers under ``angles``, ``places`` and ``bias``.
        """
        return {name: np.round(getattr(self, name), 8).tolist() for name in ("angles", "places", "bias")}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> AimModel:
        """Return the model in plain data.

        Parameters
        ----------
        data
            Data of :meth:`to_dict`.

        Returns
        -------
        AimModel
            The model.
        """
        return cls(*(np.array(data[name], dtype=np.float64) for name in ("angles", "places", "bias")))


@cache
def shipped_aim() -> AimModel:
    """Return the model that was fitted to simulated teachers.

    Returns
    -------
    AimModel
        The model.
    """
    text = files("deixis.perception.pointing").joinpath("aim.json").read_text(encoding="utf-8")
    return AimModel.from_dict(json.loads(text))


def misses(gesture: Gesture, places: Array) -> tuple[Array, Array]:
    """Return by how much the rays of a gesture miss places.

    Parameters
    ----------
    gesture
        The gesture.
    places
        Places, shape (k, 3), in metres.

    Returns
    -------
    off : ndarray
        Angles from each place to each ray, horizontally and vertically, shape (k, 2, 3), in radians; NaN for a ray
        that was not seen. Nearer than ``NEAR`` they are smaller, because the direction means less.
    distance : ndarray
        Distances from the fingertip, shape (k,), in metres.
    """
    away = places - gesture.tip
    distance = np.linalg.norm(away, axis=1)
    ahead = unit(away)
    across = np.cross(ahead, [0.0, 0.0, 1.0])
    steep = np.linalg.norm(across, axis=1) < 1e-6
    across[steep] = (1.0, 0.0, 0.0)
    across = unit(across)
    upward = np.cross(across, ahead)
    rays = gesture.rays
    sideways, raised, along = across @ rays.T, upward @ rays.T, ahead @ rays.T  # each of shape (k, 3)
    sine = np.hypot(sideways, raised)
    angle = np.arctan2(sine, along) * (distance / np.sqrt(distance**2 + NEAR**2))[:, None]
    share = angle / np.maximum(sine, 1e-12)
    return np.stack([sideways * share, raised * share], axis=1), distance


@dataclass(frozen=True, eq=False)
class Pointing:
    """Things that a gesture may point at, with their probabilities.

    Parameters
    ----------
    gesture
        The gesture.
    probabilities
        Probability of each thing by its id, the greatest first; the rest to 1 is :attr:`none`.
    decided
        Id of the thing, if its probability is high enough, else None.
    question
        Question that would settle it, or None.
    refused
        Reason why no thing is decided, or None.
    """

    gesture: Gesture
    probabilities: Mapping[str, float]
    decided: str | None
    question: str | None
    refused: str | None

    @property
    def none(self) -> float:
        """Probability that the gesture points at no thing of the scene."""
        return max(0.0, 1.0 - sum(self.probabilities.values()))


def pointed_at(
    gesture: Gesture,
    scene: Scene,
    *,
    prior: Mapping[str, float] | None = None,
    sure: float = SURE,
    model: AimModel | None = None,
) -> Pointing:
    """Find which thing of a scene a gesture points at.

    Parameters
    ----------
    gesture
        The gesture.
    scene
        Things in metres with heights, at the time of the gesture.
    prior
        Relative weights of the things before the gesture is seen, by id, such as how well a name fits each; 1 for those
        that are left out.
    sure
        Minimum probability of a decided thing.
    model
        Distribution of the misses; default: the shipped one.

    Returns
    -------
    Pointing
        The probabilities, and the decided thing or the question.

    Raises
    ------
    PointingError
        If the scene has objects without heights or in pixels, ``sure`` is not in (0.5, 1), or a weight is negative.
    """
    if not 0.5 < sure < 1:
        raise PointingError(f"`sure` must be above 0.5 and below 1, got {sure:g}")
    if not scene.objects:
        return Pointing(gesture, {}, None, None, "the scene has no things")
    if scene.unit != "m" or scene.boxes.shape[2] != 3:
        raise PointingError(
            f"{scene.file}: pointing needs boxes in metres with heights; give 'min' and 'max' 3 numbers"
        )
    weights = np.array([(prior or {}).get(name, 1.0) for name in scene.ids], dtype=np.float64)
    if not (weights >= 0).all() or not weights.sum() > 0:
        raise PointingError("`prior` must have weights of at least 0, and one above 0")
    model = model or shipped_aim()
    shares = _shares(gesture, scene, weights / weights.sum(), model)
    order = np.argsort(-shares[:-1], kind="stable")
    probabilities = {scene.ids[i]: float(shares[i]) for i in order}
    best = scene.ids[order[0]]
    if probabilities[best] >= sure:
        return Pointing(gesture, probabilities, best, None, None)
    return Pointing(gesture, probabilities, None, *_doubt(scene, probabilities, float(shares[-1])))


def _shares(gesture: Gesture, scene: Scene, weights: Array, model: AimModel) -> Array:
    """Return the posterior probabilities of the things, and of none as the last."""
    aims = [_aims(thing) for thing in scene.objects]
    empty = _empty_places(scene)
    places = np.concatenate([*(place for place, _ in aims), empty])
    density = model.log_densities(gesture, places)
    top = float(density.max())
    likely = np.exp(density - top)
    ends = np.cumsum([len(place) for place, _ in aims])
    parts = np.split(likely[: ends[-1]], ends[:-1])
    things = np.array([share @ part for (_, share), part in zip(aims, parts, strict=True)])
    rays = int(np.isfinite(gesture.rays[:, 0]).sum())
    idle = np.exp(-rays * np.log(4 * np.pi) - top)
    none = EMPTY_PRIOR * likely[ends[-1] :].mean() + IDLE_PRIOR * idle
    joint = np.append((1 - EMPTY_PRIOR - IDLE_PRIOR) * weights * things, none)
    result: Array = joint / joint.sum()
    return result


def _aims(thing: PerceivedObject) -> tuple[Array, Array]:
    """Return places on a thing that a person may aim at, shape (k, 3), with their weights, sum 1."""
    low, high = np.array(thing.minimum), np.array(thing.maximum)
    middle, extents, axes = (low + high)[:2] / 2, (high - low)[:2], np.eye(2)
    if thing.oriented is not None:
        box = thing.oriented
        middle, extents, axes = np.array(box.centre[:2]), np.array(box.extents[:2]), box.axes[:2, :2]
    u, v = (one.ravel() for one in np.meshgrid(OFFSETS, OFFSETS))
    plan = middle + (np.stack([u, v], axis=1) * extents) @ axes
    weights = np.exp(-(u**2 + v**2) / (2 * AIM_SPREAD**2))
    heights = [low[2] + share * (high[2] - low[2]) for share, _ in HEIGHTS]
    places = np.concatenate([np.column_stack([plan, np.full(len(plan), z)]) for z in heights])
    weights = np.concatenate([weight * weights for _, weight in HEIGHTS])
    return places, weights / weights.sum()


def _empty_places(scene: Scene) -> Array:
    """Return places in a grid on the plane that the lowest thing stands on, and not under a thing, shape (k, 3)."""
    boxes = scene.boxes
    low, high = boxes[:, 0].min(axis=0) - MARGIN, boxes[:, 1].max(axis=0) + MARGIN
    counts = np.minimum(np.ceil((high - low)[:2] / CELL).astype(int) + 1, 100)
    x, y = np.meshgrid(*(np.linspace(low[axis], high[axis], counts[axis]) for axis in (0, 1)))
    plan = np.column_stack([x.ravel(), y.ravel()])
    inside = (plan[:, None] >= boxes[None, :, 0, :2]) & (plan[:, None] <= boxes[None, :, 1, :2])
    under = np.any(np.all(inside, axis=2), axis=1)
    plan = plan[~under]
    return np.column_stack([plan, np.full(len(plan), boxes[:, 0, 2].min())])


def _doubt(scene: Scene, probabilities: Mapping[str, float], none: float) -> tuple[str | None, str]:
    """Return the question about an undecided gesture, if there is one, and the reason."""
    likely = [name for name, share in probabilities.items() if share >= MIN_ASKED]
    if none > max(probabilities.values()) or not likely:
        return None, f"points at {NONE} (probability {none:.2f})"
    named = [_called(scene[name]) for name in likely]
    if len(named) == 1:
        return f"Do you mean {named[0]}?", f"only {probabilities[likely[0]]:.2f} sure that it points at {named[0]}"
    listed = f"{', '.join(named[:-1])} or {named[-1]}"
    return f"Which one do you mean: {listed}?", f"points at {listed}"


def _called(thing: PerceivedObject) -> str:
    return thing.id if thing.label is None else f"the {thing.label} ({thing.id})"
