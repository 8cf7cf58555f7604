"""Reason over RDF files, or over a memory."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pyoxigraph as ox

from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.memory.semantic.rdf.files import PREFIXES, read_quads
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.rdf.triples import with_blank_nodes
from deixis.reasoning.description_logic.entailment import Entailment, LogicEngine, entail, explained
from deixis.reasoning.description_logic.terms import Triple, read_ntriples, write_ntriples
from deixis.reasoning.description_logic.verbalisation import labels_of
from deixis.reasoning.errors import SettingError, require_time_limit

_PREFIX = re.compile(r"^\s*@?prefix\s+([\w.-]*):\s*<([^<>\s]*)>", re.IGNORECASE | re.MULTILINE)

_STATED = (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED, GraphName.EPISODES)


@checks_arguments
def reason(
    data: SemanticMemory | str | Path | Sequence[str | Path],
    engine: LogicEngine | str = LogicEngine.AUTO,
    *,
    reasons: bool = True,
    every: bool = False,
    time_limit: float = 60.0,
) -> Entailment:
    """Infer what an ontology entails, and whether it and its classes are satisfiable.

    Parameters
    ----------
    data
        File of the ontology (.ttl, .nt, .rdf, .owl), files that are one ontology together, or the memory of a session.
    engine
        ``rl`` for rules, ``hermit`` or ``pellet`` for all of OWL 2 DL, ``auto`` for rules and HermiT.
    reasons
        True to find a justification of each impossibility.
    every
        True to find all justifications of each.
    time_limit
        Seconds for the verdict; finding the reasons gets at least a tenth of it after that.

    Returns
    -------
    Entailment
        The verdict, what follows, and the reasons.

    Raises
    ------
    ImportFormatError
        If a file cannot be read; the message names the place.
    LimitError
        If the time limit is reached before the verdict.
    SettingError
        If there is no engine of that name.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.reason("ontology/deixis.ttl", "rl")
    >>> found.possible, found.to_dict()["engine"]
    (True, 'rl')
    """
    require_time_limit(time_limit)
    if isinstance(data, SemanticMemory):
        stated, _ = read_remembered(data)
    else:
        stated, _ = read_ontology(paths(data, "data"))
    deadline = Deadline.after(time_limit)
    found = entailment(stated, engine, time_limit)
    if found.possible or not reasons:
        return found
    return explained(write_ntriples(stated), found, deadline.for_reasons(time_limit), every)


def paths(files: str | Path | Sequence[str | Path], argument: str) -> list[Path]:
    """Return one file, or several, as a list of paths.

    Parameters
    ----------
    files
        A path, or several.
    argument
        Name of the argument, for the error.

    Returns
    -------
    list of Path
        The paths, in order.

    Raises
    ------
    SettingError
        If there is no file.
    """
    found = [Path(file) for file in ([files] if isinstance(files, str | Path) else files)]
    if not found:
        raise SettingError(f"`{argument}` must name at least one file")
    return found


def entailment(stated: Sequence[Triple], engine: LogicEngine | str, time_limit: float) -> Entailment:
    """Return what follows from the triples of an ontology, with its labels and without reasons.

    Parameters
    ----------
    stated
        Triples of the ontology.
    engine
        The engine, or its name.
    time_limit
        Time limit in seconds.

    Returns
    -------
    Entailment
        The verdict and what follows.
    """
    return replace(entail(write_ntriples(stated), engine, time_limit), labels=labels_of(stated))


def read_ontology(files: Sequence[Path]) -> tuple[list[Triple], dict[str, str]]:
    """Read files as one ontology.

    Parameters
    ----------
    files
        Files of triples.

    Returns
    -------
    tuple
        The triples, and the usual prefixes with those that the files declare.

    Raises
    ------
    ImportFormatError
        If a file cannot be read; the message names the place.
    """
    found = [triple for number, file in enumerate(files) for triple in _with_own_blank_nodes(number, read_quads(file))]
    prefixes = dict(PREFIXES)
    for file in files:
        if file.suffix.lower() in (".ttl", ".trig"):
            prefixes.update(_PREFIX.findall(file.read_text(encoding="utf-8", errors="replace")))
    return _as_triples(found), prefixes


def _with_own_blank_nodes(number: int, quads: Iterable[ox.Quad]) -> Iterator[ox.Triple]:
    """Yield the triples of one file, with blank nodes renamed so that they differ from those of other files."""

    def own(node: object) -> object:
        return ox.BlankNode(f"f{number}x{node.value}") if isinstance(node, ox.BlankNode) else node

    for quad in quads:
        yield ox.Triple(own(quad.subject), quad.predicate, own(quad.object))  # type: ignore[arg-type]


def read_remembered(memory: SemanticMemory) -> tuple[list[Triple], dict[str, str]]:
    """Return the stated triples of a memory, without inferred ones.

    Parameters
    ----------
    memory
        The open memory.

    Returns
    -------
    tuple
        The triples, and the usual prefixes.
    """
    found = [triple for name in _STATED for triple in memory.triples(name)]
    return _as_triples(list(with_blank_nodes(found))), dict(PREFIXES)


def _as_triples(found: list[ox.Triple]) -> list[Triple]:
    text = ox.serialize(found, format=ox.RdfFormat.N_TRIPLES) or b""
    return list(dict.fromkeys(read_ntriples(text.decode("utf-8"))))
