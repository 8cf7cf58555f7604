"""What a relation word means, as lines and as plain data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from deixis.ontology.allen import SYMBOLS
from deixis.ontology.models.relations import RelationModel, RelationModels
from deixis.ontology.relation import Relation, Relations

if TYPE_CHECKING:
    from deixis.learning.words import LearnedWords


def relation_lines(relation: Relation, relations: Relations, models: RelationModels) -> list[str]:
    """The word's atoms in both readings, its inverse and synonyms, and the parameters of its graded model."""
    wide = relations[relation.word]
    lines = [f"{wide.name}: {wide.phrase}", f"inverse     {wide.inverse}", f"words       {', '.join(wide.words)}"]
    for one in (wide, relations.exact(wide)):
        lines.append(f"{one.reading.value:<11} x {_signs(one.x_atoms)}; y {_signs(one.y_atoms)}{_height(one)}")
    model = models.of(wide)
    lines.append(f"graded      model '{model.name}', {_origin(model)}")
    lines.append(f"            outliers {model.outliers:g}, degree by chance {model.chance:.3f}")
    for term in model.terms:
        points = ", ".join(f"{knot:g}: {_degree(value)}" for knot, value in zip(term.knots, term.values, strict=True))
        lines.append(f"  {term.feature:<10}{points}")
    return lines


def relation_to_dict(relation: Relation, relations: Relations, models: RelationModels) -> dict[str, Any]:
    """The same as plain data; ``log_degrees`` are natural logarithms."""
    wide = relations[relation.word]
    return {
        "word": wide.name,
        "phrase": wide.phrase,
        "inverse": wide.inverse,
        "synonyms": list(wide.words),
        "readings": {one.reading.value: _atoms(one) for one in (wide, relations.exact(wide))},
        "graded": model_to_dict(models.of(wide)),
    }


def model_to_dict(model: RelationModel) -> dict[str, Any]:
    """A model's parameters and where they come from."""
    origin = model.provenance
    return {
        "model": model.name,
        "outliers": model.outliers,
        "chance": model.chance,
        "terms": [
            {
                "feature": term.feature,
                "knots": list(term.knots),
                "log_degrees": list(term.values),
                "trend": term.trend.name.lower(),
            }
            for term in model.terms
        ],
        "learned_from": [*origin.sources, *origin.lessons],
        "examples": origin.examples,
        "made": origin.made.isoformat() if origin.made else None,
    }


def learned_words_lines(learned: LearnedWords) -> list[str]:
    """What was learned of which words, from what, and what taught nothing and why."""
    lines = [f"{model.name:<11} learned from {_facts(model)}" for model in learned.changed]
    for word, ids in (("lessons", learned.lessons), ("kept as", learned.kept)):
        lines += [f"{word:<11} {', '.join(ids)}"] if ids else []
    lines += [f"left out    {why}" for why in learned.left_out]
    return lines


def learned_words_to_dict(learned: LearnedWords, where: str) -> dict[str, Any]:
    """The same as plain data, with the models' parameters."""
    return {
        "learned": [model_to_dict(model) for model in learned.changed],
        "lessons": list(learned.lessons),
        "kept": list(learned.kept),
        "left_out": list(learned.left_out),
        "written": where,
    }


def _atoms(relation: Relation) -> dict[str, list[str]]:
    masks = {"x": relation.x_atoms, "y": relation.y_atoms, "z": relation.z_atoms}
    return {axis: _members(mask) for axis, mask in masks.items() if mask}


def _members(mask: int) -> list[str]:
    return [sign for code, sign in enumerate(SYMBOLS) if mask >> code & 1]


def _signs(mask: int) -> str:
    return "any" if mask == (1 << 13) - 1 else " ".join(_members(mask))


def _height(relation: Relation) -> str:
    return f"; settled on z by {_signs(relation.z_atoms)}" if relation.z_atoms else ""


def _origin(model: RelationModel) -> str:
    origin = model.provenance
    if origin.made is None:
        return "shipped, from prototypes"
    scenes = len(origin.sources) + len(origin.lessons)
    of = "one scene" if scenes == 1 else f"{scenes} scenes"
    return f"learned from {_facts(model)} of {of} on {origin.made:%Y-%m-%d}"


def _facts(model: RelationModel) -> str:
    """How many facts taught a model, by how sure they were, so that the number need not be whole."""
    number = round(model.provenance.examples, 1)
    return f"{number:g} fact" if number == 1 else f"{number:g} facts"


def _degree(value: float) -> str:
    from math import exp

    return f"{exp(value):.2g}"
