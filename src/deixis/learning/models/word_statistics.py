"""Statistics of the fit of relation words, kept in a memory, so that a lesson can be removed from the fit later.

They are stored in a graph of their own under ``statistics``: the sums as one JSON text, and a key for each lesson that
the sums include. Lessons with the same script and scene share a key.
"""

from __future__ import annotations

import base64
import json
from urllib.parse import quote, unquote

import numpy as np
import pyoxigraph as ox
from numpy.typing import NDArray

from deixis.learning.models.words import LearnedWords
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.graphs import STATISTICS, ModelSet, models_graph
from deixis.ontology.models.relation_triples import models_from_triples
from deixis.ontology.rdf.triples import iri, text
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.reasoning.grounding.fitting.fit import DegreeSum, FitStatistics

GRAPH = iri(STATISTICS + "words")
SUMS, SAYS = iri(STATISTICS + "sums"), iri(STATISTICS + "says")


def replacing(words: LearnedWords | None) -> list[ledger.Operation]:
    """Return the operations that replace the stored statistics of learned words.

    Parameters
    ----------
    words
        The learned words; None only removes the statistics.

    Returns
    -------
    list of ledger.Operation
        Operations on the store.
    """
    operations = [ledger.drop(GRAPH)]
    if words is not None and words.statistics is not None and words.taught:
        sums = json.dumps({"made": _made(words), **_packed(words.statistics)}, sort_keys=True)
        lessons = [ox.Triple(_lesson(id), SAYS, text(key)) for id, key in sorted(words.texts.items())]
        operations += ledger.insertion(GRAPH, [ox.Triple(GRAPH, SUMS, text(sums)), *lessons])
    return operations


def stored_words(store: ox.Store) -> LearnedWords | None:
    """Return the learned models of a store with their statistics.

    Parameters
    ----------
    store
        The store.

    Returns
    -------
    LearnedWords or None
        The models, or None if no statistics match them.
    """
    quad = next(store.quads_for_pattern(GRAPH, SUMS, None, GRAPH), None)
    changed = models_from_triples(ledger.triples_in(store, models_graph(ModelSet.WORDS)))
    if quad is None or not changed:
        return None
    packed = json.loads(str(getattr(quad.object, "value", "")))
    says = ((str(getattr(q.subject, "value", "")), q) for q in store.quads_for_pattern(None, SAYS, None, GRAPH))
    texts = {_id(subject): str(getattr(quad.object, "value", "")) for subject, quad in says}
    taught = tuple(model.name for model in changed)
    words = LearnedWords(
        shipped_models().replaced(*changed), taught, tuple(sorted(texts)), statistics=_unpacked(packed), texts=texts
    )
    return words if packed["made"] == _made(words) else None


def _made(words: LearnedWords) -> str | None:
    made = words.changed[0].provenance.made
    return made.isoformat(timespec="milliseconds") if made else None


def _lesson(id: str) -> ox.NamedNode:
    return iri(f"{GRAPH.value}/lesson/{quote(id, safe='')}")


def _id(node: str) -> str:
    return unquote(node.rpartition("/")[2])


def _packed(sums: FitStatistics) -> dict[str, object]:
    upper = sums.information[np.triu_indices(len(sums.values))]
    return {
        "names": sums.names,
        "values": _written(sums.values),
        "gradient": _written(sums.gradient),
        "information": _written(upper),
        "examples": sums.examples,
        "degrees": {name: (one.count, one.total, _written(one.slope)) for name, one in sums.degrees.items()},
        "scenes": sums.scenes,
        "fitted": sums.fitted,
    }


def _unpacked(packed: dict[str, object]) -> FitStatistics:
    values, gradient, upper = (_read(packed[name]) for name in ("values", "gradient", "information"))
    information = np.zeros((len(values), len(values)))
    rows, columns = np.triu_indices(len(values))
    information[rows, columns] = information[columns, rows] = upper
    degrees = {
        str(name): DegreeSum(int(count), float(total), _read(slope))
        for name, (count, total, slope) in dict(packed["degrees"]).items()  # type: ignore[call-overload]
    }
    return FitStatistics(
        tuple(packed["names"]),  # type: ignore[arg-type]
        values,
        gradient,
        information,
        dict(packed["examples"]),  # type: ignore[call-overload]
        degrees,
        int(packed["scenes"]),  # type: ignore[call-overload]
        int(packed["fitted"]),  # type: ignore[call-overload]
    )


def _written(numbers: NDArray[np.float64]) -> str:
    return base64.b64encode(numbers.astype("<f8").tobytes()).decode("ascii")


def _read(written: object) -> NDArray[np.float64]:
    return np.frombuffer(base64.b64decode(str(written)), dtype="<f8").astype(np.float64)
