"""Stories: what a robot sees and hears in the order of time, from a camera, a recorded folder or the simulator.

A folder has clouds (see :class:`~deixis.perception.tracking.frames.stream.FolderSource`) and, if there are any, the
words (``words.said.jsonl``) and the skeletons (``people.skeleton.jsonl``) of persons, on the clock of the clouds.
Skeletons are in the frame of the camera.

A live story does not wait for the robot: a thread reads its frames, and frames that come too fast are dropped and
counted.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from heapq import merge
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from deixis.answers import count
from deixis.grammar.utterances import Utterance
from deixis.ontology.things.kinds import plain_name, with_article
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import Scene
from deixis.perception.tracking.frames.frame import Frame
from deixis.perception.tracking.frames.stream import CloudSource, LatestFrames
from deixis.reasoning.errors import SettingError
from deixis.robot.modules import made

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.perception.simulator.cameras.camera import Camera
    from deixis.perception.simulator.films.camera_paths import CameraPath
    from deixis.perception.simulator.laying import LaidThing

Event = Frame | Skeleton | Utterance

WORDS, PEOPLE = "words.said.jsonl", "people.skeleton.jsonl"
"""Names of the files of words and skeletons in the folder of a story."""

SPEECH_PAUSE = 1.5
"""Pause in seconds before and after what a simulated person says."""

RATE = 4.0
"""Default number of frames a second of the simulator."""

CUSTOMER_PAUSE = 5.0
"""Time in seconds between the two customers, in which the robot does not look."""

WAITER = "waiter"
"""Name of the simulated person who brings a thing while the robot looks."""

SIMULATED = ("simulator", "laying")
"""Simulated stories: a table for two customers, and a table laid by a person with a camera on her head."""

SPEECH_LEAD = 0.4
"""Seconds from the words that announce a thing to the movement of the hand."""

SWAP_PROBABILITY = 0.15
"""Probability that a simulated person exchanges a thing with the next one in her order."""


@dataclass(frozen=True, eq=False)
class StoryTruth:
    """True state of a simulated story, for scoring a robot.

    Attributes
    ----------
    things
        The things on the table at the end, with their names, in the frame of the simulated table.
    camera
        The camera with its mean pose in that frame.
    forgotten
        Name of the thing that is missing at the end, or None.
    laid
        Names of the things in the order in which a person laid them while the robot looked.
    path
        Movement of the camera; None if it stands still.
    """

    things: Scene
    camera: Camera
    forgotten: str | None = None
    laid: tuple[str, ...] = ()
    path: CameraPath | None = None

    def camera_at(self, at: float) -> Camera:
        """Return the camera with its pose at a time.

        Parameters
        ----------
        at
            Time of the story in seconds.

        Returns
        -------
        Camera
            The camera with its pose in the frame of the simulated table.
        """
        return self.camera if self.path is None else self.path.moved(self.camera, at)


@dataclass(frozen=True, eq=False)
class Story:
    """Events in the order of their times, which :meth:`events` yields one by one.

    ``truth`` is that of a simulated story, and ``notes`` are the messages about lines of its files that are left out.
    """

    frames: Iterable[Frame]
    words: tuple[Utterance, ...] = ()
    skeletons: tuple[Skeleton, ...] = ()
    truth: StoryTruth | None = None
    live: LatestFrames | None = None
    notes: tuple[str, ...] = ()

    @property
    def dropped(self) -> int:
        """Number of frames that came too late to be seen."""
        return 0 if self.live is None else self.live.dropped

    def events(self) -> Iterator[Event]:
        """Yield the events in the order of their times.

        Yields
        ------
        Event
            A frame, a skeleton or an utterance; of several at one time, the frame first.
        """
        return merge(self.frames, self.skeletons, self.words, key=lambda event: event.at)


@dataclass(frozen=True, slots=True)
class StorySettings:
    """Choice of what a robot looks at.

    Parameters
    ----------
    source
        ``simulator``, ``laying``, a folder with clouds, or a camera driver as ``package.module:Class``.
    layout
        Script of the simulated table.
    seed
        Seed of the simulated story, 0 by default.
    rate
        Frames a second of the simulator, 4 by default.
    intrinsics
        File with the intrinsics of the camera, for depth images.
    grows
        True if the folder grows.
    words
        File of words in addition to those of the story, such as those of a speech recogniser (``.said.jsonl``).
    live
        True to play the simulated story or the recording at its own speed, as a camera does.
    camera
        Path of the camera in the story ``laying``: ``still``, ``sway`` (by default) or ``walk``.
    """

    source: str
    layout: str | None = None
    seed: int | None = None
    rate: float | None = None
    intrinsics: str | None = None
    grows: bool = False
    words: str | None = None
    live: bool = False
    camera: str | None = None

    def check(self) -> None:
        """Check the settings before the robot starts, and read the files that they name except clouds.

        Raises
        ------
        SettingError
            If a setting does not go with the source.
        ScriptError, UtteranceError, CloudError
            If the script, the words or the intrinsics cannot be read.
        SimulationError
            If there is no such path of the camera, or a script has too few things.
        """
        from deixis.grammar.utterances import read_utterances
        from deixis.perception.clouds.depth import read_intrinsics
        from deixis.perception.simulator.films.camera_paths import camera_path

        if self.camera is not None:
            camera_path(self.camera)  # an unknown path is an error in every story
        simulated = self.source in SIMULATED
        for needs, fits, settings in (
            ("a simulated story", simulated, ("layout", "seed", "rate")),
            ("the story 'laying'", self.source == "laying", ("camera",)),
            ("a folder of clouds", not (simulated or self._is_driver), ("intrinsics", "grows")),
        ):
            for setting in settings:
                given = getattr(self, setting)
                if not (given is None or given is False or fits):
                    raise SettingError(f"`{setting}` goes with {needs} only, not with '{self.source}'; leave it out")
        if simulated:
            _require_things(self._script(), 1)
        if self.words is not None:
            read_utterances(self.words)
        if self.intrinsics is not None:
            read_intrinsics(self.intrinsics)

    @property
    def _is_driver(self) -> bool:
        """True if the source names the class of a camera driver."""
        return self.source not in SIMULATED and not Path(self.source).exists() and ":" in self.source

    def _script(self) -> Script:
        """Return the script of the simulated table."""
        from deixis.examples_data import example
        from deixis.workflows.layouts.read import as_script

        return as_script(self.layout or str(example("tea.layout")))

    def story(self) -> Story:
        """Return the story.

        Returns
        -------
        Story
            The story, whose frames are read or computed one by one.

        Raises
        ------
        CloudError
            If there is no such folder, or it has no clouds.
        ModuleError
            If there is no such camera driver.
        UtteranceError, ScriptFileError, PointingError
            If ``words`` has a line that is not an utterance, or a file of words or skeletons cannot be read.
        SimulationError
            If no table can be laid as the script says, or there is no such path of the camera.
        SettingError
            If a setting does not go with the source.
        """
        from deixis.grammar.utterances import read_utterances
        from deixis.perception.tracking.frames.stream import LatestFrames

        self.check()
        if self.source in SIMULATED:
            script, seed = self._script(), self.seed or 0
            rate = RATE if self.rate is None else self.rate
            if self.source == "laying":
                found = laying_story(script, seed, rate, self.camera or "sway")
            else:
                found = simulated_story(script, seed, rate)
        elif self._is_driver:
            found = Story(made(self.source, CloudSource).frames())  # type: ignore[type-abstract]
        else:
            found = recorded_story(self.source, self.intrinsics, self.grows)
        if self.words is not None:
            words = sorted((*found.words, *read_utterances(self.words)), key=lambda utterance: utterance.at)
            found = replace(found, words=tuple(words))
        if not (self.live or self.grows or self._is_driver):
            return found
        latest = LatestFrames(AtOwnSpeed(found.frames) if self.live else Frames(found.frames))
        return replace(found, frames=latest.frames(), live=latest)


@dataclass(frozen=True, eq=False)
class Frames:
    """Source of given frames."""

    given: Iterable[Frame]

    def frames(self) -> Iterator[Frame]:
        """Yield the frames.

        Yields
        ------
        Frame
            The frames as they were given.
        """
        yield from self.given


class AtOwnSpeed(Frames):
    """Source that yields each frame when its time has come."""

    def frames(self) -> Iterator[Frame]:
        """Yield the frames.

        Yields
        ------
        Frame
            Each frame as long after the first one as their times say.
        """
        ahead: float | None = None
        for frame in self.given:
            now = time.monotonic()
            ahead = frame.at - now if ahead is None else ahead
            time.sleep(max(frame.at - ahead - now, 0.0))
            yield frame


def recorded_story(folder: str | Path, intrinsics: str | Path | None = None, grows: bool = False) -> Story:
    """Return the story in a folder.

    Parameters
    ----------
    folder
        The folder.
    intrinsics
        File with the intrinsics of the camera, for depth images.
    grows
        True to wait for further clouds.

    Returns
    -------
    Story
        The story. Its clouds are read one by one. A line of words or skeletons that is invalid is left out, and a note
        says so: a person who speaks cannot mend what a recogniser wrote.

    Raises
    ------
    CloudError
        If there is no such folder.
    ScriptFileError, PointingError
        If a file of words or skeletons cannot be read.
    """
    from deixis.grammar.utterances import read_utterances
    from deixis.perception.formats.skeletons import SkeletonFile, read_skeletons
    from deixis.perception.tracking.frames.stream import FolderSource

    place = Path(folder)
    source = FolderSource(place, grows=grows, intrinsics=intrinsics)
    refused: list[str] = []
    words = read_utterances(place / WORDS, refused) if (place / WORDS).exists() else ()
    people = read_skeletons(place / PEOPLE, refused) if (place / PEOPLE).exists() else SkeletonFile((), ())
    notes = [f"{message}; the line is left out" for message in refused] + list(people.notes)
    return Story(source.frames(), words, people.skeletons, notes=tuple(notes))


def simulated_story(script: Script, seed: int = 0, rate: float = RATE) -> Story:
    """Return a story of one table and two customers.

    The table is laid for the first customer. A teacher points at two things and names them, and says how the table is
    laid. For the second customer it is laid with other things of the same kinds: a waiter brings the last one while the
    robot looks, and one is forgotten. The teacher asks what is wrong.

    Parameters
    ----------
    script
        How the table is laid.
    seed
        Seed of the things, the teacher and the choices.
    rate
        Frames a second.

    Returns
    -------
    Story
        The story. Its frames are computed one by one.

    Raises
    ------
    SimulationError
        If no table can be laid as the script says, or it has fewer than two things on which nothing lies.
    """
    from deixis.perception.errors import SimulationError
    from deixis.perception.simulator.cameras.camera import chair_camera
    from deixis.perception.simulator.films.stage import Bring, Rest, Stage
    from deixis.perception.simulator.laying import LaidTable, top_under, truth_scene
    from deixis.perception.simulator.teacher import Teacher
    from deixis.workflows.descriptions.tell import tell
    from deixis.workflows.layouts.lay_table import lay_script

    _require_things(script, 2)
    rng = np.random.default_rng(seed)
    first, second = (lay_script(script, seed=seed + k).table for k in (0, 1))
    scene = truth_scene(first)
    free = [k for k, thing in enumerate(first.things) if not _supports_another(thing, first.things)]
    if len(free) < 2:
        raise SimulationError(f"{script.file}: the story needs at least two things on which nothing lies; state more")
    shown = sorted(rng.permutation(free)[:2].tolist())
    others = [k for k in free if k not in shown] or free
    forgotten, brought = (int(k) for k in (*rng.permutation(others), *shown)[:2])

    recording = Teacher(scene, seed).points_at([scene.ids[k] for k in shown], hold=1.5)
    words = [
        Utterance(
            f"This is {with_article(plain_name(first.things[k].name).replace('_', ' '))}.",
            SPEECH_PAUSE + aim.start,
            SPEECH_PAUSE + aim.finish,
            "teacher",
        )
        for k, aim in zip(shown, recording.aims, strict=True)
    ]
    description_at = SPEECH_PAUSE + recording.skeletons[-1].at + SPEECH_PAUSE
    name = (script.name or "this table").replace("_", " ")
    words.append(Utterance(f"This is how '{name}' is laid. {tell(script).text}", description_at, speaker="teacher"))

    before = Stage(first.things, seed)
    before.carry_out(Rest(description_at + SPEECH_PAUSE))
    after = Stage([thing for k, thing in enumerate(second.things) if k not in (forgotten, brought)], seed)
    after.carry_out(Rest(SPEECH_PAUSE))
    after.carry_out(Bring(second.things[brought]))
    after.carry_out(Rest(SPEECH_PAUSE))
    top = top_under((*first.things, *second.things))
    camera = chair_camera(LaidTable(top, (*first.things, *second.things)))
    left = tuple(thing for k, thing in enumerate(second.things) if k != forgotten)
    truth = StoryTruth(truth_scene(LaidTable(top, left)), camera, second.things[forgotten].name)
    films = [stage.film(top, camera) for stage in (before, after)]
    asked_at = films[0].seconds + CUSTOMER_PAUSE + films[1].seconds
    words.append(Utterance("What is wrong?", asked_at, speaker="teacher"))

    def frames() -> Iterator[Frame]:
        number = 0
        for film, start in zip(films, (0.0, films[0].seconds + CUSTOMER_PAUSE), strict=True):
            for frame in film.frames(rate, seed):
                yield Frame(frame.cloud, start + frame.at, number)
                number += 1

    later = films[0].seconds + CUSTOMER_PAUSE
    people = [replace(one, at=one.at + SPEECH_PAUSE) for one in recording.skeletons]
    people += [replace(one, at=one.at + later) for one in films[1].skeletons(WAITER, seed=seed)]
    return Story(frames(), tuple(words), tuple(_as_seen(one, camera) for one in people), truth)


def laying_story(script: Script, seed: int = 0, rate: float = RATE, camera: str = "sway") -> Story:
    """Return a story in which a person with a camera on her head lays a table and says what she does.

    She begins with what lies under other things, and announces each thing (*first the plate*, *then the cup*). Her
    order differs from table to table by exchanges of neighbours.

    Parameters
    ----------
    script
        How the table is laid.
    seed
        Seed of the things, the order and the movement of the head.
    rate
        Frames a second.
    camera
        Path of the camera: ``still``, ``sway`` or ``walk``.

    Returns
    -------
    Story
        The story. Its frames are computed one by one.

    Raises
    ------
    SimulationError
        If no table can be laid as the script says, or there is no such path.

    Examples
    --------
    >>> from deixis.grammar.layout.parser import parse_script
    >>> story = laying_story(parse_script("plate left of cup"))
    >>> [words.text for words in story.words]
    ['First the plate.', 'Finally the cup.']
    """
    from deixis.perception.simulator.cameras.camera import chair_camera
    from deixis.perception.simulator.films.camera_paths import camera_path
    from deixis.perception.simulator.films.stage import Bring, Rest, Stage
    from deixis.perception.simulator.laying import top_under, truth_scene
    from deixis.workflows.layouts.lay_table import lay_script

    _require_things(script, 1)
    rng = np.random.default_rng(seed)
    table = lay_script(script, seed=seed).table
    order = sorted(range(len(table.things)), key=lambda k: round(float(table.things[k].box[0, 2]), 3))
    for k in np.flatnonzero(rng.random(len(order) - 1) < SWAP_PROBABILITY).tolist():
        lower, upper = (table.things[order[k]], table.things[order[k + 1]])
        if not _supports_another(lower, (upper,)):
            order[k : k + 2] = order[k + 1], order[k]

    stage, words = Stage((), seed), []
    stage.carry_out(Rest(SPEECH_PAUSE))
    for place, k in enumerate(order):
        name = plain_name(table.things[k].name).replace("_", " ")
        opening = "First" if place == 0 else "Finally" if place == len(order) - 1 else "Then"
        words.append(Utterance(f"{opening} the {name}.", stage.at, stage.at + SPEECH_LEAD, "teacher"))
        stage.carry_out(Rest(SPEECH_LEAD))
        stage.carry_out(Bring(table.things[k]))
        stage.carry_out(Rest(SPEECH_PAUSE))
    top, eye = top_under(table.things), chair_camera(table)
    path = camera_path(camera, seed)
    truth = StoryTruth(truth_scene(table), eye, laid=tuple(table.things[k].name for k in order), path=path)
    return Story(stage.film(top, eye, path).frames(rate, seed), tuple(words), (), truth)


def _require_things(script: Script, least: int) -> None:
    """Check that a script has things to lay; raise SimulationError otherwise."""
    from deixis.perception.errors import SimulationError

    if len(script.objects) < least:
        raise SimulationError(
            f"{script.file}: the story needs a script with at least {count(least, 'thing')}, got {len(script.objects)}"
        )


def _supports_another(thing: LaidThing, things: Iterable[LaidThing]) -> bool:
    """Return True if another thing lies on a thing, at least in part."""
    from deixis.perception.simulator.laying import overlap_in_plan, plan_box

    own = plan_box(thing.mesh)
    return any(
        other.box[0, 2] > thing.box[0, 2] + 1e-4 and overlap_in_plan(own, plan_box(other.mesh)) for other in things
    )


def _as_seen(skeleton: Skeleton, camera: Camera) -> Skeleton:
    """Return a skeleton in the frame of the camera."""
    places = camera.to_camera(np.array(list(skeleton.joints.values())))
    joints = {name: tuple(place) for name, place in zip(skeleton.joints, places.tolist(), strict=True)}
    return replace(skeleton, joints=joints)
