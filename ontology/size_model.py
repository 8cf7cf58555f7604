"""How large things of a kind are, as was learned from those that were seen."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SizeModel:
    """Log-normal length (longer side in the plan) and aspect (shorter by longer side) of a kind of thing.

    ``relative``: the length is in units of the scene's median length, as it must be where scenes are in pixels.
    """

    length: tuple[float, float]  # mean and standard deviation of the natural logarithm
    aspect: tuple[float, float]
    relative: bool = False
    views: float = 0.0
