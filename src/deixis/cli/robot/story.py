"""The tour that ``deixis demo`` prints, on shipped data."""

from __future__ import annotations

import math
import re
import sys
import tempfile
from contextlib import closing
from pathlib import Path

from deixis.cli.output import terminal
from deixis.cli.robot.tour import Tour
from deixis.examples_data import example
from deixis.extras import require
from deixis.grammar.script import Script
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.plots.check import plot_check
from deixis.plots.figure import require_picture
from deixis.plots.grounding import plot_grounding
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.evidence.properties.unary import UnaryWeights
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.report.grounding.ground import grounding_lines
from deixis.report.layouts.script import check_lines, inference_lines, learned_lines, script_lines
from deixis.report.scenes.seen import answer_words
from deixis.session import Session
from deixis.workflows.grounding.ground import ground
from deixis.workflows.layouts.infer import infer
from deixis.workflows.layouts.read import read_script

QUERY = """SELECT ?object ?kind ?lesson WHERE {
  ?match dx:category ?category ; dx:ofRole/dx:ofKind ?kind ; prov:wasGeneratedBy ?lesson .
  ?category rdfs:label ?object ; rdfs:subClassOf dx:Cutlery .
} ORDER BY ?object"""

CHAPTERS = 12
"""Number of chapters of the tour."""

MORE_TABLES = (8, 9)
"""Seeds of the further tables from which views of things are learned."""


def tell(out: Path) -> None:
    """Print the tour and write its pictures, and a page with all of it, into the folder ``out``."""
    from rich.console import Console

    require_picture(out / "script1.png")
    require("open3d", "simulating a depth camera")
    with closing(Tour(Console(file=terminal(sys.stdout), highlight=False, soft_wrap=True), out, CHAPTERS)) as tour:
        _tell(tour, out)


def _tell(tour: Tour, out: Path) -> None:
    script1, scene = read_script(example("script1.layout")), read_scene(example("place_setting.scene.json"))

    tour.chapter("A person describes a laid table", "deixis parse examples/script1.layout")
    tour.listing(script_lines(script1))

    tour.chapter("The robot sees a table, but knows no names")
    tour.say(f"It sees {len(scene.objects)} boxes, from the {scene.viewpoint}: {', '.join(scene.ids)}.")

    tour.chapter(
        "Which object does each name refer to, by the words alone?",
        "deixis ground examples/script1.layout examples/place_setting.scene.json --no-sizes --plot out/script1.png",
    )
    found = ground(script1, scene, meaning=Meaning(weights=UnaryWeights(sizes=0.0)))
    tour.listing(grounding_lines(found))
    tour.say(*_ambiguity(found, ground(script1, scene)))
    plot_grounding(found, out / "script1.png", script1.title)
    tour.picture("script1.png", "The scene with the names that the words alone give")

    tour.chapter(
        "A fuller script settles it", "deixis ground examples/formal_dinner.layout examples/place_setting.scene.json"
    )
    full = read_script(example("formal_dinner.layout"))
    tour.listing(full_text("formal_dinner.layout"))
    settled = ground(full, scene)
    tour.listing(grounding_lines(settled))

    tour.chapter(
        "A fact that the script implies but does not state",
        "deixis infer examples/formal_dinner.layout --explain 'left(salad_fork, soup_spoon)'",
    )
    fact = infer(full).implications.derive(full.ontology.relations["left"], "salad_fork", "soup_spoon")
    tour.listing(list(fact.lines()) if fact is not None else [])

    tour.chapter("A script that contradicts itself", "deixis infer examples/contradiction.layout")
    tour.listing(inference_lines(infer(example("contradiction.layout"))))

    with tempfile.TemporaryDirectory() as folder, Session(Path(folder) / "memory") as session:
        _remembered(tour, session, full, scene, out)
    _running(tour, out)
    tour.write_page()


def _remembered(tour: Tour, session: Session, full: Script, scene: Scene, out: Path) -> None:
    """Print the part of the tour that needs a memory."""
    tour.chapter(
        "The robot learns the layout",
        "deixis learn examples/formal_dinner.layout examples/place_setting.scene.json --memory out/memory",
    )
    learned = session.learn(full, scene)
    tour.listing(learned_lines(learned, "a memory of its own, for this demo"))

    tour.chapter(
        "A SPARQL query: which cutlery is known, and from which lesson?", f"deixis query '{QUERY}' --memory out/memory"
    )
    tour.listing(QUERY.splitlines())
    tour.listing(session.query(QUERY).to_table())

    tour.chapter(
        "Another table, with labelled things. What is wrong with it?",
        "deixis check formal_dinner examples/second_table.scene.json --memory out/memory --plot out/second_table.png",
    )
    second = read_scene(example("second_table.scene.json"))
    checked = session.check("formal_dinner", second)
    tour.listing(check_lines(checked))
    plot_check(checked, out / "second_table.png")
    tour.picture("second_table.png", "The second table with its errors")
    _seen(tour, session, full, out)


def _seen(tour: Tour, session: Session, full: Script, out: Path) -> None:
    """Print the part of the tour that starts from a point cloud."""
    from deixis.plots.seen import plot_perceived, plot_recognised
    from deixis.workflows.layouts.lay_table import lay_script
    from deixis.workflows.scenes.perceive import perceive, write_scene
    from deixis.workflows.scenes.simulate import simulate

    def look(seed: int, name: str) -> Scene:
        scene = perceive(simulate(lay_script(full, seed), seed=seed).cloud)
        write_scene(scene, out / f"{name}.scene.json")
        return scene

    tour.chapter(
        "The same table seen by a simulated depth camera: points instead of boxes",
        "deixis simulate examples/formal_dinner.layout --seed 7 -o out/cloud.pcd",
        "deixis perceive out/cloud.pcd -o out/seen.scene.json",
        "deixis learn examples/formal_dinner.layout out/seen.scene.json --memory out/memory",
    )
    table = look(7, "table")
    points = 0 if table.detection is None else len(table.detection.cloud)
    tour.say(f"{points} points; {len(table.objects)} things found on the table.")
    plot_perceived(table, out / "table.png")
    tour.picture("table.png", "The things found in the point cloud")
    taught = session.learn(full, table)
    tour.listing(grounding_lines(taught.grounding)[: len(taught.grounding.matches)])
    for seed in MORE_TABLES:
        session.learn(full, look(seed, f"table-{seed}"))
    views = sum(session.categories().values())
    tour.say(f"After {len(MORE_TABLES)} more tables, the memory holds {views} views with names.")

    tour.chapter(
        "Another cloud without a description. What does the robot recognise?",
        "deixis simulate examples/formal_dinner.layout --seed 20 -o out/other.pcd",
        "deixis perceive out/other.pcd -o out/other.scene.json",
        "deixis recognise out/other.scene.json --memory out/memory",
    )
    found = session.recognise(look(20, "another"))
    tour.listing([f"{id:<5} {answer_words(answer)}" for id, answer in found.answers.items()])
    plot_recognised(found, out / "another.png")
    tour.picture("another.png", "The things recognised in another cloud")


def _running(tour: Tour, out: Path) -> None:
    """Print the part of the tour in which the robot runs on a film of one table and two customers."""
    from deixis.plots.live_story import OVERVIEW, write_story
    from deixis.robot.live.run import live_robot
    from deixis.robot.live.story import StorySettings

    tour.chapter(
        "The robot runs: a teacher shows and tells, and asks about the next customer's table",
        "deixis robot run --from simulator --seed 1 --memory out/robot --story out/live",
    )
    lines: list[str] = []
    with (
        tempfile.TemporaryDirectory() as folder,
        live_robot(Path(folder) / "memory", StorySettings("simulator", seed=1), lines.append) as robot,
    ):
        robot.wait()
        write_story(robot, out / "live")
    heard = lines[1:]  # after the line that names the memory, which is a temporary folder
    tour.listing(sorted(heard, key=_start_of))  # a sentence is printed at its end, with the time of its beginning
    tour.picture(
        f"live/{OVERVIEW}",
        "A teacher points at a thing, describes the layout, and asks what is wrong",
    )


def _start_of(line: str) -> float:
    """Return the seconds with which a line of the conversation begins; infinity for a line without a time."""
    seconds = re.match(r" *(\d+\.\d) s  ", line)
    return float(seconds[1]) if seconds else math.inf


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
