"""How large things of a kind are, as was learned from those that were seen."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SizeModel:
    """Log-normal length (longer side in the plan) and aspect (shorter by longer side) of a kind of thing.

    ``relative``: as images teach it. The length is in units of the scene's median length, and the aspect is height by
    width, since what is up stays up.
    """

    length: tuple[float, float]  # mean and standard deviation of the natural logarithm
    aspect: tuple[float, float]
    relative: bool = False
    views: float = 0.0
