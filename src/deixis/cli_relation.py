"""The commands about what relation words mean: to look at one, and to learn them from examples."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli_common import AsJson, print_json, print_lines

if TYPE_CHECKING:
    from deixis.ontology.relation_models import RelationModels
    from deixis.reasoning.graded.lessons import SaidPairs

Models = Annotated[
    Path | None, typer.Option("--models", metavar="FILE", help="Graded models (.ttl) in place of the shipped ones.")
]


def relation(
    word: Annotated[str, typer.Argument(metavar="WORD", help="A relation word: left, 'on top of', exactly_left.")],
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw its field (.png, .svg, .pdf).")] = None,
    models: Models = None,
    as_json: AsJson = False,
) -> None:
    """Print what a relation word means: in both readings, and by degrees."""
    from deixis.ontology.errors import UnknownTermError
    from deixis.ontology.relation import nearest, plain_phrase
    from deixis.ontology.tbox import default_ontology
    from deixis.plot import require_picture
    from deixis.show_relation import relation_lines, relation_to_dict

    relations = default_ontology().relations
    found = relations.by_word.get(plain_phrase(word))
    if found is None:
        hint = nearest(plain_phrase(word), relations.by_word)
        advice = f"; did you mean '{hint}'?" if hint else ""
        raise UnknownTermError(f"no relation is called '{word}'" + advice)
    known = read_models(models)
    if plot is not None:
        require_picture(plot)
    if as_json:
        print_json(relation_to_dict(found, relations, known))
    else:
        print_lines(relation_lines(found, relations, known))
    if plot is not None:
        from deixis.plot_relation import plot_relation

        plot_relation(found, known, plot)
        if not as_json:
            print(f"Written: {plot}")


def learn_relation(
    files: Annotated[
        list[str], typer.Argument(metavar="SCRIPT SCENE...", help="Scripts, each with the labelled scene it describes.")
    ],
    out: Annotated[Path, typer.Option("-o", "--out", metavar="FILE", help="Write the models as Turtle (.ttl).")],
    models: Models = None,
    strength: Annotated[float, typer.Option(help="How strongly what is known already holds; above 0.")] = 1.0,
    as_json: AsJson = False,
) -> None:
    """Learn what relation words mean from scenes whose things are labelled as the scripts name them."""
    from deixis import __version__
    from deixis.ontology.errors import DeixisError
    from deixis.ontology.relation_model_triples import models_to_turtle
    from deixis.reasoning.graded.fitting import FitSettings, learn_relations
    from deixis.show_relation import learned_lines, model_to_dict

    if len(files) % 2:
        raise DeixisError(f"scripts and scenes come in pairs; '{files[-1]}' has no scene")
    pairs = list(zip(files[::2], files[1::2], strict=True))
    known = read_models(models)
    lessons = [_lesson(script, scene) for script, scene in pairs]
    if not any(len(lesson.words) for lesson in lessons):
        raise DeixisError("nothing to learn: no plain fact has both its objects among the labels of its scene")
    sources = [f"{script} {scene}" for script, scene in pairs]
    learned = learn_relations(lessons, known, FitSettings(strength), sources, __version__)
    changed = [name for name in learned.models if learned[name] != known[name]]
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(models_to_turtle(learned.models.values()), encoding="utf-8")
    except OSError as error:
        raise DeixisError(f"{out}: the models cannot be written: {error.strerror}") from error
    if as_json:
        print_json({"learned": [model_to_dict(learned[name]) for name in changed], "written": str(out)})
    else:
        print_lines(learned_lines(learned, changed, str(out)))


def read_models(path: Path | None) -> RelationModels:
    """The shipped models, with those of a Turtle file in their place; raises OntologyError where it has none."""
    from deixis.ontology.errors import OntologyError
    from deixis.ontology.relation_model_triples import models_from_turtle
    from deixis.reasoning.graded.shipped import shipped_models

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


def _lesson(script_file: str, scene_file: str) -> SaidPairs:
    """What a script and its labelled scene teach: an object is the one thing whose label calls it."""
    from deixis.grammar.parser import read_script
    from deixis.reasoning.graded.lessons import said_pairs
    from deixis.reasoning.labels import objects_called
    from deixis.session import load_scene

    description, scene = read_script(script_file).graph(), load_scene(scene_file)
    called: list[list[int]] = [[] for _ in description.nodes]
    for i, thing in enumerate(scene.objects):
        if thing.label is not None:
            for object in objects_called(description, thing.label).nonzero()[0].tolist():
                called[object].append(i)
    one = [things[0] if len(things) == 1 else None for things in called]
    taken = [thing for thing in one if thing is not None]
    things = [thing if thing is not None and taken.count(thing) == 1 else None for thing in one]
    confidence = [1.0 if thing is None else scene.objects[thing].confidence for thing in things]
    return said_pairs(description, scene.boxes, things, confidence)


def register(app: typer.Typer) -> None:
    """Adds the commands to the command line."""
    app.command()(relation)
    app.command("learn-relation")(learn_relation)
