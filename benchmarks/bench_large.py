"""Measure large scenes: the calibration of the marginals, and whether limits of time and memory are kept.

Calibration: generated tables of three layouts, with kinds known or words alone, of seeds on which nothing was tuned
(``--seeds FIRST`` begins at another one). A tenth of the facts is wrong; a tenth of the described things is missing and
as many are extra, or none. For each size it prints the share of objects whose likeliest thing is right, the mean
probability of that thing, and the calibration error (ten bins), of all objects and then of those present; the share of
objects whose match is decided, how many of those are right, and Wilson's 95 per cent interval, as if matches of one
table were independent; then the mean and the greatest difference from the marginals of a run many times as long, at 30
objects; and seconds by the clock and of the processor, beside the limit. ``--limit SECONDS`` is the time limit (default
10). With ``--processor`` it counts seconds of the processor, so that other programs do not change the result.

``--only TEXT`` measures the arms whose line of ARMS contains the text, ``--tables N`` at most N tables of each arm,
``--no-limits`` calibration only. ``--values``
prints instead how much more the best map that a search finds is worth than the true map, in nats, and the share of
objects that it matches right: where it is worth much more, the model is wrong and not the search. ``--information``
prints what a search of any length could decide: chains that start from the true map at the posterior's own temperature,
and the share of objects whose thing they have in 0.99 of the maps. ``--facts N`` replaces the facts per object.

Limits: ten objects beside 20,000 labelled things, some of which have a unique label. Then whole scripts and scenes of
1,000 to 20,000 objects. All are read from files, each in a process of its own: seconds by the clock and of the
processor, the peak memory beyond that of the loaded program (on Linux), and the result. On a busy machine compare the
clock's seconds with the processor's: a time limit is one of the clock. ``--quick`` takes a few of both.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from bench_faults import interval
from numpy.typing import NDArray
from records import command_line, figure, recorded, share

from deixis.deadline import CLOCK, Deadline
from deixis.experiments.generated_tables import LAYOUTS, SETTING, generate, lay_boxes
from deixis.ontology.tbox import default_ontology
from deixis.perception.recognition.calibration import expected_calibration_error
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.matching.posterior import ladders
from deixis.reasoning.grounding.matching.posterior.coincidences import discounted
from deixis.reasoning.grounding.matching.posterior.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.posterior.ladders import sampled_marginals
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior, posterior
from deixis.reasoning.grounding.matching.posterior.sampling import begin, guide_by, new_chains, sample
from deixis.reasoning.grounding.matching.problem import MIN_PLACES, UNMATCHED, Problem, to_assignment
from deixis.reasoning.grounding.matching.search.coarse_to_fine import CoarseToFine
from deixis.reasoning.grounding.matching.search.scalable import scalable
from deixis.reasoning.grounding.options import DECIDED, is_decided

HELD_OUT = 100
"""Seed of the first table; the settings of the chains were chosen on tables of smaller seeds."""

ARMS = [  # layout, kinds known, objects, facts per object, share missing, tables
    ("seats", True, 30, 2.5, 0.1, 8),
    ("seats", True, 100, 2.5, 0.1, 8),
    ("seats", True, 300, 2.5, 0.1, 4),
    ("seats", True, 300, 6.0, 0.1, 4),
    ("seats", True, 1000, 2.5, 0.1, 3),
    ("seats", True, 1000, 8.0, 0.1, 3),
    ("seats", False, 100, 6.0, 0.1, 6),
    ("seats", False, 100, 6.0, 0.0, 3),
    ("seats", False, 300, 8.0, 0.1, 3),
    ("seats", False, 1000, 8.0, 0.1, 2),
    ("seats", False, 1000, 8.0, 0.0, 2),
    ("clusters", True, 100, 2.5, 0.1, 6),
    ("clusters", True, 300, 6.0, 0.1, 3),
    ("clusters", False, 100, 6.0, 0.1, 6),
    ("clusters", False, 100, 6.0, 0.0, 3),
    ("clusters", False, 300, 8.0, 0.1, 3),
    ("rows", True, 100, 2.5, 0.1, 6),
    ("rows", True, 300, 6.0, 0.1, 3),
    ("rows", False, 100, 6.0, 0.1, 6),
    ("rows", False, 100, 6.0, 0.0, 3),
    ("rows", False, 300, 8.0, 0.1, 3),
    ("rows", True, 1000, 8.0, 0.1, 2),
]
QUICK_ARMS = [("seats", True, 30, 2.5, 0.1, 2), ("clusters", True, 100, 2.5, 0.1, 1)]
LONGER = 4.0  # factor of proposals for the reference at REFERENCE_OBJECTS
REFERENCE_OBJECTS = 30
NEAR_TRUTH = 1e-4  # share of the probability of the first beliefs that is not at the true map
TRUE_LADDERS, TRUE_COLDNESS, TRUE_SWEEPS = 4, (1.0, 0.9, 0.8), 400  # chains from the true map
SHORT_LIMIT = 60.0  # seconds: enough even on a busy machine
RARE, QUICK_RARE = (0, 2, 6), (6,)
"""Numbers of the ten described objects whose label is unique in the scene."""

RARE_LABELS = ("candle", "teapot", "bowl", "saucer", "jug", "mug")
LIMITS = [(1000, 2.0), (1000, 10.0), (2000, 3.0), (5000, 5.0), (20000, 5.0), (20000, 30.0)]  # things, seconds
QUICK_LIMITS = [(1000, 2.0)]

CHILD = """
import pathlib, sys, time
import deixis
from deixis.kernels import compile_grounding
def peak():  # of this program alone, in megabytes; what resource.getrusage says is handed down
    status = pathlib.Path("/proc/self/status")
    lines = status.read_text().splitlines() if status.exists() else ["VmHWM: 0"]
    return int(next(line.split()[1] for line in lines if line.startswith("VmHWM"))) / 1024
compile_grounding("exact")
before, worked = peak(), time.process_time()
started = time.monotonic()
try:
    found = deixis.ground(sys.argv[1], sys.argv[2], time_limit=float(sys.argv[3]))
    decided = sum(match.decided for match in found.matches.values())
    said = f"{len(found.matches)} matched, {decided} decided, probabilities {found.probabilities}"
except deixis.DeixisError as error:
    said = f"{type(error).__name__}: {error}"
seconds = time.monotonic() - started
print(f"{seconds:.2f} {time.process_time() - worked:.2f} {peak() - before:.0f} {said}")
"""


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--limit", type=float, default=10.0, help="time limit of a posterior, in seconds")
    parser.add_argument("--seeds", type=int, default=HELD_OUT, help="seed of the first table")
    parser.add_argument("--only", default="", help="only the arms whose line of ARMS contains this text")
    parser.add_argument("--tables", type=int, default=1000, help="maximum number of tables of an arm")
    parser.add_argument("--no-limits", action="store_true", help="calibration only")
    parser.add_argument("--values", action="store_true", help="only the values of the best and of the true map")
    parser.add_argument("--information", action="store_true", help="only what chains from the true map decide")
    parser.add_argument("--facts", type=float, help="facts per object, instead of those of each arm")
    parser.add_argument("--processor", action="store_true", help="the limit counts seconds of the processor")
    parser.add_argument("--quick", action="store_true", help="a few cases of each")
    with recorded(parser) as options:
        quick = options.quick
        limit = options.limit
        if options.processor:
            vars(CLOCK)["now"] = time.process_time  # the clock of all deadlines of this process
        posterior(case(12, 2.5, 0)[0], Deadline.after(2.0))  # compile
        ladders.warm()
        first = options.seeds
        chosen = [arm for arm in (QUICK_ARMS if quick else ARMS) if options.only in " ".join(map(str, arm))]
        if options.facts is not None:
            chosen = [(*arm[:3], options.facts, *arm[4:]) for arm in chosen]
        if options.values or options.information:
            (_print_values if options.values else _print_information)(chosen, first)
            return
        columns = (
            "right  said   calibration  right  said   calibration  decided  of which right               "
            "off, mean and most  clock"
        )
        print(f"layout    kinds  objects  facts  missing  {columns}   processor")
        for arm in chosen:
            _calibration(*arm[:-1], min(arm[-1], options.tables), limit, first)
        if options.no_limits:
            return
        print("\nobjects  unique labels         things  limit   clock   processor  memory  result")
        for rare in QUICK_RARE if quick else RARE:
            _short(rare, 500 if quick else 20_000, SHORT_LIMIT)
        print("\nthings  limit   clock   processor  memory  result")
        for things, seconds in QUICK_LIMITS if quick else LIMITS:
            _limits(things, seconds)
        print(f"\npeak memory of this process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20:.2f} GB")


def _print_values(arms: list[tuple[str, bool, int, float, float, int]], first: int) -> None:
    """Print by how much the best map that a search finds exceeds the true map, for one table of each arm."""
    print("layout    kinds  objects  facts  missing  best map minus true map  right")
    for layout, kinds, objects, facts, missing, _ in arms:
        problem, truth = case(objects, facts, first, layout, kinds, missing)
        right = to_assignment(truth, problem.unary.shape[1])
        best = scalable(problem, Deadline.never()).assignment
        print(
            f"{layout:8}  {'yes' if kinds else 'no':5}  {objects:7}  {facts:5}  {missing:7}  "
            f"{problem.value(best) - problem.value(right):18.0f} nats  {(best == right).mean():5.3f}",
            flush=True,
        )


def _print_information(arms: list[tuple[str, bool, int, float, float, int]], first: int) -> None:
    """Print the marginals of chains that start from the true map, for one table of each arm."""
    print("layout    kinds  objects  facts  missing  right  said   above 0.99  of which right")
    for layout, kinds, objects, facts, missing, _ in arms:
        problem, truth = case(objects, facts, first, layout, kinds, missing)
        known, width = problem.compiled, problem.unary.shape[1] + 1
        near_truth = np.full((objects, width), NEAR_TRUTH / width, np.float32)
        near_truth[np.arange(objects), truth] += 1.0 - NEAR_TRUTH
        places = None if problem.places is None or not missing else problem.places(most=MIN_PLACES)
        beliefs, placed = CoarseToFine(known, places).refined(near_truth)
        guide, start = guide_by(beliefs, placed.allowed), guide_by(near_truth, placed.allowed, 1.0)
        counts, burnt = np.zeros((2, objects, width), np.float32)
        for ladder in range(TRUE_LADDERS):
            chains, values = new_chains(placed, np.array(TRUE_COLDNESS)), np.zeros(len(TRUE_COLDNESS))
            begin(chains, placed, start, ladder)
            for number, sums in enumerate((burnt, counts)):
                sample(chains, sums, values, placed, guide, TRUE_SWEEPS, 2 * ladder + number)
        likeliest, probability = counts.argmax(axis=1), counts.max(axis=1) / counts[0].sum()
        decided, right = (probability >= DECIDED) & (likeliest < width - 1), likeliest == truth
        print(
            f"{layout:8}  {'yes' if kinds else 'no':5}  {objects:7}  {facts:5}  {missing:7}  {right.mean():.3f}  "
            f"{probability.mean():.3f}  {decided.mean():10.3f}  {(decided & right).sum()} of {decided.sum()}",
            flush=True,
        )


def case(
    objects: int, facts: float, seed: int, layout: str = "seats", kinds: bool = True, missing: float = 0.1
) -> tuple[Problem, NDArray[np.int64]]:
    """Return a matching problem and the truth: each object's thing, the last column for missing objects."""
    known, gone = default_ontology(), int(missing * objects)
    table = generate(objects, facts, missing=gone, extra=gone, seed=seed, layout=LAYOUTS[layout])
    labels = [None] * len(table.boxes)
    evidence = evidence_from(table.description(kinds=kinds), table.scene(), labels, known.kinds, known.sizes)
    truth = table.truth[[int(name[1:]) for name in evidence.description.nodes]]
    return evidence.problem, np.where(truth == UNMATCHED, len(table.boxes), truth)


def _calibration(
    layout: str, kinds: bool, objects: int, facts: float, missing: float, tables: int, limit: float, first: int
) -> None:
    probabilities, right, decided, there, clock, worked = [], [], [], [], [], []
    off: list[NDArray[np.float64]] = []
    for seed in range(first, first + tables):
        problem, truth = case(objects, facts, seed, layout, kinds, missing)
        before, started = time.process_time(), time.monotonic()
        found = discounted(problem, posterior(problem, Deadline.after(limit)))
        clock.append(time.monotonic() - started)
        worked.append(time.process_time() - before)
        likeliest, probability = found.marginals.argmax(axis=1), found.marginals.max(axis=1)
        known = [bool(is_decided(p, float(e))) for p, e in zip(probability, found.errors, strict=True)]
        probabilities.append(probability)
        right.append(likeliest == truth)
        there.append(truth < problem.unary.shape[1])
        decided.append(np.array(known) & (likeliest < problem.unary.shape[1]))
        if objects == REFERENCE_OBJECTS and layout == "seats":
            reference = discounted(problem, Posterior(_reference(problem), False, 0.0))
            off.append(np.abs(found.marginals - reference.marginals).max(axis=1))
    p, r, d, t = (np.concatenate(known) for known in (probabilities, right, decided, there))
    far = np.concatenate(off) if off else None
    what = (
        f"{layout}, {'kinds' if kinds else 'words alone'}, {objects} objects, {facts:g} facts each, {missing:g} missing"
    )
    figure(f"{what}: calibration error", expected_calibration_error(p, r), "share")
    share(f"{what}: decided", int(d.sum()), len(d))
    share(f"{what}: decided matches that are right", int((d & r).sum()), int(d.sum()))
    far_off = "" if far is None else f"{far.mean():.3f}, {far.max():.3f}"
    print(
        f"{layout:8}  {'yes' if kinds else 'no':5}  {objects:7}  {facts:5}  {missing:7}  "
        f"{r.mean():.3f}  {p.mean():.3f}  {expected_calibration_error(p, r):11.3f}  "
        f"{r[t].mean():.3f}  {p[t].mean():.3f}  {expected_calibration_error(p[t], r[t]):11.3f}  {d.mean():7.3f}  "
        f"{interval(int((d & r).sum()), int(d.sum())):>27}  {far_off:>18}  "
        f"{max(clock):5.1f}   {max(worked):5.1f}",
        flush=True,
    )


def _reference(problem: Problem) -> NDArray[np.float64]:
    """Return the marginals of a run many times as long, with other random numbers."""
    before = ladders.PROPOSALS, ladders.TOLERANCE
    ladders.PROPOSALS, ladders.TOLERANCE = LONGER * before[0], 0.0
    try:
        return sampled_marginals(problem.compiled, exchangeable(problem), Deadline.never(), seed=1)[0]
    finally:
        ladders.PROPOSALS, ladders.TOLERANCE = before


def _short(rare: int, things: int, seconds: float) -> None:
    """Ground ten neighbours among many labelled things, described by thirty facts."""
    with tempfile.TemporaryDirectory() as folder:
        script, scene = Path(folder) / "short.layout", Path(folder) / "short.scene.json"
        _write_short(rare, things, script, scene)
        clock, worked, memory, result = _child(script, scene, seconds)
    known = f"{10:7}  {rare:23}  {things:6}"
    print(f"{known}  {seconds:5g} s  {clock:>6}  {worked:>9}  {memory:>4} MB  {result[:150]}", flush=True)


def _child(script: Path, scene: Path, seconds: float) -> list[str]:
    """Ground in a process of its own; return seconds of the clock and the processor, megabytes, and the result."""
    command = [sys.executable, "-c", CHILD, str(script), str(scene), str(seconds)]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return out.strip().split(" ", 3)


def _write_short(rare: int, things: int, script: Path, scene: Path) -> None:
    rng, relations, kinds = np.random.default_rng(0), default_ontology().relations, list(SETTING)
    boxes, pieces = lay_boxes(things, rng)
    middles = boxes.mean(axis=1)
    chosen = np.argsort(np.linalg.norm(middles - middles[rng.integers(things)], axis=1))[:10]
    labels = [kinds[piece] for piece in pieces]
    for thing, label in zip(chosen[:rare].tolist(), RARE_LABELS, strict=False):
        labels[thing] = label
    names = [f"{labels[thing].replace(' ', '_')}_{number}" for number, thing in enumerate(chosen.tolist())]
    lines: dict[tuple[int, int], str] = {}
    while len(lines) < 30:
        a, b = rng.choice(10, 2, replace=False).tolist()
        if (b, a) not in lines:
            exact = int(box_relations(boxes[[chosen[a], chosen[b]]], relations).names[0, 1])
            lines[a, b] = f"{names[a]} {relations.wide(list(relations.values())[exact]).phrase} {names[b]}\n"
    script.write_text("".join(lines.values()), encoding="utf-8")
    objects = [
        {"id": f"o{p:05}", "min": low.tolist(), "max": high.tolist(), "label": labels[p]}
        for p, (low, high) in enumerate(boxes)
    ]
    scene.write_text(json.dumps({"frame": "table", "viewpoint": "chair", "unit": "m", "objects": objects}))


def _limits(things: int, seconds: float) -> None:
    with tempfile.TemporaryDirectory() as folder:
        script, scene = Path(folder) / "large.layout", Path(folder) / "large.scene.json"
        _write(things, script, scene)
        clock, worked, memory, result = _child(script, scene, seconds)
    print(f"{things:6}  {seconds:5g} s  {clock:>6}  {worked:>9}  {memory:>4} MB  {result[:150]}", flush=True)


def _write(things: int, script: Path, scene: Path) -> None:
    """Write a table and 2.5 facts per object about it, half of them between neighbours, without comparing all pairs."""
    from scipy.spatial import cKDTree

    rng, relations = np.random.default_rng(0), default_ontology().relations
    boxes, _ = lay_boxes(things, rng)
    near = cKDTree(boxes.mean(axis=1)).query(boxes.mean(axis=1), 7)[1][:, 1:]
    lines: dict[tuple[int, int], str] = {}
    while len(lines) < 2.5 * things:
        subject = int(rng.integers(things))
        other = int(rng.choice(near[subject])) if rng.random() < 0.5 else int(rng.integers(things))
        if subject != other and (other, subject) not in lines:
            name = int(box_relations(boxes[[subject, other]], relations).names[0, 1])
            word = relations.wide(list(relations.values())[name]).phrase
            lines[subject, other] = f"d{subject:05} {word} d{other:05}\n"
    script.write_text("".join(lines.values()), encoding="utf-8")
    objects = [
        {"id": f"o{p:05}", "min": boxes[p, 0].tolist(), "max": boxes[p, 1].tolist()} for p in rng.permutation(things)
    ]
    known = {"frame": "table", "viewpoint": "chair", "unit": "m", "objects": objects}
    scene.write_text(json.dumps(known), encoding="utf-8")


if __name__ == "__main__":
    main()
