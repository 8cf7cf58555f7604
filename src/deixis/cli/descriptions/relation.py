"""The command ``deixis relation``: print the meaning of a relation word."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    AsJson,
    MemoryDir,
    NoMemory,
    print_json,
    print_lines,
    print_written,
    require_plot,
)
from deixis.cli.progress import progress_bar

if TYPE_CHECKING:
    from deixis.ontology.models.relations import RelationModels


Models = Annotated[
    Path | None, typer.Option("--models", metavar="FILE", help="Graded models (.ttl) instead of the shipped ones.")
]


def relation(
    word: Annotated[str, typer.Argument(metavar="WORD", help="A relation word: left, 'on top of', exactly_left.")],
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw its degrees (.png, .svg, .pdf).")] = None,
    models: Models = None,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    as_json: AsJson = False,
) -> None:
    """Print the meaning of a relation word: both literal readings, and the graded model, learned or shipped."""
    from deixis.errors import UnknownTermError
    from deixis.ontology.relations.relation import plain_phrase
    from deixis.ontology.tbox import default_ontology
    from deixis.report.descriptions.relation import relation_lines, relation_to_dict
    from deixis.spelling import nearest

    relations = default_ontology().relations
    found = relations.by_word.get(plain_phrase(word))
    if found is None:
        hint = nearest(plain_phrase(word), relations.by_word)
        advice = f"did you mean '{hint}'?" if hint else f"use one of {', '.join(relations)}"
        raise UnknownTermError(f"no relation word '{word}'; {advice}")
    known = _in_force(memory, no_memory) if models is None else read_models(models)
    require_plot(plot)
    if as_json:
        print_json(relation_to_dict(found, relations, known))
    else:
        print_lines(relation_lines(found, relations, known))
    if plot is not None:
        from deixis.plots.relation import plot_relation

        with progress_bar("drawing"):
            plot_relation(found, known, plot)
        if not as_json:
            print_written(plot)


def _in_force(memory: Path | None, no_memory: bool) -> RelationModels:
    """Return the models of the memory, or the shipped ones where it has none; raise where a named memory is missing."""
    from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
    from deixis.session import Session

    if no_memory:
        return shipped_models()
    with Session(memory) as session:
        if memory is not None:
            session.memory()
        return session.meaning().models or shipped_models()


def read_models(path: Path | None) -> RelationModels:
    """Return the shipped models, replaced by those of a Turtle file; raise OntologyError where the file has none."""
    from deixis.errors import OntologyError
    from deixis.ontology.models.relation_triples import models_from_turtle
    from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
    from deixis.text_files import read_text

    if path is None:
        return shipped_models()
    text = read_text(path, OntologyError)
    try:
        found = models_from_turtle(text)
    except ValueError as error:
        raise OntologyError(f"{path}: {error}") from error
    if not found:
        raise OntologyError(f"{path}: no relation model in this file; 'deixis learn-relation -o FILE' writes one")
    return shipped_models().replaced(*found)
