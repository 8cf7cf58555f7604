"""The commands about what relation words mean: to look at one, and to learn them from examples."""

from __future__ import annotations

from dataclasses import replace
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
    require_ending,
    require_plot,
    require_writable,
)

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.learning.words import LearnedWords
    from deixis.ontology.models.relations import RelationModels
    from deixis.perception.scene import Scene
    from deixis.session import Session

Models = Annotated[
    Path | None, typer.Option("--models", metavar="FILE", help="Graded models (.ttl) in place of the shipped ones.")
]


def relation(
    word: Annotated[str, typer.Argument(metavar="WORD", help="A relation word: left, 'on top of', exactly_left.")],
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw its field (.png, .svg, .pdf).")] = None,
    models: Models = None,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    as_json: AsJson = False,
) -> None:
    """Print what a relation word means: in both readings, and by degrees, as it was learned or is shipped."""
    from deixis.errors import UnknownTermError
    from deixis.ontology.relation import nearest, plain_phrase
    from deixis.ontology.tbox import default_ontology
    from deixis.report.relation import relation_lines, relation_to_dict

    relations = default_ontology().relations
    found = relations.by_word.get(plain_phrase(word))
    if found is None:
        hint = nearest(plain_phrase(word), relations.by_word)
        advice = f"did you mean '{hint}'?" if hint else f"there are {', '.join(relations)}"
        raise UnknownTermError(f"no relation is called '{word}'; {advice}")
    known = _in_force(memory, no_memory) if models is None else read_models(models)
    require_plot(plot)
    if as_json:
        print_json(relation_to_dict(found, relations, known))
    else:
        print_lines(relation_lines(found, relations, known))
    if plot is not None:
        from deixis.plots.relation import plot_relation

        plot_relation(found, known, plot)
        if not as_json:
            print_written(plot)


def _in_force(memory: Path | None, no_memory: bool) -> RelationModels:
    """The models of the memory, where it has some; a memory that is named must be there."""
    from deixis.reasoning.grounding.evidence.meaning import shipped_models
    from deixis.session import Session

    if no_memory:
        return shipped_models()
    with Session(memory) as session:
        if memory is not None:
            session.memory()
        return session.meaning().models or shipped_models()


def learn_relation(
    files: Annotated[
        list[str] | None,
        typer.Argument(metavar="[SCRIPT SCENE]...", help="Scripts, each with the labelled scene it describes."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="FILE", help="Write the models to a file (.ttl), not to the memory."),
    ] = None,
    models: Models = None,
    strength: Annotated[float, typer.Option(help="How strongly what is shipped holds; above 0.")] = 3.0,
    reset: Annotated[bool, typer.Option("--reset", help="Take the learned models away; the lessons stay.")] = False,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    as_json: AsJson = False,
) -> None:
    """Learn what relation words mean: from everything remembered, and from scripts with labelled scenes."""
    from deixis.report.relation import learned_words_lines, learned_words_to_dict
    from deixis.session import Session

    _require_fitting(files, out, models, reset, no_memory)
    if out is not None:
        require_ending(out, (".ttl",), "what words mean, as Turtle,")
        require_writable([out], [*(files or []), models])
    with Session(memory) as session:
        if reset:
            session.forget_relations()
            where = session.path
            print_json({"reset": str(where)}) if as_json else print(f"The shipped models are in force in {where}.")
            return
        examples = _examples(files or [])
        if out is None:
            learned, where = session.learn_relations(examples, strength), session.path
        else:
            learned, where = _fitted(session, examples, strength, models, no_memory), out
            _write(learned, out)
    if as_json:
        print_json(learned_words_to_dict(learned, str(where)))
    else:
        print_lines(learned_words_lines(learned))
        print_lines([f"In force in {where}."] if out is None else [])
        print_written(out)


def _require_fitting(
    files: list[str] | None, out: Path | None, models: Path | None, reset: bool, no_memory: bool
) -> None:
    """Raises DeixisError for options that do not go together."""
    from deixis.errors import DeixisError

    if reset and (files or out or models or no_memory):
        raise DeixisError("--reset only takes learned models away; learn in a command of its own")
    if files and len(files) % 2:
        raise DeixisError(f"scripts and scenes come in pairs; '{files[-1]}' has no scene")
    if out is None and no_memory:
        raise DeixisError("--no-memory leaves nowhere to keep the models; name a file with -o FILE")
    if out is None and models is not None:
        raise DeixisError("what a memory learns starts from the shipped models; --models goes with -o FILE")
    if no_memory and not files:
        raise DeixisError("without the memory there is nothing to learn from; name scripts and labelled scenes")


def _examples(files: list[str]) -> list[tuple[Script, Scene]]:
    from deixis.workflows.read import load_scene, read_script

    return [(read_script(script), load_scene(scene)) for script, scene in zip(files[::2], files[1::2], strict=True)]


def _fitted(
    session: Session, examples: list[tuple[Script, Scene]], strength: float, models: Path | None, no_memory: bool
) -> LearnedWords:
    """What the examples and the memory teach, with nothing kept; raises DeixisError where there is nothing to learn."""
    from deixis.errors import DeixisError
    from deixis.learning.recollection import Recollection
    from deixis.learning.words import example_pairs, fit, teaching

    taught, left_out = teaching(examples)
    recollection = Recollection(()) if no_memory else session.recollection()
    sources = [f"{script.file} {scene.file}" for script, scene in taught]
    pairs = [example_pairs(example) for example in taught]
    learned = fit(recollection, strength, read_models(models), pairs, sources)
    if not learned.taught:
        raise DeixisError("; ".join(("nothing to learn", *learned.left_out, *left_out)))
    return replace(learned, left_out=(*learned.left_out, *left_out))


def _write(learned: LearnedWords, out: Path) -> None:
    from deixis.errors import DeixisError
    from deixis.ontology.models.relation_triples import models_to_turtle

    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(models_to_turtle(learned.models.models.values()), encoding="utf-8")
    except OSError as error:
        raise DeixisError(f"{out}: the models cannot be written: {error.strerror}") from error


def read_models(path: Path | None) -> RelationModels:
    """The shipped models, with those of a Turtle file in their place; raises OntologyError where it has none."""
    from deixis.errors import OntologyError
    from deixis.ontology.models.relation_triples import models_from_turtle
    from deixis.reasoning.grounding.evidence.meaning import shipped_models

    if path is None:
        return shipped_models()
    try:
        found = models_from_turtle(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise OntologyError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise OntologyError(f"{path}: {error}") from error
    if not found:
        raise OntologyError(f"{path}: there is no relation model in it; write one with 'deixis learn-relation'")
    return shipped_models().replaced(*found)


def register(app: typer.Typer) -> None:
    """Adds the commands to the command line."""
    app.command()(relation)
    app.command("learn-relation")(learn_relation)
