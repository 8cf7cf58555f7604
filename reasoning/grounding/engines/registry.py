"""The engines that align a description with a scene, by name.

``exact`` finds the likeliest map by branch and bound and proves that it is the likeliest; ``scalable`` searches for it
by annealing, at any size. ``similarity`` is the paper's engine: equations 5 to 9, the Hungarian method, and a choice
among sub-graphs where one side has more objects. ``blondel`` and ``heymans-singh`` are node similarities from the
literature, for comparison. All engines break ties by the order of the evidence; to get an answer that does not depend
on that order, call :func:`deixis.reasoning.grounding.ground.ground`.
"""

from __future__ import annotations

from deixis.errors import UnknownTermError
from deixis.reasoning.grounding.engines.engine import Engine
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.hypotheses.hypotheses import STATED_SIDES, Side
from deixis.reasoning.grounding.options import EngineName, Select


def engine_named(
    name: str,
    select: Select = Select.FACTS,
    sides: tuple[Side, ...] = STATED_SIDES,
    seen: tuple[Evidence | None, ...] = (),
) -> Engine:
    """Return the engine with a name.

    Parameters
    ----------
    name
        One of :class:`EngineName`.
    select
        Criterion of the paper's engine for choosing among sub-graphs.
    sides
        Sides from which a description may be spoken; used by engines with a posterior
        (:func:`deixis.reasoning.grounding.hypotheses.hypotheses.weigh`).
    seen
        Evidence as seen from each of the sides, in their order; None to turn the scene instead.

    Returns
    -------
    Engine
        The engine, ready to be called.

    Raises
    ------
    UnknownTermError
        There is no engine of this name.
    """
    from deixis.reasoning.grounding.engines.baselines import blondel_similarity, heymans_singh_similarity
    from deixis.reasoning.grounding.engines.map_engines import BaselineEngine, ExactEngine, ScalableEngine

    if name == EngineName.SIMILARITY:
        from deixis.reasoning.grounding.engines.similarity_engine import SimilarityEngine

        return SimilarityEngine(select)
    if name == EngineName.EXACT:
        return ExactEngine(sides, seen)
    if name == EngineName.SCALABLE:
        return ScalableEngine(sides, seen)
    if name == EngineName.BLONDEL:
        return BaselineEngine("blondel", blondel_similarity)
    if name == EngineName.HEYMANS_SINGH:
        return BaselineEngine("heymans-singh", heymans_singh_similarity)
    raise UnknownTermError(f"there is no engine '{name}'; the engines are: {', '.join(EngineName)}")
