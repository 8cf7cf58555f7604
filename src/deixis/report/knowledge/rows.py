"""Answers as rows of tables, for data frames and notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.learning.views.views import Recognised
    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.ontology.graph.facts import Fact
    from deixis.perception.scene import Scene
    from deixis.reasoning.grounding.answers.answer import Grounding
    from deixis.workflows.grounding.check import Check
    from deixis.workflows.grounding.retrieve import Retrieval
    from deixis.workflows.knowledge.learn import Learned
    from deixis.workflows.layouts.imagine import Imagination
    from deixis.workflows.layouts.infer import Inference

Row = dict[str, Any]


def script_rows(script: Script) -> Iterator[Row]:
    """Yield a row for each stated fact.

    Parameters
    ----------
    script
        Script; its claims, which need not have two objects, are left out.

    Yields
    ------
    dict
        The fact, and its ``line`` in the file, counted from 1.
    """
    return facts_rows(script.facts)


def facts_rows(facts: Iterable[Fact]) -> Iterator[Row]:
    """Yield a row for each of some facts.

    Parameters
    ----------
    facts
        The facts.

    Yields
    ------
    dict
        The fact, and its ``line`` in its file, counted from 1; None if it comes from no file.
    """
    for fact in facts:
        yield _fact_row(fact) | {"line": fact.source.line if fact.source else None}


def inference_rows(inference: Inference) -> Iterator[Row]:
    """Yield a row for each stated and inferred fact, or for each fact of the conflict.

    Parameters
    ----------
    inference
        Answer of ``deixis infer``.

    Yields
    ------
    dict
        The fact with its ``status``: *stated*, *inferred* (also ``rule`` and ``steps``) or *in conflict*.
    """
    if inference.conflict is not None:
        yield from (_fact_row(fact) | {"status": "in conflict"} for fact in inference.conflict.facts)
        return
    yield from (_fact_row(fact) | {"status": "stated"} for fact in inference.stated)
    yield from (
        _fact_row(entry.fact) | {"status": "inferred", "rule": entry.rule.value, "steps": entry.steps}
        for entry in inference.each_inferred()
    )


def _fact_row(fact: Fact) -> Row:
    return {
        "subject": fact.subject,
        "relation": " or ".join(relation.word for relation in fact.relations),
        "object": fact.object,
        "positive": fact.positive,
        "optional": fact.optional,
        "weight": fact.weight,
    }


def scene_rows(scene: Scene) -> Iterator[Row]:
    """Yield a row for each perceived object, with its box.

    Parameters
    ----------
    scene
        Scene in two or three dimensions.

    Yields
    ------
    dict
        ``id``, ``label``, ``confidence`` (None without a label), and the box as ``min_x``, ``min_y``, … in the unit of
        the scene.
    """
    for thing in scene.objects:
        axes = "xyz"[: len(thing.minimum)]
        box = {f"min_{axis}": low for axis, low in zip(axes, thing.minimum, strict=True)}
        box |= {f"max_{axis}": high for axis, high in zip(axes, thing.maximum, strict=True)}
        yield {"id": thing.id, "label": thing.label, "confidence": thing.confidence if thing.label else None} | box


def grounding_rows(found: Grounding) -> Iterator[Row]:
    """Yield a row for each object of the description, matched or left out.

    Parameters
    ----------
    found
        Answer of ``deixis ground``.

    Yields
    ------
    dict
        ``object``, ``perceived`` (None if left out), ``probability``, ``decided``, and the ``alternatives`` as text,
        which is empty for a decided match.
    """
    for match in found.matches.values():
        others = ", ".join(other.perceived or "absent" for other in match.alternatives)
        yield {
            "object": match.object,
            "perceived": match.perceived,
            "probability": match.probability,
            "decided": match.decided,
            "alternatives": "" if match.decided else others,
        }
    for left in found.unmatched_objects:
        others = ", ".join(other.perceived or "absent" for other in left.alternatives)
        yield {"object": left.name, "perceived": None, "probability": None, "decided": False, "alternatives": others}


def learned_rows(learned: Learned) -> Iterator[Row]:
    """Yield a row for each object of the script that a lesson was learned from.

    Parameters
    ----------
    learned
        Answer of ``deixis learn``.

    Yields
    ------
    dict
        The row of its grounding (:func:`grounding_rows`).
    """
    return grounding_rows(learned.grounding)


def check_rows(checked: Check) -> Iterator[Row]:
    """Yield a row for each role of the layout, and for each extra thing.

    Parameters
    ----------
    checked
        Answer of ``deixis check``.

    Yields
    ------
    dict
        ``object`` (None for an extra thing), ``perceived``, ``verdict``, and the ``violated`` facts as text.
    """
    for role in checked.table.roles:
        yield {
            "object": role.role,
            "perceived": role.perceived,
            "verdict": role.verdict.value,
            "violated": "; ".join(str(entry.fact) for entry in role.broken),
        }
    for extra in checked.table.extra:
        yield {"object": None, "perceived": extra.perceived, "verdict": "extra", "violated": extra.reason}


def imagination_rows(found: Imagination) -> Iterator[Row]:
    """Yield a row for each object of each example table, with its box.

    Parameters
    ----------
    found
        Answer of ``deixis imagine``.

    Yields
    ------
    dict
        ``table``, counted from 1, and the columns of :func:`scene_rows`.
    """
    for number, table in enumerate(found.tables, start=1):
        yield from ({"table": number} | row for row in scene_rows(table.scene))


def recognised_rows(found: Recognised) -> Iterator[Row]:
    """Yield a row for each object of the scene, with the name that it was recognised by.

    Parameters
    ----------
    found
        Answer of ``deixis recognise``.

    Yields
    ------
    dict
        ``id``, ``label`` (None if unknown), ``probability``, and the ``nearest`` category (None without candidates).
    """
    for name, answer in found.answers.items():
        nearest = answer.candidates[0].category if answer.candidates else None
        yield {"id": name, "label": answer.label, "probability": answer.probability, "nearest": nearest}


def retrieval_rows(found: Retrieval) -> Iterator[Row]:
    """Yield a row for each layout or scene that was retrieved.

    Parameters
    ----------
    found
        Answer of ``deixis retrieve``.

    Yields
    ------
    dict
        ``name``, the similarities, and ``proved_best``, which is False where the similarity is a lower bound.
    """
    for one in found.found:
        yield {
            "name": one.name,
            "similarity": one.similarity,
            "objects": one.objects,
            "relations": one.relations,
            "proved_best": one.proved,
        }


def query_rows(found: QueryResult) -> Iterator[Row]:
    """Yield a row for each solution or triple, or one for a yes or no.

    Parameters
    ----------
    found
        Result of a SPARQL query of any form.

    Yields
    ------
    dict
        Values by variable, None where a variable is unbound; or ``subject``, ``predicate`` and ``object``; or
        ``answer``.
    """
    if found.boolean is not None:
        yield {"answer": found.boolean}
    for row in found.printed():
        yield {name: None if term is None else _value(term) for name, term in zip(found.variables, row, strict=True)}
    for triple in found.triples:
        yield {name: _value(term) for name, term in zip(("subject", "predicate", "object"), triple, strict=True)}


def query_to_dict(found: QueryResult) -> dict[str, Any]:
    """Return SPARQL 1.1 results in JSON as plain data.

    Parameters
    ----------
    found
        Result of a SPARQL query of any form.

    Returns
    -------
    dict
        Data with the keys of the W3C format *SPARQL 1.1 Query Results JSON*.
    """
    import json

    return json.loads(found.to_json())  # type: ignore[no-any-return]


def query_lines(found: QueryResult) -> list[str]:
    """Return the aligned lines that ``deixis query`` prints, and its remarks.

    Parameters
    ----------
    found
        Result of a SPARQL query of any form.

    Returns
    -------
    list of str
        Lines without their ends.
    """
    return [*found.to_table(), *found.remarks()]


def _value(term: Any) -> Any:
    """Return a term as a Python value: a number or boolean for such a literal, else its text."""
    import pyoxigraph as ox
    from rdflib import Literal, URIRef

    if not isinstance(term, ox.Literal):
        return getattr(term, "value", str(term))
    value = Literal(term.value, datatype=URIRef(term.datatype.value)).toPython() if not term.language else term.value
    return value if isinstance(value, bool | int | float | str) else term.value
