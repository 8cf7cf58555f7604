"""Time engines of description logic side by side: the core ontology with a growing number of facts, and a chain.

The chain is of a transitive property. Each line gives the seconds of one engine from N-Triples to N-Triples; a line
says which engines are left out of the larger sizes because they would take too long.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import owlrl  # type: ignore[import-untyped]
import pyoxigraph as ox
import rdflib
from records import command_line, recorded, seconds

from deixis.ontology.rdf.vocabulary import BASE
from deixis.reasoning.description_logic.justification import justify
from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
from deixis.reasoning.description_logic.reasoners import Reasoner, classify
from deixis.reasoning.description_logic.terms import (
    NAMED_INDIVIDUAL,
    NOTHING,
    SUB_CLASS_OF,
    TYPE,
    Triple,
    read_ntriples,
    term,
    write_ntriples,
)
from deixis.reasoning.errors import LimitError

CORE = Path(__file__).parent.parent / "ontology" / "deixis.ttl"
SIZES, TABLE, CHAIN, ADDED = (100, 1_000, 10_000), 10, 200, 10
TIME_LIMIT = 120.0
OWLRL_AT_MOST = 1_000


def core() -> str:
    triples = [quad.triple for quad in ox.parse(path=CORE)]
    return (ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode()


def facts(number: int) -> list[Triple]:
    """Return tables of ten things, each with a kind and with one fact that relates it to another."""
    rng = random.Random(1)
    kinds = [f"<{BASE}{name}>" for name in ("Fork", "Knife", "Spoon", "DinnerPlate", "Napkin", "WineGlass")]
    words = [f"<{BASE}{name}>" for name in ("left", "top", "topLeft", "exactlyRight", "exactlyOn")]
    found: list[Triple] = []
    while len(found) < number:
        thing = len(found) // 2
        name, other = f"<urn:t{thing}>", f"<urn:t{thing - 1}>" if thing % TABLE else f"<urn:table{thing // TABLE}>"
        found += [Triple(name, TYPE, rng.choice(kinds)), Triple(name, rng.choice(words), other)]
    return found[:number]


def declared(stated: list[Triple]) -> Iterator[Triple]:
    yield from stated
    yield from (Triple(name, TYPE, NAMED_INDIVIDUAL) for name in {t.subject for t in stated if t.predicate == TYPE})


def chain(length: int) -> str:
    left = term("owl:ObjectProperty"), term("owl:TransitiveProperty")
    head = [Triple("<urn:left>", TYPE, kind) for kind in left]
    links = [Triple(f"<urn:{i}>", "<urn:left>", f"<urn:{i + 1}>") for i in range(length - 1)]
    return write_ntriples([*head, *declared(links)])


def by_rules(text: str) -> int:
    return len(write_ntriples(Materialisation(read_ntriples(text)).inferred).splitlines())


def by_owlrl(text: str) -> int:
    graph = rdflib.Graph().parse(data=text, format="nt")
    stated = len(graph)
    owlrl.DeductiveClosure(owlrl.OWLRL_Semantics).expand(graph)
    return len(graph.serialize(format="nt").splitlines()) - stated


def by(reasoner: Reasoner) -> Callable[[str], int]:
    return lambda text: len(classify(text, reasoner, TIME_LIMIT, properties=True).inferred.splitlines())


ENGINES: dict[str, Callable[[str], int]] = {
    "deixis OWL 2 RL": by_rules,
    "owlrl": by_owlrl,
    "HermiT": by(Reasoner.HERMIT),
    "Pellet": by(Reasoner.PELLET),
}


def measure(what: str, name: str, job: Callable[[], object]) -> None:
    started = time.perf_counter()
    try:
        result = f"{job():9,} triples"
    except LimitError:
        result = "undecided"
    taken = time.perf_counter() - started
    seconds(f"{what}: {name}", taken)
    print(f"  {name:42} {taken:9.3f} s  {result}", flush=True)


def grown(what: str, text: str, stated: list[Triple]) -> None:
    """Time adding a few facts to a materialised graph, beside materialising it from scratch."""
    known = Materialisation(read_ntriples(text))
    new = [Triple("<urn:new>", TYPE, f"<{BASE}Fork>")]
    new += [Triple("<urn:new>", f"<{BASE}left>", stated[2 * i].subject) for i in range(ADDED - 1)]
    measure(what, f"deixis OWL 2 RL, {ADDED} facts added", lambda: len(known.add(new)))
    measure(what, f"deixis OWL 2 RL, {ADDED} facts added, from scratch", lambda: by_rules(text + write_ntriples(new)))


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        schema = core()
        for engine in ENGINES.values():
            engine(schema)  # compiled and loaded, with the disk's cache warm
        for size in SIZES:
            stated = facts(size)
            text = schema + write_ntriples(declared(stated))
            print(f"the core ontology and {size:,} facts")
            for name, engine in ENGINES.items():
                if name == "owlrl" and size > OWLRL_AT_MOST:
                    print(f"  {name:42} left out: see docs/reference/description_logic.md")
                    continue
                measure(f"{size:,} facts", name, lambda engine=engine, text=text: engine(text))  # type: ignore[misc]
            grown(f"{size:,} facts", text, stated)
        text = chain(CHAIN)
        print(f"a transitive chain of {CHAIN} objects, to triples")
        for name, engine in ENGINES.items():
            if name != "owlrl":
                measure("a transitive chain", name, lambda engine=engine: engine(text))  # type: ignore[misc]
        # ---- the row of the spatial calculus goes here: measure("deixis calculus", …)
        print("justifications")
        spork = Triple("<urn:Spork>", SUB_CLASS_OF, NOTHING)
        triples = [Triple("<urn:Spork>", SUB_CLASS_OF, f"<{BASE}{name}>") for name in ("Fork", "Spoon")]
        text = schema + write_ntriples([Triple("<urn:Spork>", TYPE, term("owl:Class")), *triples])
        measure("justification", "an impossible class (axioms)", lambda: len(justify(text, spork).axioms))


if __name__ == "__main__":
    main()
