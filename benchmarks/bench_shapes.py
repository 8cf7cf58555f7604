"""Compare pyshacl and pyrudof on users' own shapes: random data and random shapes of SHACL core.

pyrudof takes part if it is installed. Both get the same Turtle. A result is its focus node, its path and the kind of
constraint; differing kinds of constraints are counted.
"""

from __future__ import annotations

import importlib
import importlib.util
import logging
import statistics
import time
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
import pyshacl
import rdflib
from records import command_line, count, recorded

Result = tuple[str, str, str]
"""Focus node, path and component, in full."""

NODES = 60
PREFIXES = (
    "@prefix sh: <http://www.w3.org/ns/shacl#> .\n@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n"
    "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n@prefix : <http://example.org/> .\n"
)


def data(nodes: int, rng: np.random.Generator) -> str:
    """Return things of four kinds with numbers, texts in two languages, and links between them."""
    lines = []
    for k in range(nodes):
        lines.append(f":n{k} a :K{rng.integers(4)} .")
        for p in range(4):
            for _ in range(rng.integers(3)):
                values = (
                    str(rng.integers(-5, 20)), f'"{rng.integers(100)}"', f'"t{rng.integers(9)}"@en',
                    f'"t{rng.integers(9)}"@de', f":n{rng.integers(nodes)}", f"{rng.integers(99) / 10}", "true",
                    '"2026-01-01"^^xsd:date', '"x"^^xsd:integer', f"[ :p{p} {rng.integers(9)} ]",
                )  # fmt: skip
                lines.append(f":n{k} :p{p} {values[rng.integers(len(values))]} .")
    return PREFIXES + "\n".join(lines)


def path(rng: np.random.Generator) -> str:
    p = f":p{rng.integers(4)}"
    choices = (p, p, p, f"[ sh:inversePath {p} ]", f"( {p} :p0 )", f"[ sh:alternativePath ( {p} :p1 ) ]")
    return choices[rng.integers(len(choices))]


def constraint(rng: np.random.Generator, depth: int) -> str:
    """Return one constraint on the values of a path, or of a focus node."""
    a, b, p = rng.integers(0, 6), rng.integers(5, 20), f":p{rng.integers(4)}"
    choices = [
        f"sh:datatype {('xsd:integer', 'xsd:string', 'rdf:langString', 'xsd:decimal')[rng.integers(4)]}",
        f"sh:class :K{rng.integers(4)}", f"sh:nodeKind sh:{('IRI', 'Literal', 'BlankNodeOrIRI')[rng.integers(3)]}",
        f"sh:minInclusive {a}", f"sh:maxExclusive {b}", f"sh:minLength {a}", f"sh:maxLength {a}",
        f'sh:pattern "^[0-{a}t]"', 'sh:languageIn ( "en" )', f'sh:in ( {a} {b} "t1"@en :n1 )',
    ]  # fmt: skip
    if depth:
        inner, other = constraint(rng, depth - 1), constraint(rng, depth - 1)
        choices += [
            f"sh:not [ {inner} ]", f"sh:or ( [ {inner} ] [ {other} ] )", f"sh:and ( [ {inner} ] [ {other} ] )",
            f"sh:xone ( [ {inner} ] [ {other} ] )", f"sh:node [ sh:property [ sh:path {p} ; {inner} ] ]",
        ]  # fmt: skip
    return choices[rng.integers(len(choices))]


def shapes(rng: np.random.Generator) -> str:
    text = []
    for k in range(rng.integers(1, 5)):
        targets = (f"Class :K{rng.integers(4)}", f"SubjectsOf :p{rng.integers(4)}", f"ObjectsOf :p{rng.integers(4)}")
        target = f"sh:target{(*targets, f'Node :n{rng.integers(NODES)}')[rng.integers(4)]}"
        properties = []
        for _ in range(rng.integers(1, 4)):
            constraints = (
                {constraint(rng, 1)} | {f"sh:minCount {rng.integers(3)}"} | {f"sh:maxCount {rng.integers(1, 3)}"}
            )
            way = path(rng)
            if way.startswith(":") and rng.random() < 0.3:
                constraints |= {
                    ("sh:equals :p1", "sh:disjoint :p2", "sh:lessThan :p3", "sh:uniqueLang true")[rng.integers(4)]
                }
            properties.append(f"sh:property [ sh:path {way} ; {' ; '.join(sorted(constraints))} ]")
        text.append(f":S{k} a sh:NodeShape ; {target} ; {' ; '.join(properties)} .")
    return PREFIXES + "\n".join(text)


def by_pyshacl(graph: str, wanted: str) -> tuple[bool, Counter[Result]]:
    parts = [rdflib.Graph().parse(data=text, format="turtle") for text in (graph, wanted)]
    conforms, report, _ = pyshacl.validate(parts[0], shacl_graph=parts[1], inference="none")
    assert isinstance(report, rdflib.Graph)
    sh, found = rdflib.SH, Counter[Result]()
    for node in report.subjects(rdflib.RDF.type, sh.ValidationResult):
        focus, way, kind = (
            report.value(node, each) for each in (sh.focusNode, sh.resultPath, sh.sourceConstraintComponent)
        )
        found[named(focus), str(way) if isinstance(way, rdflib.URIRef) else "", str(kind)] += 1
    return bool(conforms), found


def by_pyrudof(graph: str, wanted: str) -> tuple[bool, Counter[Result]]:
    pyrudof: Any = importlib.import_module("pyrudof")
    rudof = pyrudof.Rudof(pyrudof.RudofConfig())
    rudof.read_data(graph)
    rudof.read_shacl(wanted)
    report = rudof.validate_shacl()
    found = Counter[Result]()
    for each in report.violations:
        focus, way = str(each.focus_node).strip("<>"), str(each.path or "").strip("<>")
        found["" if not focus.startswith("http") else focus, way if way.startswith("http") else "", full(each)] += 1
    return bool(report.conforms), found


def full(entry: object) -> str:
    name = str(entry.constraint_component).strip("<>")  # type: ignore[attr-defined]
    return name.replace("sh:", str(rdflib.SH))


def named(node: rdflib.term.Node | None) -> str:
    return str(node) if isinstance(node, rdflib.URIRef) else ""


def measured(name: str, cases: list[tuple[str, str]]) -> list[tuple[bool, Counter[Result]] | None]:
    """Return the answers of an engine, None where it fails, after printing the time of one."""
    seconds, answers, errors = [], list[tuple[bool, Counter[Result]] | None](), Counter[str]()
    for graph, wanted in cases:
        started = time.process_time()
        try:
            answers.append(ENGINES[name](graph, wanted))
        except Exception as error:  # count whatever either raises
            errors[f"{type(error).__name__}: {' '.join(str(error).split())[:80]}"] += 1
            answers.append(None)
        seconds.append(time.process_time() - started)
    print(f"  {name:<8} {1000 * statistics.median(seconds):7.1f} ms of processor time (median); errors: {dict(errors)}")
    return answers


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        logging.getLogger("rdflib.term").setLevel(logging.CRITICAL)  # pyshacl warns of each ill-typed literal
        rng = np.random.default_rng(17)
        there = [name for name in ENGINES if importlib.util.find_spec(name) is not None]
        print("" if "pyrudof" in there else "skipped: pyrudof is not installed")
        for sets, nodes in ((200, 60), (5, 2000)):
            cases = [(data(nodes, rng), shapes(rng)) for _ in range(sets)]
            print(f"{sets} sets of shapes over {nodes:,} nodes")
            answers = [measured(name, cases) for name in there]
            both = [pair for pair in zip(*answers, strict=True) if all(pair) and len(pair) > 1]
            differing = Counter[str]()
            for one, other in both:
                differing.update(kind.rsplit("#", 1)[-1] for _, _, kind in (one[1] - other[1]) + (other[1] - one[1]))
            verdicts, results = (sum(one[part] == other[part] for one, other in both) for part in (0, 1))
            if both:
                count(f"{sets} sets over {nodes:,} nodes: other verdicts of pyshacl and pyrudof", len(both) - verdicts)
                print(f"  of {len(both)}: the same verdict {verdicts}, the same results {results}; kinds that differ:")
                print("  " + ", ".join(f"{kind} {count}" for kind, count in differing.most_common()))
        if len(there) < 2:
            return
        print("violations reported for one value by pyshacl and pyrudof")
        for what, wanted in SINGLE.items():
            for value in VALUES:
                graph = f"{PREFIXES}:n0 :p0 {value} ."
                one, other = (sum(ENGINES[name](graph, PREFIXES + wanted)[1].values()) for name in there)
                if one != other:
                    print(f"  {what:<28} {value:<26} {one} {other}")


VALUES = ("5", '"5"', '"t"@en', "1.5", "true", '"2026-01-01"^^xsd:date', '"x"^^xsd:integer', ":n1")
SINGLE = {
    "sh:maxExclusive 7": ":S sh:targetNode :n0 ; sh:property [ sh:path :p0 ; sh:maxExclusive 7 ] .",
    "a literal that lacks :p3": ":S sh:targetObjectsOf :p0 ; sh:property [ sh:path :p3 ; sh:minCount 1 ] .",
}
ENGINES: dict[str, Callable[[str, str], tuple[bool, Counter[Result]]]] = {"pyshacl": by_pyshacl, "pyrudof": by_pyrudof}


if __name__ == "__main__":
    main()
