"""List the contestants: the engines, and variants of the default one, each with its settings in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.scoreboard.cases import Case
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.properties.unary import UnaryWeights
from deixis.reasoning.grounding.evidence.words.meaning import LITERAL, SHIPPED, Meaning
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.options import EngineName

DEFAULT = EngineName.EXACT.value


@dataclass(frozen=True, eq=False)
class ContestantAnswer:
    """An answer: a map (n1,), whether it is proved the best, and the probabilities (n1, n2 + 1)."""

    assignment: NDArray[np.int64]
    proved: bool = False
    marginals: NDArray[np.float64] | None = None
    error: float | NDArray[np.float64] = 0.0  # uncertainty of the probabilities, one number or (n1,) per object


@dataclass(frozen=True)
class Contestant:
    """A way to ground: ``solve`` gets the evidence and a deadline."""

    name: str
    settings: str
    solve: Callable[[Evidence, Deadline], ContestantAnswer]
    most: int = 1000  # maximum number of objects; more take too long or too much memory
    meaning: Meaning = SHIPPED
    ablation: bool = False  # the default engine with a part removed
    learned: bool = False  # words and sizes are learned from other cases; enters only cases that have learned ones
    lacking: str = ""  # the reason why it cannot run at all

    def enters(self, case: Case) -> bool:
        """Return True if the contestant can take the case.

        Parameters
        ----------
        case
            Case of the scoreboard.

        Returns
        -------
        bool
            False for a case that is too large, or that has no learned meaning where the contestant needs one.
        """
        return case.setting.size <= self.most and (case.learned is not None or not self.learned)


def engine(
    name: str,
    settings: str,
    *,
    called: str = "",
    most: int = 1000,
    meaning: Meaning = SHIPPED,
    ablation: bool = False,
    learned: bool = False,
) -> Contestant:
    """Return a shipped engine as a contestant, optionally under another name and with another meaning.

    Parameters
    ----------
    name
        Name of a shipped engine.
    settings
        Description of the settings, for the report.
    called
        Name of the contestant; empty for that of the engine.
    most
        Maximum number of objects of its cases.
    meaning
        Meaning of the words and weights of the evidence.
    ablation
        True if a part is switched off.
    learned
        True to use the meaning that was learned from other cases.

    Returns
    -------
    Contestant
        Contestant that gives probabilities if the engine does.
    """

    def solve(evidence: Evidence, deadline: Deadline) -> ContestantAnswer:
        found = engine_named(name).align(evidence, deadline)
        if found.posterior is None:
            return ContestantAnswer(found.assignment, found.proved_best)
        return ContestantAnswer(found.assignment, found.proved_best, found.posterior.marginals, found.posterior.errors)

    return Contestant(called or name, settings, solve, most, meaning, ablation, learned)


def peer(
    name: str, settings: str, solve: Callable[[Problem, float], ContestantAnswer], *, most: int, lacking: str = ""
) -> Contestant:
    """Return another solver of the problem (graded meaning) as a contestant.

    Parameters
    ----------
    name
        Name of the contestant.
    settings
        Description of the settings, for the report.
    solve
        Function of the problem and the remaining time in seconds.
    most
        Maximum number of objects of its cases.
    lacking
        Reason why it cannot take part, such as a package that is not installed; empty if it can.

    Returns
    -------
    Contestant
        Contestant of the scoreboard.
    """
    return Contestant(
        name,
        settings,
        lambda evidence, deadline: solve(evidence.problem, deadline.left),
        most,
        lacking=lacking,
    )


def engines() -> list[Contestant]:
    """Return the shipped engines, the default first, and the default with words taken literally.

    Returns
    -------
    list of Contestant
        Contestants with their settings.
    """
    return [
        engine(EngineName.EXACT, "the default: branch and bound to the time limit, with probabilities"),
        engine(EngineName.SCALABLE, "annealing and belief propagation, with probabilities"),
        engine(EngineName.SIMILARITY, "the paper's: equations 5 to 9, the Hungarian method"),
        engine(EngineName.BLONDEL, "Blondel et al. 2004, to convergence, 100 steps or the limit", most=300),
        engine(EngineName.HEYMANS_SINGH, "Heymans and Singh 2003, to convergence, 100 steps or the limit", most=300),
        engine(EngineName.EXACT, "ablation: words literally", called="graded off", meaning=LITERAL, ablation=True),
    ]


def ablations() -> list[Contestant]:
    """Return the default engine with and without graded meaning and sizes, and, on photographs, with learned ones.

    Returns
    -------
    list of Contestant
        Variants of the default engine, the unchanged one first.
    """
    no_sizes = UnaryWeights(labels=1.0, sizes=0.0)
    variants = {
        DEFAULT: SHIPPED,
        "graded off": LITERAL,
        "unary off": Meaning(weights=no_sizes),
        "both off": Meaning(graded=False, weights=no_sizes),
    }
    return [
        *(
            engine(EngineName.EXACT, name, called=name, meaning=meaning, ablation=name != DEFAULT)
            for name, meaning in variants.items()
        ),
        engine(EngineName.EXACT, "", called="learned words", meaning=Meaning(weights=no_sizes), learned=True),
        engine(EngineName.EXACT, "", called="learned, all", learned=True),
    ]
