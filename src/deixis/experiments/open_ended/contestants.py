"""List the learners to compare; each course makes new ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from deixis.perception.recognition.learners.committee import Committee
from deixis.perception.recognition.learners.instance_based import InstanceBased
from deixis.perception.recognition.learners.learner import Learner
from deixis.perception.recognition.learners.naive_bayes import Codebook, NaiveBayes
from deixis.perception.recognition.learners.one_class import SupportVectorDescription
from deixis.perception.recognition.learners.vector_quantisation import VectorQuantisation
from deixis.perception.recognition.settings import PAPER, RecognitionSettings

EQUATIONS = "equations 1-4"
THINGS = "ICD of things"
NEAREST = "equations 1-2"
D2 = "d2_extents"
SPIN = "spin_images"
SVDD = "SVDD"
UPRIGHT = "upright"

DRAWN = RecognitionSettings(shrinkage=5.0)
"""ICD over things, shrunk to the median by five things; docs/explanation/open_ended.md reports its results."""

Contestants = Mapping[str, Callable[[], Learner]]


def contestants(codebook: Codebook) -> Contestants:
    """Return every learner by name: the paper's as published, then its default settings, then the others.

    Parameters
    ----------
    codebook
        Codebook of spin images for the learners that count words.

    Returns
    -------
    dict
        Function that makes an untaught learner, by name.
    """
    return {
        EQUATIONS: lambda: InstanceBased(settings=PAPER, name=EQUATIONS),
        THINGS: lambda: InstanceBased(settings=DRAWN, name=THINGS),
        UPRIGHT: lambda: InstanceBased(UPRIGHT, root=False, settings=DRAWN, name=UPRIGHT),
        NEAREST: lambda: InstanceBased(by_distance=True, settings=DRAWN, name=NEAREST),
        "D2 and extents": lambda: InstanceBased(
            D2, root=False, by_distance=True, settings=DRAWN, name="D2 and extents"
        ),
        SVDD: SupportVectorDescription,
        "committee": lambda: Committee(
            [
                InstanceBased(settings=DRAWN, name=THINGS),
                InstanceBased("good", settings=DRAWN, name="good"),
                InstanceBased(D2, settings=DRAWN, name=D2),
                NaiveBayes(codebook),
            ]
        ),
        "LVQ": VectorQuantisation,
        "naive Bayes": lambda: NaiveBayes(codebook),
    }
