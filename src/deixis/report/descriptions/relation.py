"""Relation words and their models as lines of text and as plain data for JSON."""

from __future__ import annotations

from collections.abc import Iterator
from math import exp
from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.memory.semantic.rdf.files import short
from deixis.ontology.models.relations import RelationModel, RelationModels
from deixis.ontology.relations.allen import SYMBOLS
from deixis.ontology.relations.relation import Relation, Relations

if TYPE_CHECKING:
    from deixis.learning.models.words import LearnedWords
    from deixis.reasoning.grounding.evidence.words.meaning import Meaning
    from deixis.workflows.descriptions.learn_reference import LearnedReference


def relation_lines(relation: Relation, relations: Relations, models: RelationModels) -> list[str]:
    """Return the word's atoms in its readings, its inverse and synonyms, and the parameters of its graded model.

    Parameters
    ----------
    relation
        Relation in any of its readings; the lines describe all of them.
    relations
        All relations of the ontology.
    models
        Graded models of the words.

    Returns
    -------
    list of str
        Aligned lines. A point of a graded term is printed as its knot and its degree, not the logarithm.
    """
    wide = relations[relation.word]
    lines = [f"{wide.name}: {wide.phrase}", f"inverse     {wide.inverse}", f"words       {', '.join(wide.words)}"]
    for one in dict.fromkeys((wide, relations.exact(wide))):
        height = f"; z {_signs(one.z_atoms)}" if one.z_atoms else ""
        lines.append(f"{one.reading.value:<11} x {_signs(one.x_atoms)}; y {_signs(one.y_atoms)}{height}")
    model = models.of(wide)
    lines.append(f"graded      model '{model.name}', {_origin(model)}")
    lines.append(f"            outliers {model.outliers:g}, degree by chance {model.chance:.3f}")
    for term in model.terms:
        points = ", ".join(f"{knot:g}: {exp(value):.2g}" for knot, value in zip(term.knots, term.values, strict=True))
        lines.append(f"  {term.feature:<10}{points}")
    return lines


def _origin(model: RelationModel) -> str:
    """Return where a model comes from, in words."""
    origin = model.provenance
    if origin.made is None:
        return "shipped, from prototypes"
    scenes = len(origin.sources) + len(origin.lessons)
    of = "one scene" if scenes == 1 else f"{scenes} scenes"
    return f"learned from {_facts(model)} of {of} on {origin.made:%Y-%m-%d}"


def meaning_lines(meaning: Meaning) -> list[str]:
    """Return how words are read, where the model of each family of words comes from, and the learned sizes.

    Parameters
    ----------
    meaning
        Models of words and sizes.

    Returns
    -------
    list of str
        A line for the reading, one for each model, and one for each kind with a learned size.
    """
    reading = "by degrees" if meaning.graded else "literally"
    lines = [f"Words are read {reading}."]
    lines += [f"{model.name:<16} {_origin(model)}" for model in meaning.models_in_force.models.values()]
    for row in _size_rows(meaning):
        unit = "of the median length of the scene" if row["relative"] else "m"
        lines.append(f"{row['kind']:<16} length {row['length']:.3g} {unit}, aspect {row['aspect']:.2g}")
    return lines


def meaning_to_dict(meaning: Meaning) -> dict[str, Any]:
    """Return models of words and sizes as plain data.

    Parameters
    ----------
    meaning
        Models of words and sizes.

    Returns
    -------
    dict
        Data for JSON with the keys ``graded``, ``models`` and ``sizes``, which are the learned ones.
    """
    models = [model_to_dict(model) for model in meaning.models_in_force.models.values()]
    return {"graded": meaning.graded, "models": models, "sizes": list(_size_rows(meaning))}


def meaning_rows(meaning: Meaning) -> list[dict[str, Any]]:
    """Return a row for each model of words, with the number of facts that taught it.

    Parameters
    ----------
    meaning
        Models of words and sizes.

    Returns
    -------
    list of dict
        ``model``, ``outliers``, ``chance``, ``facts`` and ``made``, which is None for a shipped model.
    """
    return [
        {
            "model": model.name,
            "outliers": model.outliers,
            "chance": model.chance,
            "facts": model.provenance.examples,
            "made": model.provenance.made,
        }
        for model in meaning.models_in_force.models.values()
    ]


def _size_rows(meaning: Meaning) -> Iterator[dict[str, Any]]:
    """Yield the medians and deviations of each learned size, sorted by kind."""
    for kind, size in sorted(meaning.sizes.items()):
        yield {
            "kind": short(kind),
            "length": exp(size.length[0]),
            "log_length_deviation": size.length[1],
            "aspect": exp(size.aspect[0]),
            "log_aspect_deviation": size.aspect[1],
            "relative": size.relative,
            "views": size.views,
        }


def relation_to_dict(relation: Relation, relations: Relations, models: RelationModels) -> dict[str, Any]:
    """Return a relation word as plain data: its readings, its inverse and synonyms, and its graded model.

    Parameters
    ----------
    relation
        Relation in any of its readings.
    relations
        All relations of the ontology.
    models
        Graded models of the words.

    Returns
    -------
    dict
        Data for JSON. ``readings`` has the atoms of each axis; ``log_degrees`` are natural logarithms of degrees.
    """
    wide = relations[relation.word]
    readings = {}
    for one in dict.fromkeys((wide, relations.exact(wide))):
        masks = {"x": one.x_atoms, "y": one.y_atoms, "z": one.z_atoms}
        readings[one.reading.value] = {axis: _members(mask) for axis, mask in masks.items() if mask}
    return {
        "word": wide.name,
        "phrase": wide.phrase,
        "inverse": wide.inverse,
        "synonyms": list(wide.words),
        "readings": readings,
        "graded": model_to_dict(models.of(wide)),
    }


def model_to_dict(model: RelationModel) -> dict[str, Any]:
    """Return a model's parameters and where they come from.

    Parameters
    ----------
    model
        Graded model of a relation word.

    Returns
    -------
    dict
        Data for JSON. ``log_degrees`` are natural logarithms of the degrees at ``knots``; ``made`` is an ISO 8601 time,
        or None for a shipped model.
    """
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
    """Return which words were learned, from how many facts, and which examples were left out and why.

    Parameters
    ----------
    learned
        Result of learning words from lessons or scenes.

    Returns
    -------
    list of str
        A line for each changed model, one for the lessons, one for the names under which scenes were kept, and one for
        each example left out.
    """
    lines = [f"{model.name:<11} learned from {_facts(model)}" for model in learned.changed]
    for word, ids in (("lessons", learned.lessons), ("kept as", learned.kept)):
        lines += [f"{word:<11} {', '.join(ids)}"] if ids else []
    lines += [f"left out    {why}" for why in learned.left_out]
    return lines


def learned_words_to_dict(learned: LearnedWords, where: str | None = None) -> dict[str, Any]:
    """Return learned words as plain data, with the parameters of their models.

    Parameters
    ----------
    learned
        Result of learning words from lessons or scenes.
    where
        File or memory that the models were written to; None if unknown.

    Returns
    -------
    dict
        Data for JSON with the keys ``learned``, ``lessons``, ``kept``, ``left_out`` and ``written``.
    """
    return {
        "learned": [model_to_dict(model) for model in learned.changed],
        "lessons": list(learned.lessons),
        "kept": list(learned.kept),
        "left_out": list(learned.left_out),
        "written": where,
    }


def learned_words_rows(learned: LearnedWords) -> Iterator[dict[str, Any]]:
    """Yield a row for each model that changed.

    Parameters
    ----------
    learned
        Result of learning words from lessons or scenes.

    Yields
    ------
    dict
        ``model``, the number of ``facts`` that taught it, weighted by their certainty, and the time when it was
        ``made``.
    """
    for model in learned.changed:
        yield {"model": model.name, "facts": model.provenance.examples, "made": model.provenance.made}


MAX_LISTED = 10
"""Maximum number of words that the text lists with their changes."""


def learned_reference_lines(learned: LearnedReference) -> list[str]:
    """Return from how many descriptions the words of reference were learned, and which weights changed most.

    Parameters
    ----------
    learned
        Result of learning the weights of words of reference.

    Returns
    -------
    list of str
        The number of descriptions, with those that were right before and after; at most :data:`MAX_LISTED` changes of
        weights; the examples left out.
    """
    before, after = learned.right
    lines = [f"learned from {count(learned.descriptions, 'description')}; right before: {before}, now: {after}"]
    if not learned.converged:
        lines.append(f"the fit ended after {count(learned.steps, 'step')}, before it converged")
    lines += [f"{name:<24} changed by up to {step:.2f}" for name, step in [*learned.changed.items()][:MAX_LISTED]]
    return lines + [f"left out    {why}" for why in learned.left_out]


def learned_reference_to_dict(learned: LearnedReference, where: str | None = None) -> dict[str, Any]:
    """Return learned words of reference as plain data.

    Parameters
    ----------
    learned
        Result of learning the weights of words of reference.
    where
        File that the weights were written to; None if unknown.

    Returns
    -------
    dict
        Data for JSON. ``right_before`` and ``right_after`` count descriptions; ``changed`` holds the largest change by
        name.
    """
    return {
        "descriptions": learned.descriptions,
        "right_before": learned.right[0],
        "right_after": learned.right[1],
        "converged": learned.converged,
        "steps": learned.steps,
        "changed": dict(learned.changed),
        "left_out": list(learned.left_out),
        "written": where,
    }


def learned_reference_rows(learned: LearnedReference) -> Iterator[dict[str, Any]]:
    """Yield a row for each word or feature family whose weights changed.

    Parameters
    ----------
    learned
        Result of learning the weights of words of reference.

    Yields
    ------
    dict
        ``word``, and the largest ``change`` of a weight of it.
    """
    for word, change in learned.changed.items():
        yield {"word": word, "change": change}


def _members(mask: int) -> list[str]:
    return [sign for code, sign in enumerate(SYMBOLS) if mask >> code & 1]


def _signs(mask: int) -> str:
    return "any" if mask == (1 << 13) - 1 else " ".join(_members(mask))


def _facts(model: RelationModel) -> str:
    """Return the number of facts that taught a model, weighted by their certainty, so not always a whole number."""
    number = round(model.provenance.examples, 1)
    return f"{number:g} fact" if number == 1 else f"{number:g} facts"
