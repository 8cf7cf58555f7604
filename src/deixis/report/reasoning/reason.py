"""Entailments and justifications of ontologies as lines of text and as plain data for JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from deixis.memory.semantic.rdf.files import short
from deixis.reasoning.description_logic.entailment import Entailment
from deixis.reasoning.description_logic.justification import Justification
from deixis.reasoning.description_logic.owl_rl.materialisation import InferenceStep
from deixis.reasoning.description_logic.terms import Triple, iri_of
from deixis.reasoning.description_logic.verbalisation import Words
from deixis.report.marks import violation


def verdict(found: Entailment) -> str:
    """Return the outcome in one sentence that claims no more than the engine decides.

    Parameters
    ----------
    found
        Answer of ``deixis reason``.

    Returns
    -------
    str
        The sentence, marked as a violation if the ontology, or a class of it, is unsatisfiable.
    """
    if not found.consistent:
        return violation(f"inconsistent ({found.engine}): the ontology has no model")
    held = "consistent" if found.complete else "no contradiction found"
    if found.unsatisfiable:
        words = Words(found.labels)
        names = ", ".join(words.name(f"<{iri}>") for iri in found.unsatisfiable)
        held += f", but no individual can belong to {names}"
    return violation(f"{held} ({found.engine}); {len(found.inferred):,} triples inferred", bool(found.unsatisfiable))


def inferred_lines(found: Entailment, triples: bool = False) -> Iterator[str]:
    """Yield what follows, counted by predicate or listed.

    Parameters
    ----------
    found
        Answer of ``deixis reason``.
    triples
        True to list every inferred triple, False to count them.

    Yields
    ------
    str
        A triple; or a number and a predicate, the most frequent predicate first.
    """
    if triples:
        for triple in found.inferred:
            yield " ".join(short(iri) if (iri := iri_of(part)) else part for part in triple)
        return
    counted = Counter(triple.predicate for triple in found.inferred)
    for predicate, number in sorted(counted.items(), key=lambda entry: (-entry[1], entry[0])):
        yield f"{number:8,}  {short(predicate[1:-1])}"


def impossibility_lines(found: Entailment) -> Iterator[str]:
    """Yield the reasons found why the ontology, or a class of it, is unsatisfiable.

    Parameters
    ----------
    found
        Answer of ``deixis reason``.

    Yields
    ------
    str
        Each reason with its axioms; then why the search for reasons ended early, if it did.
    """
    words = Words(found.labels)
    for justification in found.inconsistency:
        yield f"These cannot all hold{_doubt(justification)}:"
        yield from _axiom_lines(justification, words)
    for justification in found.impossible:
        yield from justification_lines(justification, words)
    if found.unexplained is not None:
        why = "There may be more reasons" if found.inconsistency or found.impossible else "The reason was not found"
        yield f"{why}: {found.unexplained}."


def _doubt(justification: Justification) -> str:
    return "" if justification.minimal else " (some may not be needed: time limit reached before all were tried)"


def justification_lines(justification: Justification, words: Words) -> Iterator[str]:
    """Yield a statement, or 'Contradiction', and the axioms behind it.

    Parameters
    ----------
    justification
        Set of axioms that entail a statement or a contradiction.
    words
        Writer of IRIs and axioms in plain words.

    Yields
    ------
    str
        The conclusion first, then one indented line for each axiom.
    """
    what = "Contradiction" if justification.entailed is None else words.triple(justification.entailed)
    yield f"{what}, because{_doubt(justification)}"
    yield from _axiom_lines(justification, words)


def explanation_lines(justification: Justification, steps: tuple[InferenceStep, ...], words: Words) -> Iterator[str]:
    """Yield why a statement follows: the axioms, and the steps where rules lead from them to it.

    Parameters
    ----------
    justification
        Set of axioms that entail the statement.
    steps
        Steps in the order of the derivation; those without a rule are stated triples and are left out.
    words
        Writer of IRIs and axioms in plain words.

    Yields
    ------
    str
        The conclusion, its axioms, and a line with the rule in brackets for each step.
    """
    yield from justification_lines(justification, words)
    derived = [step for step in steps if step.rule is not None]
    if derived:
        yield "by these steps:"
        yield from (f"  {words.triple(step.triple)}  [{step.rule}]" for step in derived)


def _axiom_lines(justification: Justification, words: Words) -> Iterator[str]:
    for axiom in justification.axioms:
        yield f"  {words.axiom(axiom)}"


def entailment_lines(found: Entailment) -> list[str]:
    """Return the verdict, its reasons, and the numbers of inferred triples.

    Parameters
    ----------
    found
        Answer of ``deixis reason``.

    Returns
    -------
    list of str
        Lines of :func:`verdict`, :func:`impossibility_lines` and :func:`inferred_lines`.
    """
    return [verdict(found), *impossibility_lines(found), *inferred_lines(found)]


def entailment_rows(found: Entailment) -> Iterator[dict[str, Any]]:
    """Yield a row for each inferred triple.

    Parameters
    ----------
    found
        Answer of ``deixis reason``.

    Yields
    ------
    dict
        ``subject``, ``predicate`` and ``object``; IRIs are whole.
    """
    yield from map(_plain, found.inferred)


def entailment_to_dict(found: Entailment) -> dict[str, Any]:
    """Return the entailments as plain data for JSON.

    Parameters
    ----------
    found
        Answer of ``deixis reason``.

    Returns
    -------
    dict
        Data for JSON: the engine, ``complete``, ``consistent``, the inferred triples, the unsatisfiable classes, and
        the justifications.
    """
    words = Words(found.labels)
    return {
        "engine": found.engine.value,
        "complete": found.complete,
        "consistent": found.consistent,
        "inferred": [_plain(triple) for triple in found.inferred],
        "unsatisfiable": list(found.unsatisfiable),
        "unexplained": found.unexplained,
        "justifications": [
            justification_to_dict(justification, words) for justification in (*found.inconsistency, *found.impossible)
        ],
    }


def justification_to_dict(
    justification: Justification, words: Words, steps: tuple[InferenceStep, ...] = ()
) -> dict[str, Any]:
    """Return a justification as plain data: its conclusion, its axioms, and the rule steps.

    Parameters
    ----------
    justification
        Set of axioms that entail a statement or a contradiction.
    words
        Writer of IRIs and axioms in plain words.
    steps
        Rule steps that lead from the axioms to the conclusion, if they are known.

    Returns
    -------
    dict
        Data for JSON. ``entailed`` is None for a contradiction; ``minimal`` is False if an axiom might be superfluous.
    """
    return {
        "entailed": None if justification.entailed is None else _plain(justification.entailed),
        "minimal": justification.minimal,
        "axioms": [
            {"words": words.axiom(axiom), "triples": [_plain(triple) for triple in axiom.triples]}
            for axiom in justification.axioms
        ],
        "steps": [
            {"triple": _plain(step.triple), "rule": step.rule, "premises": [_plain(p) for p in step.premises]}
            for step in steps
        ],
    }


def _plain(triple: Triple) -> dict[str, str]:
    return {name: iri_of(part) or part for name, part in zip(triple._fields, triple, strict=True)}
