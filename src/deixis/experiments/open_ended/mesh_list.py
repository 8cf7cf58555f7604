"""List the corrections to the tabletop meshes, frozen before the first measurement (docs/explanation/open_ended.md).

Meshes come in their makers' units and poses. Most scales follow from the rule of
:func:`deixis.experiments.open_ended.things.in_metres`. Where that rule, or the source's axis, is plainly wrong and the
truth is clear, the mesh is corrected here. Where the truth is not clear, or a class holds things that share no form
with the rest of it, the mesh is left out. Every entry says why.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Correction:
    """A correction of a mesh that the general rules get wrong: its longest side in metres, or that y points up."""

    why: str
    longest: float | None = None
    y_up: bool | None = None


CORRECTED: Mapping[str, Correction] = MappingProxyType(
    {
        "carton/libero--orange_juice-obj.ply": Correction(
            "a carton that lies on its side; its y axis is up", y_up=True
        ),
        "vase/sh3d-Scopia--vase3-obj.ply": Correction(
            "5 cm by the rule, as it measures 5.09 units; the unit of its maker's other vases is the decimetre", 0.509
        ),
        "glass/sh3d-KatorLegaz--12-oz-glass-obj.ply": Correction(
            "7 cm by the rule; a glass of this form that holds the 12 fl oz of its name is 10 cm high", 0.10
        ),
        "plate/sh3d-KatorLegaz--bread-plate-obj.ply": Correction(
            "10 cm by the rule; bread plates measure 13 to 18 cm", 0.155
        ),
    }
)

EXCLUDED: Mapping[str, str] = MappingProxyType(
    {
        "bowl/sh3d-Scopia--bowl-obj.ply": "out of scale: 40 cm as a metre is its unit, 4 cm as a decimetre is",
        "mug/sh3d-Scopia--cup-obj.ply": "two things: a cup on its saucer",
        "shoe/sh3d-Scopia--woman_shoes-obj.ply": "two things: a pair, where the other shoes are single",
        "shoe/sh3d-Scopia--sneakers-obj.ply": "two things: a pair, where the other shoes are single",
        "pan/sh3d-BlendSwap-CC-BY--largePan-obj.ply": "overlapping classes: a stock pot with a lid among pans",
        "pan/object_sim--fryingpan-stl.ply": "the only pan that is left",
        "fruit/object_sim--apple-stl.ply": "a class without a common form: an apple and a banana",
        "fruit/ycb--YcbBanana-obj.ply": "a class without a common form: an apple and a banana",
    }
)
