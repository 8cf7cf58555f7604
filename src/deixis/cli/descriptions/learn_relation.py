"""The command ``deixis learn-relation``: learn what relation words mean from examples."""

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
    print_line,
    print_lines,
    print_written,
    require_ending,
    require_writable,
)
from deixis.cli.descriptions.relation import Models, read_models
from deixis.cli.output import note_change
from deixis.cli.progress import progress_bar

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.learning.models.words import LearnedWords
    from deixis.perception.scene import Scene
    from deixis.session import Session


def learn_relation(
    files: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[SCRIPT SCENE]...", help="Scripts, each followed by the labelled scene that it describes."
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="FILE", help="Write the models to a file (.ttl), not to the memory."),
    ] = None,
    descriptions: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help='Descriptions with the object that each means, lines {"text", "scene", "target"}, for deixis refer.',
        ),
    ] = None,
    models: Models = None,
    strength: Annotated[float, typer.Option(metavar="WEIGHT", help="Weight of the shipped models, above 0.")] = 3.0,
    time_limit: Annotated[
        float,
        typer.Option(
            min=0.0,
            metavar="SECONDS",
            help="With --descriptions: end the fit after this time.",
        ),
    ] = 600.0,
    reset: Annotated[bool, typer.Option("--reset", help="Remove the learned models; keep the lessons.")] = False,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    as_json: AsJson = False,
) -> None:
    """Learn what relation words mean, from the memory and from scripts with labelled scenes.

    With --descriptions, learn what the words of deixis refer mean: relations, properties and frames of reference.
    """
    from deixis.report.descriptions.relation import learned_words_lines, learned_words_to_dict
    from deixis.session import Session

    if descriptions is not None:
        if files or models or reset:
            raise typer.BadParameter("--descriptions takes no scripts, no --models and no --reset")
        _learn_reference(descriptions, out, strength, time_limit, as_json)
        return
    _require_fitting(files, out, models, reset, no_memory)
    if out is not None:
        require_ending(out, (".ttl",), "a file of models")
        require_writable([out], [*(files or []), models])
    with Session(memory) as session:
        if reset:
            session.forget_relations()
            where = session.path
            note_change(where)
            print_json({"reset": str(where)}) if as_json else print_line(f"{where} uses the shipped models again.")
            return
        examples = _examples(files or [])
        if out is None:
            with progress_bar("fitting the models"):
                learned, where = session.learn_relations(examples, strength), session.path
            note_change(where)
        else:
            with progress_bar("fitting the models"):
                learned, where = _fitted(session, examples, strength, models, no_memory), out
            _write(learned, out)
    if as_json:
        print_json(learned_words_to_dict(learned, str(where)))
    else:
        print_lines(learned_words_lines(learned))
        print_lines([f"{where} now uses these models."] if out is None else [])
        print_written(out)


def _learn_reference(descriptions: Path, out: Path | None, strength: float, time_limit: float, as_json: bool) -> None:
    """Learn the weights of ``deixis refer`` from a file of descriptions, and write them to ``out``."""
    from deixis.errors import DeixisError
    from deixis.report.descriptions.relation import learned_reference_to_dict
    from deixis.workflows.descriptions.learn_reference import learn_reference, write_reference

    if out is None:
        raise DeixisError("--descriptions needs a file for the weights; name it with -o FILE.json")
    require_ending(out, (".json",), "a file of weights")
    require_writable([out], [descriptions])
    with progress_bar("fitting the weights") as progress:
        learned = learn_reference(descriptions, strength, progress=progress, time_limit=time_limit)
    write_reference(learned.model, out, f"Learned from {learned.descriptions} descriptions in {descriptions.name}")
    if as_json:
        print_json(learned_reference_to_dict(learned, str(out)))
    else:
        print_lines(learned.to_text().split("\n"))
        print_written(out)


def _require_fitting(
    files: list[str] | None, out: Path | None, models: Path | None, reset: bool, no_memory: bool
) -> None:
    """Check that the options go together; raise DeixisError otherwise."""
    from deixis.errors import DeixisError

    if reset and (files or out or models or no_memory):
        raise DeixisError("--reset excludes scripts and all other options except --memory; learn in a second command")
    if files and len(files) % 2:
        raise DeixisError(f"scripts and scenes come in pairs; '{files[-1]}' has no scene")
    if out is None and no_memory:
        raise DeixisError("--no-memory leaves no place to keep the models; name a file with -o FILE")
    if out is None and models is not None:
        raise DeixisError("--models needs -o FILE; a memory always starts from the shipped models")
    if no_memory and not files:
        raise DeixisError("with --no-memory there is nothing to learn from; name scripts and labelled scenes")


def _examples(files: list[str]) -> list[tuple[Script, Scene]]:
    from deixis.workflows.layouts.read import load_scene, read_script

    return [(read_script(script), load_scene(scene)) for script, scene in zip(files[::2], files[1::2], strict=True)]


def _fitted(
    session: Session, examples: list[tuple[Script, Scene]], strength: float, models: Path | None, no_memory: bool
) -> LearnedWords:
    """Return the models learned from the examples and the memory, without storing them.

    Raises DeixisError where no example teaches anything.
    """
    from deixis.errors import DeixisError
    from deixis.learning.lessons.recollection import Recollection
    from deixis.learning.models.words import example_pairs, fit, teaching

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
    from deixis.text_files import replace_text

    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        replace_text(out, models_to_turtle(learned.models.models.values()))
    except OSError as error:
        raise DeixisError(f"{out}: cannot write the models: {error.strerror}") from error
