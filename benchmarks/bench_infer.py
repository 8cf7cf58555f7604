"""Time inference from order facts, beside a store's property path, graph libraries and description-logic reasoners.

Every peer gets its graph or store ready made and counts the pairs of *left*. Ours begins with the facts as arrays and
ends with every relation's pairs counted and the graph for explanations built; then one explanation of the longest kind
is timed by itself.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median

import networkx as nx
import numpy as np
import pyoxigraph as ox
from common import medians
from numpy.typing import NDArray
from rdflib import Graph, URIRef
from records import command_line, ratio, recorded, seconds

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.implications import Implications

R = default_ontology().relations
LEFT = R["left"]
Pairs = NDArray[np.int32]


def chain(n: int) -> tuple[int, Pairs]:
    """Return a chain of ``n`` objects in a row."""
    return n, np.stack([np.arange(n - 1), np.arange(1, n)], axis=1).astype(np.int32)


def tables(facts: int, size: int) -> tuple[int, Pairs]:
    """Return tables of ``size`` objects in a random order, each stated to be left of another one."""
    rng = np.random.default_rng(3)
    n = facts // size * size
    rows = []
    for first in range(0, n, size):
        order = first + rng.permutation(size)
        rows += [(order[i], order[i + 1]) for i in range(size - 1)]
        i, j = sorted(rng.choice(size, 2, replace=False))
        rows.append((order[i], order[j]))
    return n, np.array(rows, np.int32)


def graph_of(n: int, pairs: Pairs) -> RelationGraph:
    m = len(pairs)
    return RelationGraph(
        vocabulary=R,
        nodes=tuple(f"o{k}" for k in range(n)),
        subjects=pairs[:, 0],
        objects=pairs[:, 1],
        relation_sets=np.full(m, LEFT.bit, np.int64),
        positive=np.ones(m, np.bool_),
        optional=np.zeros(m, np.bool_),
        weights=np.ones(m),
    )


def ours(graph: RelationGraph) -> int:
    """Return the number of pairs of *left*, after counting all relations and building the graph for explanations."""
    implied = Implications(graph)
    counts = implied.counts()
    implied.prepare_explanations()
    return counts[LEFT]


def oxigraph(pairs: Pairs) -> Callable[[], int]:
    store = ox.Store()
    left = ox.NamedNode(LEFT.iri)
    nodes = {k: ox.NamedNode(f"urn:o{k}") for k in np.unique(pairs).tolist()}
    store.extend(ox.Quad(nodes[s], left, nodes[o]) for s, o in pairs.tolist())
    query = f"SELECT (COUNT(*) AS ?n) {{ ?a <{LEFT.iri}>+ ?b }}"

    def count() -> int:
        found = store.query(query)
        assert isinstance(found, ox.QuerySolutions)
        return int(str(next(found)["n"].value))

    return count


def networkx(pairs: Pairs) -> Callable[[], int]:
    graph = nx.DiGraph(pairs.tolist())
    return lambda: int(nx.transitive_closure_dag(graph).number_of_edges())


def rdflib(pairs: Pairs) -> Callable[[], int]:
    graph = Graph()
    left = URIRef(LEFT.iri)
    for s, o in pairs.tolist():
        graph.add((URIRef(f"urn:o{s}"), left, URIRef(f"urn:o{o}")))
    return lambda: sum(1 for _ in graph.query(f"SELECT ?a ?b {{ ?a <{LEFT.iri}>+ ?b }}"))


def compare(title: str, case: tuple[int, Pairs], peers: list[str], runs: int) -> None:
    n, pairs = case
    graph = graph_of(n, pairs)
    made = {"pyoxigraph property path": oxigraph, "networkx transitive_closure_dag": networkx, "rdflib": rdflib}
    jobs = [(name, made[name](pairs)) for name in peers]
    expected = ours(graph)
    assert all(job() == expected for _, job in jobs), "the peers count different pairs"
    times = medians(lambda: ours(graph), *(job for _, job in jobs), runs=runs)
    print(f"{title}: {len(pairs):,} facts, {expected:,} pairs of left")
    print(f"    deixis {1e3 * times[0]:.2f} ms, one explanation {1e3 * explanation(graph):.2f} ms")
    seconds(title, times[0])
    for (name, _), taken in zip(jobs, times[1:], strict=True):
        ratio(title, taken, times[0], name.split()[0])
        print(f"    {name} {1e3 * taken:.0f} ms: {taken / times[0]:.0f} times as long")


def explanation(graph: RelationGraph) -> float:
    """Return the seconds for the derivation of a fact between the first object and the farthest one."""
    implied = Implications(graph)
    implied.prepare_explanations()
    pairs = implied.pairs(LEFT)
    s = int(pairs[0, 0])
    ends = [(graph.nodes[s], graph.nodes[o]) for o in pairs[pairs[:, 0] == s][:, 1].tolist()[-5:]]
    taken = []
    for subject, object in ends:
        started = time.perf_counter()
        assert implied.derive(LEFT, subject, object) is not None
        taken.append(time.perf_counter() - started)
    return median(taken)


def long_chain(n: int) -> None:
    graph = graph_of(*chain(n))
    (taken,) = medians(lambda: ours(graph), runs=3)
    seconds(f"one chain of {n:,} objects", taken)
    print(f"one chain of {n:,} objects: {taken:.2f} s for {n * (n - 1) // 2:,} pairs")


def to_triples(n: int) -> None:
    """Time a chain to N-Triples, beside HermiT and Pellet on the same chain as a transitive property."""
    from deixis.reasoning.description_logic.reasoners import Reasoner, classify

    graph = graph_of(*chain(n))
    (taken,) = medians(lambda: Implications(graph).ntriples(), runs=7)
    lines = Implications(graph).ntriples().count(f"<{LEFT.iri}>")
    print(f"a chain of {n} to triples, both ways: {1e3 * taken:.1f} ms, {lines:,} of left")
    ontology = axioms(n)
    for reasoner in Reasoner:
        started = time.perf_counter()
        found = classify(ontology, reasoner, properties=True).inferred.count(f"<{LEFT.iri}>")
        seconds_taken = time.perf_counter() - started
        ratio(f"a chain of {n} to triples", seconds_taken, taken, f"{reasoner.value} of owlready2")
        result = f"{seconds_taken:.1f} s, {found:,} new: {seconds_taken / taken:.0f} times as long"
        print(f"    {reasoner.value}, left only: {result}")


def axioms(n: int) -> str:
    kind = "<http://www.w3.org/1999/02/22-rdf-syntax-ns#type>"
    owl = "http://www.w3.org/2002/07/owl#"
    lines = [f"<{LEFT.iri}> {kind} <{owl}{name}> ." for name in ("ObjectProperty", "TransitiveProperty")]
    lines += [f"<urn:o{k}> {kind} <{owl}NamedIndividual> ." for k in range(n)]
    lines += [f"<urn:o{k}> <{LEFT.iri}> <urn:o{k + 1}> ." for k in range(n - 1)]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        peers = ["pyoxigraph property path", "networkx transitive_closure_dag", "rdflib"]
        compare("chain of 500 objects", chain(500), peers, runs=3)
        compare("tables of 50 objects", tables(10_000, 50), peers, runs=3)
        long_chain(5_000)
        to_triples(200)


if __name__ == "__main__":
    main()
