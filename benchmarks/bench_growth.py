"""Time learning, checking, recognising, asking and forgetting with few and with many known lessons.

Lessons are generated: seven things of a formal place setting, some under words that the ontology lacks, each table laid
a little differently. One warm process learns them one by one. At 10, 100 and 1,000 it measures further lessons, the
part of learning after the grounding, and the other tasks (medians of ``--runs``, 9). Then it learns 10,000 as a batch
into another memory, prints the time per lesson, and measures again. At the end it forgets all lessons of the first
memory except ten, to check that the disk space is released. With ``--words`` it also fits relation words to all lessons
at 10, 100 and 1,000 (``learn-relation``), and forgets lessons used in the fit. ``--quick`` stops at 20 lessons and a
batch of 20.
"""

from __future__ import annotations

import random
import resource
import statistics
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from records import command_line, figure, recorded

import deixis.workflows.knowledge.learn as learning
from deixis.experiments.place_settings import formal_setting
from deixis.grammar.script import Script
from deixis.memory.folder import size
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.session import Session
from deixis.workflows.layouts.read import read_script

THINGS = 7
UNKNOWN = [first + last for first in ("zor", "mil", "tef", "gau", "pim") for last in ("ble", "cket", "dril", "nop")]
"""Words that the ontology does not contain."""

Times = dict[str, list[float]]


def generated(number: int) -> tuple[Script, Scene]:
    """Return the script and the labelled scene of one table, which depend on its number alone."""
    rng, relations = random.Random(number), default_ontology().relations
    whole = formal_setting(number, 0.01)
    things = rng.sample(whole.objects, THINGS)
    names = [f"{rng.choice(UNKNOWN)}_{n}" if rng.random() < 0.15 else thing.id for n, thing in enumerate(things)]
    objects = [replace(t, id=f"p{n}", label=name) for n, (t, name) in enumerate(zip(things, names, strict=True))]
    scene = replace(whole, objects=tuple(objects))
    seen = scene.relations(relations).names
    facts = []
    for one in range(1, THINGS):
        other = rng.randrange(one)
        exact = relations.members(1 << int(seen[one, other]))[0]
        facts.append(f"{names[one]} {relations.wide(exact).phrase} {names[other]}")
    return read_script(text="\n".join([f"layout table_{number}", *facts])), scene


@contextmanager
def timed(times: Times, what: str) -> Iterator[None]:
    started = time.perf_counter()
    yield
    times[what].append(time.perf_counter() - started)


def measure(session: Session, first: int, runs: int) -> Times:
    """Return the times of further lessons, which are forgotten again, and of the questions between them."""
    times: Times = defaultdict(list)
    answer = learning.answer  # type: ignore[attr-defined]
    for number in range(first, first + runs):
        script, scene = generated(number)
        grounding: Times = defaultdict(list)

        def grounded(*arguments: object, **more: object) -> object:
            with timed(grounding, "ground"):  # noqa: B023
                return answer(*arguments, **more)  # type: ignore[arg-type]

        learning.answer = grounded  # type: ignore[attr-defined, assignment]
        try:
            with timed(times, "learn"):
                learned = session.learn(script, scene)
        finally:
            learning.answer = answer  # type: ignore[attr-defined]
        times["behind the grounding"].append(times["learn"][-1] - grounding["ground"][-1])
        with timed(times, "check"):
            session.check(f"table_{number}", scene)
        with timed(times, "recognise"):
            session.recognise(scene)
        with timed(times, "query"):
            asked = (
                f"SELECT ?role {{ ?role a dx:Role ; dx:inLayout ?l . ?l rdfs:label 'table_{number}' }} ORDER BY ?role"
            )
            assert len(session.query(asked).rows) == THINGS
        with timed(times, "forget"):
            session.forget(learned.lesson.id)
    return times


def measure_words(session: Session, known: int, runs: int) -> Times:
    """Return the times of fitting words to all lessons, and of forgetting lessons of the fit (learned again)."""
    times: Times = defaultdict(list)
    with timed(times, "fit words"):
        session.learn_relations()
    for lesson in session.memory().lessons()[-min(runs, known // 2) :]:
        number = int(lesson.removeprefix("table_").split("-")[0])
        with timed(times, "forget a lesson of the fit"):
            session.forget(lesson)
        session.learn(*generated(number))
    session.forget_relations()
    return times


def times_line(lessons: int, times: Times, base: Times | None) -> str:
    """Return one line: medians in milliseconds, and their ratios to those with the fewest lessons."""
    parts = []
    for what, taken in times.items():
        median = statistics.median(taken)
        if base is not None:
            relative = median / statistics.median(base[what])
            figure(f"{lessons:,} lessons: {what}", relative, "times the time with the fewest")
        ratio = f" ({median / statistics.median(base[what]):.2f})" if base is not None else ""
        parts.append(f"{what} {median * 1e3:.1f} ms{ratio}")
    return f"{lessons:>6,} lessons: " + ", ".join(parts)


def singly(path: Path, numbers: list[int], runs: int, words: bool) -> Times:
    """Learn one by one up to each number of lessons, and measure there; return the times with the fewest."""
    base: Times | None = None
    with Session(path) as session:
        measure(session, 10_000_000, 2)  # everything is compiled and read once
        known = 0
        for number in numbers:
            for new in range(known, number):
                session.learn(*generated(new))
            known = number
            times = measure(session, 1_000_000, runs)
            if words:
                times |= measure_words(session, number, runs)
            print(times_line(number, times, base), flush=True)
            base = base or times
    assert base is not None
    print(f"        on disk: {size(path) / 1e6:.1f} MB", flush=True)
    return base


def as_batch(path: Path, number: int, runs: int, base: Times) -> None:
    """Learn a batch in one call, and measure there."""
    examples = [generated(new) for new in range(number)]
    keep, kept = learning.keep_lessons, []  # type: ignore[attr-defined]

    def timed_keep(*arguments: object) -> object:
        started = time.perf_counter(), time.process_time()
        taught = keep(*arguments)  # type: ignore[arg-type]
        kept.append((time.perf_counter() - started[0], time.process_time() - started[1]))
        return taught

    with Session(path) as session:
        learning.keep_lessons = timed_keep  # type: ignore[attr-defined, assignment]
        started = time.perf_counter()
        try:
            session.learn_all(examples)
        finally:
            learning.keep_lessons = keep  # type: ignore[attr-defined]
        taken = time.perf_counter() - started
        behind, busy = (value / number * 1e3 for value in kept[0])
        most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
        print(
            f"a batch of {number:,}: {taken:.1f} s, {taken / number * 1e3:.1f} ms per lesson, of which after the "
            f"grounding {behind:.1f} ms ({busy:.1f} ms of processor time); {most:.2f} GB of memory at the most",
            flush=True,
        )
        print(times_line(number, measure(session, 1_000_000, runs), base), flush=True)
    print(f"        on disk: {size(path) / 1e6:.1f} MB", flush=True)


def forgetting(path: Path, left: int) -> None:
    """Forget all lessons except ``left``, and print the size on disk."""
    before = size(path)
    with Session(path) as session:
        lessons = session.memory().lessons()[left:]
        started = time.perf_counter()
        for lesson in lessons:
            session.forget(lesson)
    taken = time.perf_counter() - started
    print(f"forgotten {len(lessons):,} in {taken:.1f} s: {before / 1e6:.1f} MB before, {size(path) / 1e6:.1f} MB after")


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--batch", type=int, default=10_000)
    parser.add_argument("--most", type=int, default=1000, help="lessons learned one by one")
    parser.add_argument("--words", action="store_true", help="also fit relation words, and forget lessons of the fit")
    parser.add_argument("--quick", action="store_true")
    with recorded(parser) as options:
        if options.quick:
            options.runs, options.batch, options.most = 3, 20, 20
        with tempfile.TemporaryDirectory() as scratch:
            numbers = [number for number in (10, 100, 1000) if number < options.most]
            base = singly(Path(scratch) / "singly", [*numbers, options.most], options.runs, options.words)
            if options.batch:
                as_batch(Path(scratch) / "batch", options.batch, options.runs, base)
            forgetting(Path(scratch) / "singly", 10)


if __name__ == "__main__":
    main()
