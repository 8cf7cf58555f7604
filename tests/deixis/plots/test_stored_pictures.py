"""Compare a picture of each type with the stored one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from source_tree import ROOT
from stored_pictures import CHARTS, STORED, assert_as_stored

import deixis
from deixis.workflows.grounding.belonging import places_of

pytest.importorskip("matplotlib")

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 60
EXAMPLES = ROOT / "examples"


def scene() -> deixis.Scene:
    return deixis.read_scene(EXAMPLES / "place_setting.scene.json")


def decided_grounding() -> Figure:
    return deixis.ground(EXAMPLES / "formal_dinner.layout", scene()).plot()


def doubtful_grounding() -> Figure:
    """Draw a grounding with enough time to sample the same probabilities on a busy machine."""
    return deixis.ground(EXAMPLES / "script1.layout", scene(), sizes=False, time_limit=120.0).plot()


def check() -> Figure:
    """Draw a check, with enough time to find where the missing glass belongs on a busy machine too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("deixis.plots.check.places_of", partial(places_of, time_limit=120.0))
        return deixis.check(EXAMPLES / "formal_dinner.layout", EXAMPLES / "second_table.scene.json").plot()


def imagined_table() -> Figure:
    return deixis.imagine(deixis.read_script(EXAMPLES / "formal_dinner.layout")).plot()


def relation_field() -> Figure:
    from deixis.ontology.tbox import default_ontology
    from deixis.plots.relation import relation_figure
    from deixis.reasoning.grounding.evidence.words.meaning import shipped_models

    return relation_figure(default_ontology().relations["left"], shipped_models(), steps=61)


def scene_of_boxes() -> Figure:
    return scene().plot()


@cache
def scene_in_a_cloud(seed: int) -> deixis.Scene:
    pytest.importorskip("open3d")
    return deixis.perceive(deixis.simulate(EXAMPLES / "formal_dinner.layout", seed=seed).cloud)


def perceived_table() -> Figure:
    return scene_in_a_cloud(7).plot()


def recognised_table() -> Figure:
    """Draw stated answers: a sure name, a likely one and an unknown thing in turn, the same on every processor."""
    from deixis.learning.views.views import Recognised
    from deixis.perception.recognition.calibration import SHIPPED
    from deixis.perception.recognition.recogniser import Candidate, Recognition
    from deixis.perception.recognition.spread import Width, spreads

    (spread,) = spreads([Width(None, 0)], 1.0)

    def answer(label: str | None, probability: float, unknown: float) -> Recognition:
        candidate = Candidate("dinner_fork", 1.0, spread, 1.0, "a", 3, probability)
        return Recognition(label, (candidate,), unknown, SHIPPED, True, ())

    answers = [answer("dinner_fork", 0.9, 0.1), answer(None, 0.6, 0.4), answer(None, 0.2, 0.8)]
    scene = scene_in_a_cloud(7)
    return Recognised(scene, {thing.id: answers[k % 3] for k, thing in enumerate(scene.objects)}).plot()


def looked_at_table() -> Figure:
    """Draw a robot's look at a table on which fork and knife are exchanged and the cup is missing."""
    places = {"fork": (0.0, 0.02), "plate": (0.1, 0.0), "knife": (0.36, 0.02), "cup": (0.34, 0.3)}
    sizes = {"fork": (0.025, 0.2), "plate": (0.22, 0.22), "knife": (0.02, 0.21), "cup": (0.08, 0.08)}

    def table(**places: tuple[float, float]) -> deixis.Scene:
        low = np.array([(*place, 0.0) for place in places.values()])
        return deixis.Scene.from_boxes(low, low + [(*sizes[name], 0.02) for name in places], labels=list(places))

    with TemporaryDirectory() as folder, deixis.Robot(Path(folder) / "memory") as robot:
        robot.sees(table(**places), at=0.0)
        robot.told("layout supper; fork left of plate; knife right of plate; cup above knife", at=1.0)
        robot.sees(table(**{name: (x + 0.004, y) for name, (x, y) in places.items()}), at=2.0)
        robot.told("layout supper; fork left of plate; knife right of plate; cup above knife", at=3.0)
        robot.sees(table(plate=places["plate"], fork=places["knife"], knife=places["fork"]), at=4.0)
        return robot.look().plot()


def story(path: Path) -> None:
    """Draw two moments of a live run, seen as discs and a bar in a small image."""
    from deixis.plots.live_story import write_moments
    from deixis.robot.live.moments import Moment

    y, x = np.mgrid[0:120, 0:160]
    owner = np.full((120, 160), -1)
    owner[(x - 60) ** 2 + (y - 60) ** 2 < 900] = 0
    owner[(abs(x - 120) < 6) & (abs(y - 60) < 35)] = 1
    image = np.array([(120, 90, 60), (210, 215, 225), (170, 172, 178)], np.uint8)[owner + 1]
    view = path.with_suffix(".npz")
    np.savez(view, image=np.kron(image, np.ones((4, 4, 1), np.uint8)), owner=owner, ids=np.array(["t1", "t2"]))
    none: frozenset[str] = frozenset()
    words = (("teacher", "This is a plate."), ("robot", "I see: t1 is a plate."))
    first = Moment(1.0, view, {"t1": "plate", "t2": None}, none, frozenset({"t1"}), words, None, ())
    last = Moment(9.0, view, {"t1": "plate", "t2": "fork"}, none, none, (), "lunch", ("the knife is missing",))
    write_moments([first, last], path)


def apprentice_frame(path: Path) -> None:
    """Draw a frame of the apprentice's story: known names, a mistake and a thing without a name."""
    from deixis.experiments.apprentice.story import _draw
    from deixis.plots.figure import BELONGS, INK, WRONG

    scene = scene_in_a_cloud(7)
    looks = [("dinner fork", BELONGS), ("soup spoon", WRONG), ("?", INK)]
    _draw(scene, {id: looks[k % 3] for k, id in enumerate(scene.ids)}, "Table 1 is laid as: formal dinner.", path)


def doubtful_reference() -> Figure:
    return deixis.refer("the chair", EXAMPLES / "study.scene.json").plot()


def chronology() -> Figure:
    return replace(deixis.chronology(EXAMPLES / "serving.fluents.json"), file="serving.fluents.json").plot()


def retrieval() -> Figure:
    return deixis.retrieve(scene(), EXAMPLES, least=0.6).plot()


def tracked_things() -> Figure:
    from deixis.perception.simulator.films.stage import Rest, TakeAway, film
    from deixis.perception.simulator.laying import Placement
    from deixis.workflows.scenes.track import track

    things = [Placement("mug", "mug", 0.2, 0.0, seed=1), Placement("plate", "dinner plate", -0.1, 0.0, seed=2)]
    story = film(things, [Rest(0.3), TakeAway("mug"), Rest(1.2)])
    return track(SimpleNamespace(frames=lambda: story.frames(6, scale=0.4))).plot()


PICTURES: list[Callable[[], Figure]] = [
    decided_grounding,
    doubtful_grounding,
    check,
    imagined_table,
    relation_field,
    scene_of_boxes,
    perceived_table,
    recognised_table,
    looked_at_table,
    doubtful_reference,
    chronology,
    retrieval,
    tracked_things,
]


@pytest.mark.parametrize("draw", PICTURES, ids=lambda draw: draw.__name__)
def test_a_picture_is_as_stored(draw: Callable[[], Figure], tmp_path: Path) -> None:
    drawn = tmp_path / "drawn.png"
    draw().savefig(drawn, dpi=DPI)
    assert_as_stored(draw.__name__, drawn)


@pytest.mark.parametrize("draw", [story, apprentice_frame], ids=lambda draw: draw.__name__)
def test_a_picture_of_a_story_is_as_stored(draw: Callable[[Path], None], tmp_path: Path) -> None:
    draw(tmp_path / "drawn.png")
    assert_as_stored(draw.__name__, tmp_path / "drawn.png")


def test_every_stored_picture_is_compared() -> None:
    names = {"story", "apprentice_frame", *CHARTS, *(draw.__name__ for draw in PICTURES)}
    assert {path.stem for path in STORED.glob("*.png")} == names
