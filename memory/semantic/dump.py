"""Content of an RDF file, split into lessons with their contributions and triples that belong to no lesson."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

import pyoxigraph as ox

from deixis.memory.errors import ImportFormatError
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.change import named
from deixis.memory.semantic.rdf.files import read_quads
from deixis.memory.semantic.rdf.graphs import (
    CANONICAL,
    GRAPHS,
    LOADED,
    PACKAGE,
    GraphName,
    ModelSet,
    copied_graph,
    graph_iri,
    lesson_graph,
    lesson_of_graph,
    loaded_graph,
    models_graph,
    models_of_graph,
    package_graph,
)
from deixis.ontology.rdf.triples import content_key, iri, learned_iri, text, typed, with_names
from deixis.ontology.rdf.vocabulary import PROV, W3C
from deixis.printable import shortened

_ACTIVITY = "http://www.w3.org/ns/prov#Activity"

MAX_TERM = 1_000_000
"""Maximum number of characters of an IRI or a literal in an imported file."""

Graphs = dict[GraphName, set[ox.Triple]]


def _graphs() -> Graphs:
    return defaultdict(set)


@dataclass
class Dump:
    """Content of a file by its role in a memory."""

    canonical: Graphs = field(default_factory=_graphs)
    lessons: dict[str, Graphs] = field(default_factory=lambda: defaultdict(_graphs))
    package: Graphs = field(default_factory=_graphs)
    loaded: Graphs = field(default_factory=_graphs)
    models: dict[ModelSet, set[ox.Triple]] = field(default_factory=lambda: defaultdict(set))

    def quads(self) -> Iterator[ox.Quad]:
        """Yield all quads that a new memory stores for this content.

        Yields
        ------
        ox.Quad
            A quad.
        """
        for name, triples in self.canonical.items():
            yield from _quads_in(graph_iri(name), triples)
        for lesson, graphs in self.lessons.items():
            for name, triples in graphs.items():
                yield from _quads_in(lesson_graph(lesson, name), triples)
                yield from _quads_in(graph_iri(name), triples)
        for which, triples in self.models.items():
            yield from _quads_in(models_graph(which), triples)
            yield from _quads_in(graph_iri(GraphName.LEARNED), triples)
        for kept, graph_of in ((self.package, package_graph), (self.loaded, loaded_graph)):
            for name, triples in kept.items():
                yield from _quads_in(graph_of(name), triples)
                yield from _quads_in(graph_iri(name), triples)

    def in_order(self) -> list[str]:
        """Return the lessons in the order of their stated starting times, then by id.

        The numbers of lessons in a memory are not exported, so that the order of learning does not change the export.

        Returns
        -------
        list of str
            Ids of the lessons.
        """

        def started(lesson: str) -> datetime:
            about = (ledger.lesson_node(lesson), ledger.STARTED)
            episodes = self.lessons[lesson].get(GraphName.EPISODES, ())
            return ledger.earliest(triple for triple in episodes if (triple.subject, triple.predicate) == about)

        return sorted(self.lessons, key=lambda lesson: (started(lesson), lesson))

    def loose(self, name: GraphName) -> set[ox.Triple]:
        """Return the triples of a canonical graph that come from no lesson, no learned model and not the package.

        Parameters
        ----------
        name
            Name of the graph.

        Returns
        -------
        set of ox.Triple
            The triples.
        """
        held = [self.package[name], *(graphs[name] for graphs in self.lessons.values())]
        held += self.models.values() if name is GraphName.LEARNED else ()
        return self.canonical[name].difference(*held) | self.loaded[name]


def read_dump(file: Path) -> Dump:
    """Read a file. Plain triples become the asserted graph of a lesson that is named after the file.

    Parameters
    ----------
    file
        File in TriG, N-Quads, Turtle, N-Triples or RDF/XML; its ending names the format.

    Returns
    -------
    Dump
        The content by lesson and graph.

    Raises
    ------
    ImportFormatError
        If the file cannot be read, or has a graph unknown to memories.
    """
    dump, plain = Dump(), list[ox.Triple]()
    found: dict[str, list[ox.Triple]] = defaultdict(list)
    for quad in read_quads(file):
        if isinstance(quad.object, ox.Triple):
            raise ImportFormatError(f"{file}: a triple inside a triple cannot be imported: {quad.object}")
        longest = max((term.value for term in quad.triple if not isinstance(term, ox.Triple)), key=len)
        if len(longest) > MAX_TERM:
            raise ImportFormatError(
                f"{file}: a name or a text must have at most {MAX_TERM:,} characters, but "
                f"'{shortened(longest, 30)}' has {len(longest):,}; shorten it"
            )
        if isinstance(quad.graph_name, ox.DefaultGraph):
            plain.append(quad.triple)
        elif isinstance(quad.graph_name, ox.NamedNode):
            found[quad.graph_name.value].append(quad.triple)
        else:
            raise ImportFormatError(f"{file}: a graph must be named by an IRI, got {quad.graph_name}")
    for graph, triples in found.items():
        _place(dump, file, graph).update(ledger.as_stored(with_names(triples)))
    if plain:
        lesson = file.stem
        if lesson in dump.lessons:
            raise ImportFormatError(f"{file}: it has a lesson '{lesson}' and triples without a graph; rename the file")
        about = iri(learned_iri("lesson", lesson))
        episodes = [
            ox.Triple(about, iri(W3C.RDF_TYPE), iri(_ACTIVITY)),
            ox.Triple(about, iri(W3C.RDFS_LABEL), text(lesson)),
            ox.Triple(about, iri(PROV.STARTED_AT_TIME), typed(datetime.now(UTC))),
        ]
        key = content_key(lesson)
        dump.lessons[lesson][GraphName.ASSERTED].update(ledger.as_stored(named(key, plain)))
        dump.lessons[lesson][GraphName.EPISODES].update(ledger.as_stored(episodes))
    return dump


def _place(dump: Dump, file: Path, graph: str) -> set[ox.Triple]:
    """Return the set of triples that those of a graph belong to."""
    name = copied_graph(graph) or CANONICAL.get(ox.NamedNode(graph))
    if name is None:
        raise ImportFormatError(f"{file}: the graph <{graph}> is not one of a memory; these begin with {GRAPHS}")
    lesson = lesson_of_graph(graph)
    if lesson is not None:
        return dump.lessons[lesson[0]][name]
    models = models_of_graph(graph)
    if models is not None:
        return dump.models[models]
    kept = dump.package if graph.startswith(PACKAGE) else dump.loaded if graph.startswith(LOADED) else dump.canonical
    return kept[name]


def _quads_in(graph: ox.NamedNode, triples: set[ox.Triple]) -> Iterator[ox.Quad]:
    for triple in triples:
        yield ox.Quad(triple.subject, triple.predicate, triple.object, graph)
