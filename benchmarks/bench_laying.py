"""Measure the prediction of what is laid next, and where, on simulated persons who lay tables in their own ways.

    python benchmarks/bench_laying.py
    python benchmarks/bench_laying.py --examples 2 --slips 0.2

Each person has a hidden layout of 6 to 10 things around a plate, a hidden partial order (groups of things, one group
after the other), and habits: pairs of which the second one mostly follows the first directly. Each laying is a random
order that fits, with slips: neighbours swapped, and optional things left out. The whole setting lies elsewhere on the
table each time (5 cm), and each thing off its place (1 cm). From the examples, each predictor says before every step of
further layings what comes next, and where. With ``--told`` the person also says her groups ("first the plate, then …").

The peers of the order are the thing that was most often laid at that point of a laying, and a Markov chain of first
order; both know what is there already, and how many there are of each kind. The person's own groups and habits, known
exactly, guess one of the things that may come. The peers of the place are the mean place of the kind on the table, and
its offset from the thing that was laid last.

``--films N`` measures the whole way instead: N films of a person with a camera on her head who lays a table and says
what she does (``deixis robot run --from laying``). It prints how many things the robot names right at the end, how many
pairs of things have their true order in its memory, and, for each film, the next things and places that are predicted
from the other films.
"""

from __future__ import annotations

import itertools
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from bench_live import matched
from numpy.typing import NDArray
from records import command_line, figure, recorded, share

from deixis.examples_data import example
from deixis.ontology.things.kinds import plain_name
from deixis.reasoning.activities.activity import Activity, LaidThing, Laying, Step
from deixis.reasoning.activities.prediction import LayingModel
from deixis.robot.live.run import live_robot
from deixis.robot.live.story import StorySettings
from deixis.workflows.reasoning.activities import sequences_of_experiences

KINDS = ("plate", "fork", "knife", "spoon", "cup", "saucer", "napkin", "glass", "bowl", "candle", "salt", "bread")
CLOSE = 0.03
"""Distance in metres within which a predicted place is right."""


@dataclass(frozen=True)
class Person:
    """Way of one person: things (kind, place), their groups in order, habits, and what is optional."""

    things: list[tuple[str, NDArray[np.float64]]]
    groups: list[list[int]]
    habits: dict[int, int]
    optional: set[int]


def some_person(random: np.random.Generator) -> Person:
    """Return a person with a random layout, order and habits."""
    kinds = ["plate", *random.permutation(KINDS[1:])[: random.integers(5, 9)].tolist()]
    if random.random() < 0.5:
        kinds.append(str(random.choice(["fork", "glass"])))
    places: list[NDArray[np.float64]] = [np.zeros(2)]
    while len(places) < len(kinds):
        place = random.uniform((-0.4, -0.15), (0.4, 0.35))
        if min(np.linalg.norm(place - other) for other in places) > 0.08:
            places.append(place)
    order = random.permutation(len(kinds)).tolist()
    cuts = sorted(random.choice(np.arange(1, len(kinds)), size=random.integers(1, 4), replace=False).tolist())
    groups = [order[a:b] for a, b in zip([0, *cuts], [*cuts, len(order)], strict=True)]
    habits = {}
    for group in groups:
        if len(group) > 2:
            first, second = random.permutation(group)[:2].tolist()
            habits[first] = second
    optional = set(random.choice(len(kinds), size=random.integers(0, 3), replace=False).tolist())
    return Person(list(zip(kinds, places, strict=True)), groups, habits, optional)


def laying(person: Person, slips: float, random: np.random.Generator) -> tuple[Laying, list[int]]:
    """Return one laying of a person, and the numbers of its things."""
    order: list[int] = []
    for group in person.groups:
        left = [thing for thing in group if thing not in person.optional or random.random() < 0.6]
        while left:
            habit = person.habits.get(order[-1]) if order else None
            thing = habit if habit in left and random.random() < 0.8 else int(random.choice(left))
            left.remove(thing)
            order.append(thing)
    for at in range(len(order) - 1):
        if random.random() < slips:
            order[at], order[at + 1] = order[at + 1], order[at]
    shift = random.normal(0, 0.05, 2)
    found = []
    for thing in order:
        kind, place = person.things[thing]
        x, y = (place + shift + random.normal(0, 0.01, 2)).tolist()
        found.append(LaidThing(kind, (x, y)))
    return tuple(found), order


def known_to(person: Person, laid: Sequence[int], random: np.random.Generator) -> int:
    """Return a guess of the next thing from the person's own groups and habits."""
    left = [[thing for thing in group if thing not in laid] for group in person.groups]
    needed = [number for number, group in enumerate(left) if any(thing not in person.optional for thing in group)]
    last = needed[0] if needed else len(left) - 1
    open_now = next(group for group in left[: last + 1] if group)
    habit = person.habits.get(laid[-1]) if laid else None
    return habit if habit in open_now else int(random.choice(open_now))


def told_by(person: Person) -> Activity:
    """Return the order that the person says: her groups, one after the other."""
    counts: Counter[str] = Counter()
    groups = []
    for group in person.groups:
        steps = []
        for thing in group:
            kind = person.things[thing][0]
            counts[kind] += 1
            steps.append(Step(kind, number=counts[kind]))
        groups.append(steps)
    return Activity.in_order("told", groups)


@dataclass
class Counts:
    """Next things, by their position in a laying and by the thing before, as the peers count them."""

    examples: Sequence[Laying]
    at: dict[int, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    after: dict[str | None, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    most: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        for laying in self.examples:
            for number, thing in enumerate(laying):
                self.at[number][thing.kind] += 1
                self.after[laying[number - 1].kind if number else None][thing.kind] += 1
            for kind, count in Counter(thing.kind for thing in laying).items():
                self.most[kind] = max(self.most[kind], count)

    def guess(self, counts: Counter[str], laid: Laying) -> dict[str, float]:
        """Return the probabilities of the kinds of which not all are there, smoothed by one half."""
        there = Counter(thing.kind for thing in laid)
        left = {kind: counts[kind] + 0.5 for kind in self.most if there[kind] < self.most[kind]}
        total = sum(left.values())
        return {kind: count / total for kind, count in left.items()}


def places_of_peers(examples: Sequence[Laying], laid: Laying, kind: str) -> dict[str, NDArray[np.float64] | None]:
    """Return the mean place of a kind, and the one by its mean offset from the thing that was laid last."""
    own = [np.array(thing.place) for example in examples for thing in example if thing.kind == kind]
    last = laid[-1] if laid else None
    offsets = [
        np.array(thing.place) - np.array(other.place)
        for example in examples
        for thing in example
        for other in example
        if last is not None and thing.kind == kind and other.kind == last.kind and thing is not other
    ]
    mean = np.mean(own, axis=0) if own else None
    offset = None if last is None or not offsets else np.array(last.place) + np.mean(offsets, axis=0)
    return {"mean place on the table": mean, "offset from the last thing": mean if offset is None else offset}


@dataclass(frozen=True)
class Watched:
    """A laying as the robot watched it: its things in order, the true order, and the things that it names right."""

    laying: Laying
    order: tuple[str, ...]
    right: int

    @property
    def pairs(self) -> tuple[int, int]:
        """Number of pairs of things whose order is the true one, and of all true pairs."""
        place = {thing.kind: number for number, thing in enumerate(self.laying)}
        wanted = list(itertools.combinations(self.order, 2))
        return sum(a in place and b in place and place[a] < place[b] for a, b in wanted), len(wanted)


def watched(layout: str, seed: int, camera: str) -> Watched:
    """Return a film as the live robot watches it with a new memory."""
    settings = StorySettings("laying", str(example(layout)), seed, camera=camera)
    truth = settings.story().truth
    assert truth is not None
    with (
        tempfile.TemporaryDirectory() as folder,
        live_robot(Path(folder) / "memory", settings, lambda line: None) as robot,
    ):
        robot.record("table")
        robot.wait()
        robot.finish_recording("table")
        found, _ = matched(robot, truth)
        names = {thing.id: thing.name for thing in robot.things()}
        (sequence,) = sequences_of_experiences(robot.board)
    right = sum(names.get(id) == plain_name(name) for name, id in found.items())
    return Watched(sequence.laying, tuple(plain_name(name) for name in truth.laid), right)


def print_films(films: Sequence[Watched]) -> None:
    """Print what was named and ordered right, and what is predicted of each film from the others."""
    things = sum(len(film.order) for film in films)
    named = sum(film.right for film in films)
    ordered, pairs = (sum(numbers) for numbers in zip(*(film.pairs for film in films), strict=True))
    print(f"{len(films)} films: {named} of {things} things named right, {ordered} of {pairs} pairs in the true order")
    share("things named right in films", named, things)
    share("pairs of things in the true order in films", ordered, pairs)
    right, frequent, asked = 0, 0, 0
    close, placed = 0, 0
    for number, film in enumerate(films):
        others = [other.laying for place, other in enumerate(films) if place != number]
        if not others:
            continue
        model, counts = LayingModel(others), Counts(others)
        known = {thing.kind for thing in film.laying}
        true = [kind for kind in film.order if kind in known]
        for at, kind in enumerate(true):
            laid = tuple(thing for thing in film.laying if thing.kind in true[:at])
            things_next = model.predict(laid).things
            guess = counts.guess(counts.at[at], laid)
            asked += 1
            right += bool(things_next) and things_next[0].kind == kind
            frequent += bool(guess) and max(guess, key=lambda each: guess[each]) == kind
            place = model.place(kind, laid)
            seen = next(thing.place for thing in film.laying if thing.kind == kind)
            if place is not None and seen is not None:
                placed += 1
                close += bool(np.linalg.norm(np.array(place.place) - np.array(seen)) < CLOSE)
    if asked:
        print(f"next thing: {right} of {asked} right; most frequent next: {frequent} of {asked}")
        print(f"place of the next thing: {close} of {placed} within 3 cm")
        share("next thing in films", right, asked)
        share("next thing in films by the most frequent next", frequent, asked)
        share("place within 3 cm in films", close, placed)


def main() -> None:
    """Print the shares of right predictions, their log loss, and the errors of places, beside the peers."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--persons", type=int, default=60, help="simulated persons (60)")
    parser.add_argument("--examples", type=int, default=4, help="layings from which is learned (4)")
    parser.add_argument("--slips", type=float, default=0.05, help="probability that two neighbours are swapped (0.05)")
    parser.add_argument("--told", action="store_true", help="the person also says her order")
    parser.add_argument("--seed", type=int, default=1000)
    parser.add_argument("--films", type=int, default=0, help="number of films of a person who lays a table")
    parser.add_argument("--layout", default="tea.layout", help="shipped script of the films")
    parser.add_argument("--camera", default="sway", help="movement of the camera of the films: still, sway, walk")
    with recorded(parser) as arguments:
        if arguments.films:
            seeds = range(arguments.seed, arguments.seed + arguments.films)
            print_films([watched(arguments.layout, seed, arguments.camera) for seed in seeds])
            return
        right: Counter[str] = Counter()
        loss: defaultdict[str, list[float]] = defaultdict(list)
        errors: defaultdict[str, list[float]] = defaultdict(list)
        asked, spent = 0, 0.0
        for number in range(arguments.persons):
            random = np.random.default_rng([arguments.seed, number])
            person = some_person(random)
            examples = [laying(person, arguments.slips, random)[0] for _ in range(arguments.examples)]
            model = LayingModel(examples, told_by(person) if arguments.told else None)
            counts, limits = Counts(examples), np.random.default_rng(number)
            for _ in range(5):
                whole, numbers = laying(person, arguments.slips, random)
                for at, thing in enumerate(whole):
                    laid = whole[:at]
                    started = time.process_time()
                    found = model.predict(laid)
                    spent += time.process_time() - started
                    asked += 1
                    last = laid[-1].kind if laid else None
                    guesses = {
                        "order relations": {each.kind: each.probability for each in found.things},
                        "most frequent next": counts.guess(counts.at[at], laid),
                        "Markov chain": counts.guess(counts.after[last], laid),
                    }
                    for name, guess in guesses.items():
                        right[name] += bool(guess) and max(guess, key=lambda kind: guess[kind]) == thing.kind
                        loss[name].append(-float(np.log(max(guess.get(thing.kind, 0.0), 1e-3))))
                    own = known_to(person, numbers[:at], limits)
                    right["the person's own way, without slips"] += person.things[own][0] == thing.kind
                    place = model.place(thing.kind, laid)
                    places = {"learned offsets": None if place is None else np.array(place.place)}
                    for name, guessed in (places | places_of_peers(examples, laid, thing.kind)).items():
                        away = np.inf if guessed is None else float(np.linalg.norm(guessed - np.array(thing.place)))
                        errors[name].append(away)
        for name, count in right.items():
            print(f"next thing by {name}: {count} of {asked} = {count / asked:.3f}")
            share(f"next thing by {name}", count, asked)
        for name, losses in loss.items():
            print(f"log loss of {name}: {np.mean(losses):.3f} nats")
            figure(f"log loss of {name}", float(np.mean(losses)), "nats")
        for name, distances in errors.items():
            close = sum(error < CLOSE for error in distances)
            median = float(np.median(distances))
            print(
                f"place by {name}: {close} of {asked} = {close / asked:.3f} within 3 cm, median {1000 * median:.0f} mm"
            )
            share(f"place within 3 cm by {name}", close, asked)
            figure(f"median error of the place by {name}", median, "m")
        print(f"{1000 * spent / asked:.1f} ms of processor time a prediction")


if __name__ == "__main__":
    main()
