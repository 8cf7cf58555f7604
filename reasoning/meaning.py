"""How words and things are taken: the models of relation words, the sizes of kinds, and what each evidence weighs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from deixis.ontology.relation_models import RelationModels
from deixis.ontology.size_model import SizeModel
from deixis.reasoning.graded.unary import UnaryWeights


@dataclass(frozen=True, eq=False)
class Meaning:
    """What grounding goes by beside the script and the scene; the default is what is shipped.

    ``models`` are those of the relation words (None: the shipped ones); ``sizes``, by class IRI, take the place of the
    usual sizes of the TBox. ``graded`` False takes words literally: a pair bears the word's name, implies it, or not.
    """

    models: RelationModels | None = None
    sizes: Mapping[str, SizeModel] = field(default_factory=dict)
    graded: bool = True
    weights: UnaryWeights = field(default_factory=UnaryWeights)


LITERAL = Meaning(graded=False)
"""Crisp words, and all the rest as shipped."""

SHIPPED = Meaning()
