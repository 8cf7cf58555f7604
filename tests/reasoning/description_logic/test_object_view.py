"""An ontology as owlready2's objects: the content of the triples, in its own world."""

from __future__ import annotations

import owlready2
import pytest
from ontologies import CUTLERY, ntriples

from deixis.reasoning.description_logic.object_view import ObjectView
from deixis.reasoning.errors import ReasonerError, TriplesError

TEXT = ntriples(
    CUTLERY
    + ":o1 a :DessertFork . [] a :Fork . :Set a owl:Class ; rdfs:subClassOf "
    + "[ a owl:Restriction ; owl:onProperty :shows ; owl:someValuesFrom :Fork ] . :shows a owl:ObjectProperty ."
)
BASE = "urn:t#"


def test_classes_and_individuals_are_python_objects() -> None:
    with ObjectView.of(TEXT, BASE) as view:
        fork = view.ontology.DessertFork
        assert issubclass(fork, view.ontology.Fork)
        assert [one.name for one in fork.instances()] == ["o1"]
        assert [one.name for one in view.individuals()] == ["o1"]
        assert {one.name for one in view.classes()} >= {"Fork", "DessertFork", "Set"}
        assert view.search(iri="*DessertFork") == [fork]
        assert view[BASE + "DessertFork"] is fork
        assert view["urn:nothing"] is None


def test_a_blank_node_is_a_class_expression() -> None:
    with ObjectView.of(TEXT, BASE) as view:
        (restriction,) = (one for one in view.ontology.Set.is_a if isinstance(one, owlready2.Restriction))
        assert (restriction.property, restriction.value) == (view.ontology.shows, view.ontology.Fork)


def test_two_views_and_the_default_world_do_not_mix() -> None:
    before = len(owlready2.default_world.graph)
    with ObjectView.of(TEXT, BASE) as one, ObjectView.of(TEXT, BASE) as other:
        owlready2.destroy_entity(one.ontology.o1)
        assert not one.ontology.DessertFork.instances()
        assert [found.name for found in other.ontology.DessertFork.instances()] == ["o1"]
        assert one.world is not owlready2.default_world
    assert len(owlready2.default_world.graph) == before


def test_imports_are_not_followed() -> None:
    imports = f"<{BASE}> <http://www.w3.org/2002/07/owl#imports> <https://example.invalid/other> .\n"
    with ObjectView.of(TEXT + imports, BASE) as view:
        assert view.ontology.imported_ontologies == []


def test_a_closed_view_and_invalid_triples_are_errors() -> None:
    view = ObjectView.of(TEXT, BASE)
    view.close()
    view.close()
    for needs_it in (lambda: view.world, lambda: view.ontology, lambda: list(view.classes())):
        with pytest.raises(ReasonerError, match="this view is closed"):
            needs_it()
    with pytest.raises(TriplesError, match="line 1"):
        ObjectView.of("a b c", BASE)
