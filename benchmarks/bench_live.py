"""Measure the live robot on simulated stories of one table and two customers, by what is true of them.

    python benchmarks/bench_live.py
    python benchmarks/bench_live.py --seeds 8 --first-seed 100 --layout breakfast.layout

Each story is run as ``deixis robot run --from simulator`` runs it. At its end, each thing that the robot tracks is
compared with the true thing whose middle is nearest, at most 6 cm away. A true thing is tracked if one tracked thing is
nearest to it, and named right if that thing has its name. A tracked thing without a true one, and each further one at a
true thing, is false. The forgotten thing is found if it is said to be missing; all other mistakes that are said are
false, because there are none.
"""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path

import numpy as np
from records import command_line, count, recorded, seconds, share

from deixis.examples_data import example
from deixis.memory.episodes.predicates import AT
from deixis.ontology.things.kinds import plain_name
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.run import LiveRobot, live_robot
from deixis.robot.live.senses import TABLE, VIEW_ENDING
from deixis.robot.live.story import StorySettings, StoryTruth

NEAR = 0.06
"""Distance in metres up to which a tracked thing is a true one."""


def matched(robot: LiveRobot, truth: StoryTruth) -> tuple[dict[str, str], int]:
    """Return the tracked thing of each true one by its name, and the number of other tracked things."""
    (table,) = robot.board.now(Pattern(predicate=TABLE))
    with np.load(Path(str(table.statement.object)).with_suffix("").with_suffix(VIEW_ENDING)) as view:
        onto = truth.camera_at(table.start.lower - robot.began).pose @ np.linalg.inv(view["frame"])
    found: dict[str, str] = {}
    false = 0
    for each in robot.board.now(Pattern(predicate=AT)):
        middle = np.reshape(json.loads(str(each.statement.object)), (2, 3)).mean(axis=0)
        away = np.linalg.norm(truth.things.boxes.mean(axis=1) - (onto[:3, :3] @ middle + onto[:3, 3]), axis=1)
        name = truth.things.objects[int(away.argmin())].label or ""
        if away.min() > NEAR or name in found:
            false += 1
        else:
            found[name] = each.statement.subject
    return found, false


def main() -> None:
    """Run the stories and print the figures."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--seeds", type=int, default=8, help="number of stories (default: 8)")
    parser.add_argument("--first-seed", type=int, default=0, help="seed of the first one")
    parser.add_argument("--layout", default="tea.layout", help="shipped script, or a file")
    parser.add_argument("--processes", action="store_true", help="modules as processes of their own")
    with recorded(parser) as arguments:
        layout = arguments.layout if Path(arguments.layout).exists() else str(example(arguments.layout))
        things = tracked = named = false = forgotten = mistakes = layouts = 0
        spent: list[float] = []
        for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds):
            settings = StorySettings("simulator", layout, seed)
            truth = settings.story().truth
            assert truth is not None and truth.forgotten is not None
            began = time.process_time()
            with (
                tempfile.TemporaryDirectory() as folder,
                live_robot(Path(folder) / "memory", settings, lambda line: None, arguments.processes) as robot,
            ):
                robot.wait()
                found, wrong = matched(robot, truth)
                names = {thing.id: thing.name for thing in robot.things()}
                faults, laid = robot.faults(), robot.layout()
            spent.append(time.process_time() - began)
            right = [name for name, id in found.items() if names[id] == plain_name(name)]
            missing = f"the {plain_name(truth.forgotten).replace('_', ' ')} is missing"
            things, tracked, named = things + len(truth.things.objects), tracked + len(found), named + len(right)
            false, forgotten, layouts = false + wrong, forgotten + (missing in faults), layouts + (laid is not None)
            mistakes += len(faults) - (missing in faults)
            print(
                f"seed {seed}: {len(found)} of {len(truth.things.objects)} tracked, {wrong} false, {len(right)} named "
                f"right; forgotten: {plain_name(truth.forgotten)}; said: {'; '.join(faults) or 'nothing'}",
                flush=True,
            )
        stories = arguments.seeds
        print(f"\n{stories} stories of '{layout.rpartition('/')[2]}'")
        print(
            f"things of the second table: {tracked / things:.3f} tracked, {named / things:.3f} named right, of {things}"
        )
        print(f"other tracked things: {false}; layouts recognised: {layouts / stories:.3f}")
        print(f"forgotten things found: {forgotten / stories:.3f}; mistakes said that were not made: {mistakes}")
        print(f"processor time of a story: {np.median(spent):.1f} s (median)")
        share("tracked", tracked, things)
        share("named right", named, things)
        share("layouts", layouts, stories)
        share("forgotten found", forgotten, stories)
        count("false things", false)
        count("false mistakes", mistakes)
        seconds("story", float(np.median(spent)))


if __name__ == "__main__":
    main()
