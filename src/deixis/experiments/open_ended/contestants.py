"""The learners that are compared, each made anew for every course."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from deixis.perception.recognition.learners.committee import Committee
from deixis.perception.recognition.learners.instance_based import InstanceBased
from deixis.perception.recognition.learners.learner import Learner
from deixis.perception.recognition.learners.naive_bayes import Codebook, NaiveBayes
from deixis.perception.recognition.learners.one_class import SupportVectorDescription
from deixis.perception.recognition.learners.vector_quantisation import VectorQuantisation
from deixis.perception.recognition.settings import PAPER

EQUATIONS = "equations 1-4"
THINGS = "ICD of things"
NEAREST = "equations 1-2"
D2 = "d2_extents"
SPIN = "spin_images"
SVDD = "SVDD"
UPRIGHT = "upright"

Contestants = Mapping[str, Callable[[], Learner]]


def contestants(codebook: Codebook) -> Contestants:
    """Return every learner by name, the paper's as it stands first, and then as it is by default."""
    return {
        EQUATIONS: lambda: InstanceBased(settings=PAPER, name=EQUATIONS),
        THINGS: lambda: InstanceBased(name=THINGS),
        UPRIGHT: lambda: InstanceBased(UPRIGHT, root=False, name=UPRIGHT),
        NEAREST: lambda: InstanceBased(by_distance=True, name=NEAREST),
        "D2 and extents": lambda: InstanceBased(D2, root=False, by_distance=True, name="D2 and extents"),
        SVDD: SupportVectorDescription,
        "committee": lambda: Committee(
            [
                InstanceBased(name=THINGS),
                InstanceBased("good", name="good"),
                InstanceBased(D2, name=D2),
                NaiveBayes(codebook),
            ]
        ),
        "LVQ": VectorQuantisation,
        "naive Bayes": lambda: NaiveBayes(codebook),
    }
