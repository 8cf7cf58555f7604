"""The tour that ``deixis demo`` prints, on shipped data."""

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
"""Seeds of the further tables from which views of things are learned."""


def tell(out: Path) -> None:
    """Print the tour and write its pictures into the folder ``out``."""
    from rich.console import Console

    require_picture(out / "script1.png")
    require("open3d", "simulating a depth camera")
    console = Console(file=terminal(sys.stdout), highlight=False, soft_wrap=True)
    script1, scene = read_script(example("script1.layout")), read_scene(example("place_setting.scene.json"))

    _chapter(console, 1, "A person describes a laid table")
    _listing(console, script_lines(script1))

    _chapter(console, 2, "The robot sees a table, but knows no names")
    _say(console, f"It sees {len(scene.objects)} boxes, from the {scene.viewpoint}: {', '.join(scene.ids)}.")

    _chapter(console, 3, "Which object does each name refer to, by the words alone?")
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

    _chapter(console, 5, "A fact that the script implies but does not state")
    fact = infer(full).implications.derive(full.ontology.relations["left"], "salad_fork", "soup_spoon")
    _listing(console, list(fact.lines()) if fact is not None else [])

    _chapter(console, 6, "A script that contradicts itself")
    _listing(console, inference_lines(infer(example("contradiction.layout"))))

    with tempfile.TemporaryDirectory() as folder, Session(Path(folder) / "memory") as session:
        _remembered(console, session, full, scene, out)


def _remembered(console: Console, session: Session, full: Script, scene: Scene, out: Path) -> None:
    """Print the part of the tour that needs a memory."""
    _chapter(console, 7, "The robot learns the layout")
    learned = session.learn(full, scene)
    _listing(console, learned_lines(learned, "a memory of its own, for this demo"))

    _chapter(console, 8, "A SPARQL query: which cutlery is known, and from which lesson?")
    _listing(console, QUERY.splitlines())
    _listing(console, session.query(QUERY).to_table())

    _chapter(console, 9, "Another table, with labelled things. What is wrong with it?")
    second = read_scene(example("second_table.scene.json"))
    checked = session.check("formal_dinner", second)
    _listing(console, check_lines(checked))
    plot_check(checked, out / "second_table.png")
    _say(console, f"Picture: {out / 'second_table.png'}")
    _seen(console, session, full, out)


def _seen(console: Console, session: Session, full: Script, out: Path) -> None:
    """Print the part of the tour that starts from a point cloud."""
    from deixis.plots.seen import plot_perceived, plot_recognised
    from deixis.workflows.lay_table import lay_script
    from deixis.workflows.perceive import perceive, write_scene
    from deixis.workflows.simulate import simulate

    def look(seed: int, name: str) -> Scene:
        scene = perceive(simulate(lay_script(full, seed), seed=seed).cloud)
        write_scene(scene, out / f"{name}.scene.json")
        return scene

    _chapter(console, 10, "The same table seen by a simulated depth camera: points instead of boxes")
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
    _say(console, f"After {len(MORE_TABLES)} more tables, the memory holds {views} views with names.")

    _chapter(console, 11, "Another cloud without a description. What does the robot recognise?")
    found = session.recognise(look(20, "another"))
    _listing(console, [f"{id:<5} {answer_words(answer)}" for id, answer in found.answers.items()])
    plot_recognised(found, out / "another.png")
    _say(console, f"Picture: {out / 'another.png'}")


def full_text(name: str) -> list[str]:
    """Return the lines of a shipped script."""
    return example(name).read_text(encoding="utf-8").splitlines()


def _ambiguity(found: Grounding, with_sizes: Grounding) -> list[str]:
    open_names, left = ([m.object for m in f.matches.values() if not m.decided] for f in (found, with_sizes))
    settled = "settle all of them" if not left else f"leave {len(left)} open"
    return [
        f"All {len(found.satisfied)} facts hold, but {len(open_names)} of {len(found.matches)} names stay open:",
        "three pairs could swap their names, and fish knife and soup spoon could be any two in a row on the right.",
        f"Deixis reports this instead of a guess. The usual sizes of such things {settled}.",
    ]


def _chapter(console: Console, number: int, title: str) -> None:
    console.print(f"\n[bold]{number}. {title}[/bold]")


def _say(console: Console, *lines: str) -> None:
    for line in lines:
        console.print(f"   {line}", markup=False)


def _listing(console: Console, lines: Iterable[str]) -> None:
    for line in lines:
        console.print(f"   [dim]│[/dim] {line}" if "[" not in line else f"   │ {line}", markup="[" not in line)
