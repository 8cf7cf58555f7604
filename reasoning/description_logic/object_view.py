"""An ontology as Python objects: classes, individuals and properties of owlready2.

Only this module and :mod:`deixis.reasoning.description_logic.reasoners`, which runs the reasoners that owlready2
packages, use owlready2.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Self

from deixis.reasoning.description_logic.terms import (
    CLASS,
    IMPORTS,
    NAMED_INDIVIDUAL,
    TYPE,
    Triple,
    read_ntriples,
    write_ntriples,
)
from deixis.reasoning.errors import ReasonerError

if TYPE_CHECKING:
    from owlready2 import Ontology, World

CLOSED = "this view is closed; open another with Session.owl()"


class ObjectView:
    r"""An ontology as owlready2's objects, in its own ``World``; use it as a context manager, or close it.

    The view is a copy in memory: changes to it change nothing else. Class expressions, which are blank nodes in RDF,
    are owlready2's constructs. The types of individuals are those in the triples; no reasoner is run. Raises
    ReasonerError if owlready2 is not installed, or if the view is closed.

    >>> declared = "<urn:x#{}> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <{}> .\n"
    >>> text = declared.format("Fork", "http://www.w3.org/2002/07/owl#Class") + declared.format("o1", "urn:x#Fork")
    >>> with ObjectView.of(text, "urn:x#") as view:
    ...     view["urn:x#Fork"].instances(), [thing.name for thing in view.individuals()]
    ([urn:x.o1], ['o1'])
    """

    def __init__(self, world: World, ontology: Ontology) -> None:
        self._world: World | None = world
        self._ontology = ontology

    @classmethod
    def of(cls, ntriples: str, base: str) -> ObjectView:
        """Return a view of the triples of a document.

        ``owl:imports`` is not followed, so that nothing is read from elsewhere. Members of declared classes are
        declared as individuals, since owlready2 lists no others.

        Parameters
        ----------
        ntriples
            The document as N-Triples.
        base
            Start of the IRIs that become attributes of the view's ontology.

        Returns
        -------
        ObjectView
            The view, to be used in a ``with`` statement or closed.

        Raises
        ------
        TriplesError
            If the document is not N-Triples.
        ReasonerError
            If owlready2 is not installed.
        """
        triples = read_ntriples(ntriples)
        classes = {triple.subject for triple in triples if triple.predicate == TYPE and triple.object == CLASS}
        individuals = {triple.subject for triple in triples if triple.predicate == TYPE and triple.object in classes}
        kept = [triple for triple in triples if triple.predicate != IMPORTS]
        kept += [Triple(one, TYPE, NAMED_INDIVIDUAL) for one in sorted(individuals) if one.startswith("<")]
        try:
            import owlready2
        except ImportError as error:
            raise ReasonerError("owlready2 must be installed for an object view: pip install owlready2") from error
        world = owlready2.World()
        ontology = world.get_ontology(base)
        ontology.load(fileobj=io.BytesIO(write_ntriples(kept).encode("utf-8")), format="ntriples", only_local=True)
        return cls(world, ontology)

    @property
    def world(self) -> World:
        """The ``owlready2.World`` of the view, which is never ``default_world``."""
        if self._world is None:
            raise ReasonerError(CLOSED)
        return self._world

    @property
    def ontology(self) -> Ontology:
        """The ``owlready2.Ontology`` of the view: ``view.ontology.Fork`` is a class of the base IRI."""
        if self._world is None:
            raise ReasonerError(CLOSED)
        return self._ontology

    def classes(self) -> Iterator[Any]:
        """Return all named classes.

        Returns
        -------
        iterator
            Classes of owlready2.

        Raises
        ------
        ReasonerError
            The view is closed.
        """
        found: Iterator[Any] = self.world.classes()
        return found

    def individuals(self) -> Iterator[Any]:
        """Return all named individuals.

        Returns
        -------
        iterator
            Individuals of owlready2.

        Raises
        ------
        ReasonerError
            The view is closed.
        """
        found: Iterator[Any] = self.world.individuals()
        return found

    def search(self, **what: Any) -> list[Any]:
        """Return the entities that ``World.search`` finds: ``iri="*fork"``, ``label="fork"``, ``type=…``, and so on.

        Parameters
        ----------
        **what
            Conditions by the name of the attribute, in which ``*`` stands for any text.

        Returns
        -------
        list
            Entities of owlready2.

        Raises
        ------
        ReasonerError
            The view is closed.
        """
        return list(self.world.search(**what))

    def __getitem__(self, iri: str) -> Any:
        """Return the entity with an IRI, or None."""
        return self.world[iri]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the memory of the world; its objects cannot be used after that."""
        if self._world is not None:
            world, self._world = self._world, None
            world.close()
