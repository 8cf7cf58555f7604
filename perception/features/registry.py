"""Registry of the descriptors by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from deixis.errors import UnknownTermError
from deixis.perception.features.describer import Describer
from deixis.perception.features.descriptors.d2_extents import D2ExtentsDescriber
from deixis.perception.features.descriptors.form import FormDescriber
from deixis.perception.features.descriptors.fpfh import FpfhDescriber
from deixis.perception.features.descriptors.good import GoodDescriber
from deixis.perception.features.descriptors.spin_images import SpinImageDescriber
from deixis.perception.features.descriptors.upright import UprightDescriber

DESCRIBERS: Mapping[str, Callable[[], Describer]] = MappingProxyType(
    {
        "spin_images": SpinImageDescriber,
        "fpfh": FpfhDescriber,
        "good": GoodDescriber,
        "d2_extents": D2ExtentsDescriber,
        "upright": UprightDescriber,
        "form": FormDescriber,
    }
)
"""Factories of describers with default settings; to add a descriptor, add a line."""


def describer_named(name: str) -> Describer:
    """Return a describer with its default settings.

    Parameters
    ----------
    name
        Name of the descriptor, such as ``spin_images``.

    Returns
    -------
    Describer
        The describer.

    Raises
    ------
    UnknownTermError
        If no describer has that name.

    Examples
    --------
    >>> describer_named("spin_images").size
    153
    """
    if name not in DESCRIBERS:
        raise UnknownTermError(f"unknown descriptor '{name}'; choose one of {', '.join(DESCRIBERS)}")
    return DESCRIBERS[name]()
