"""The story that ``deixis demo`` tells in the terminal, on shipped data."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.cli.output import terminal
from deixis.examples_data import example
from deixis.extras import require
from deixis.grammar.script import Script
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.plots.check import plot_check
from deixis.plots.figure import require_picture
from deixis.plots.grounding import plot_grounding
from deixis.reasoning.grounding.answer import Grounding
from deixis.reasoning.grounding.evidence.meaning import Meaning
from deixis.reasoning.grounding.evidence.unary import UnaryWeights
from deixis.report.ground import grounding_lines
from deixis.report.script import check_lines, inference_lines, learned_lines, script_lines
from deixis.report.seen import answer_words
from deixis.session import Session
from deixis.workflows.ground import ground
from deixis.workflows.infer import infer
from deixis.workflows.read import read_script

if TYPE_CHECKING:
    from rich.console import Console


QUERY = """SELECT ?object ?kind ?lesson WHERE {
  ?match dx:category ?category ; dx:ofRole/dx:ofKind ?kind ; prov:wasGeneratedBy ?lesson .
  ?category rdfs:label ?object ; rdfs:subClassOf dx:Cutlery .
} ORDER BY ?object"""

MORE_TABLES = (8, 9)
"""Seeds of the tables from which what things look like is learned, beside the first."""


def tell(out: Path) -> None:
    """Tells the story and leaves its pictures in ``out``."""
    from rich.console import Console

    require_picture(out / "script1.png")
    require("open3d", "simulating a depth camera")
    console = Console(file=terminal(sys.stdout), highlight=False, soft_wrap=True)
    script1, scene = read_script(example("script1.layout")), read_scene(example("place_setting.scene.json"))

    _chapter(console, 1, "Somebody says how a table is laid")
    _listing(console, script_lines(script1))

    _chapter(console, 2, "The robot looks at a table and can name nothing on it")
    _say(console, f"It sees {len(scene.objects)} boxes, from the {scene.viewpoint}: {', '.join(scene.ids)}.")

    _chapter(console, 3, "Who is who, going by the words alone?")
    found = ground(script1, scene, meaning=Meaning(weights=UnaryWeights(sizes=0.0)))
    _listing(console, grounding_lines(found))
    _say(console, *_ambiguity(found, ground(script1, scene)))
    plot_grounding(found, out / "script1.png", script1.title)
    _say(console, f"Picture: {out / 'script1.png'}")

    _chapter(console, 4, "A fuller script settles it")
    full = read_script(example("formal_dinner.layout"))
    _listing(console, full_text("formal_dinner.layout"))
    settled = ground(full, scene)
    _listing(console, grounding_lines(settled))

    _chapter(console, 5, "What the script implies without saying so")
    fact = infer(full).implications.derive(full.ontology.relations["left"], "salad_fork", "soup_spoon")
    _listing(console, list(fact.lines()) if fact is not None else [])

    _chapter(console, 6, "A script that cannot be laid")
    _listing(console, inference_lines(infer(example("contradiction.layout"))))

    with tempfile.TemporaryDirectory() as folder, Session(Path(folder) / "memory") as session:
        _remembered(console, session, full, scene, out)


def _remembered(console: Console, session: Session, full: Script, scene: Scene, out: Path) -> None:
    """The part of the story that needs a memory."""
    _chapter(console, 7, "What was understood is learned")
    learned = session.learn(full, scene)
    _listing(console, learned_lines(learned, "a memory of its own, for this demo"))

    _chapter(console, 8, "And can be asked for, in SPARQL: what cutlery do I know, and from which lesson?")
    _listing(console, QUERY.splitlines())
    _listing(console, session.query(QUERY).to_table())

    _chapter(console, 9, "Another table, whose things have names by now. What is wrong with it?")
    second = read_scene(example("second_table.scene.json"))
    checked = session.check("formal_dinner", second)
    _listing(console, check_lines(checked))
    plot_check(checked, out / "second_table.png")
    _say(console, f"Picture: {out / 'second_table.png'}")
    _seen(console, session, full, out)


def _seen(console: Console, session: Session, full: Script, out: Path) -> None:
    """The part of the story that begins with a point cloud."""
    from deixis.plots.seen import plot_perceived, plot_recognised
    from deixis.workflows.lay_table import lay_script
    from deixis.workflows.perceive import perceive, write_scene
    from deixis.workflows.simulate import simulate

    def look(seed: int, name: str) -> Scene:
        scene = perceive(simulate(lay_script(full, seed), seed=seed).cloud)
        write_scene(scene, out / f"{name}.scene.json")
        return scene

    _chapter(console, 10, "The same with a depth camera, simulated: points, and no boxes")
    table = look(7, "table")
    points = 0 if table.detection is None else len(table.detection.cloud)
    _say(console, f"{points} points; {len(table.objects)} things found on the table.")
    plot_perceived(table, out / "table.png")
    _say(console, f"Picture: {out / 'table.png'}")
    taught = session.learn(full, table)
    _listing(console, grounding_lines(taught.grounding)[: len(taught.grounding.matches)])
    for seed in MORE_TABLES:
        session.learn(full, look(seed, f"table-{seed}"))
    views = sum(session.categories().values())
    _say(console, f"After {len(MORE_TABLES)} more tables it has kept {views} views, each under its name.")

    _chapter(console, 11, "Another table of points, and nobody says a word. What looks familiar?")
    found = session.recognise(look(20, "another"))
    _listing(console, [f"{id:<5} {answer_words(answer)}" for id, answer in found.answers.items()])
    plot_recognised(found, out / "another.png")
    _say(console, f"Picture: {out / 'another.png'}")


def full_text(name: str) -> list[str]:
    """A shipped script as it stands."""
    return example(name).read_text(encoding="utf-8").splitlines()


def _ambiguity(found: Grounding, with_sizes: Grounding) -> list[str]:
    open_names, left = ([m.object for m in f.matches.values() if not m.decided] for f in (found, with_sizes))
    settled = "settles them all" if not left else f"leaves {len(left)}"
    return [
        f"By the words alone all {len(found.satisfied)} facts hold, and still {len(open_names)} of "
        f"{len(found.matches)} names are open:",
        "three pairs could trade names unnoticed, and fish knife and soup spoon be any two in a row on the right.",
        f"Deixis says so, instead of passing off a lucky order as knowledge. How large such things are {settled}.",
    ]


def _chapter(console: Console, number: int, title: str) -> None:
    console.print(f"\n[bold]{number}. {title}[/bold]")


def _say(console: Console, *lines: str) -> None:
    for line in lines:
        console.print(f"   {line}", markup=False)


def _listing(console: Console, lines: Iterable[str]) -> None:
    for line in lines:
        console.print(f"   [dim]│[/dim] {line}" if "[" not in line else f"   │ {line}", markup="[" not in line)
