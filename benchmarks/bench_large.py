"""Large scenes: how well the marginals are calibrated, and whether limits of time and memory are kept.

Calibration: generated tables (kinds known, 10 % of the facts off, one thing in ten missing and one in ten extra). For
each size it prints the share of objects that are what is likeliest, the mean probability of that, the calibration error
(ten bins), the share of objects whose match is decided, and how many of those are right; then what the marginals of a
run many times as long differ by, at 30 objects, on average and at most; and seconds by the clock and of the processor,
beside the limit. ``--limit SECONDS`` is the time limit (default 10).

Limits: whole scripts and scenes of 1,000 to 20,000 objects from files, each in a process of its own: seconds by the
clock and of the processor, the peak of the memory beyond that of the loaded program (on Linux), and what came of it. On
a busy machine compare the clock's seconds with the processor's: a time limit is one of the clock. ``--quick`` takes a
few of both.
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
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate, lay_boxes
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.matching import ladders
from deixis.reasoning.grounding.matching.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.ladders import sampled_marginals
from deixis.reasoning.grounding.matching.posterior import posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.options import is_decided

SIZES = [(30, 2.5, 6), (100, 2.5, 4), (300, 2.5, 2), (300, 6.0, 2), (1000, 2.5, 1), (1000, 8.0, 1)]
QUICK_SIZES = [(30, 2.5, 2), (100, 2.5, 1)]  # objects, facts an object, tables
LONGER = 4.0  # times as many proposals for the reference at REFERENCE_OBJECTS
REFERENCE_OBJECTS = 30
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
    said = f"{len(found.matches)} matched, probabilities {found.probabilities}"
except deixis.DeixisError as error:
    said = f"{type(error).__name__}: {error}"
seconds = time.monotonic() - started
print(f"{seconds:.2f} {time.process_time() - worked:.2f} {peak() - before:.0f} {said}")
"""


def main() -> None:
    quick = "--quick" in sys.argv
    limit = float(sys.argv[sys.argv.index("--limit") + 1]) if "--limit" in sys.argv else 10.0
    posterior(_case(12, 2.5, 0)[0], Deadline.after(2.0))  # compiled
    print("objects  facts  right  said   calibration  decided  of which right  off, mean and most  clock   processor")
    for objects, facts, tables in QUICK_SIZES if quick else SIZES:
        _calibration(objects, facts, tables, limit)
    print("\nthings  limit   clock   processor  memory  what came of it")
    for things, seconds in QUICK_LIMITS if quick else LIMITS:
        _limits(things, seconds)
    print(f"\npeak memory of this process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20:.2f} GB")


def _case(objects: int, facts: float, seed: int) -> tuple[Problem, NDArray[np.int64]]:
    """A matching problem and the truth: each object's thing, the last column for what is not there."""
    table, known = generate(objects, facts, missing=objects // 10, extra=objects // 10, seed=seed), default_ontology()
    labels = [None] * len(table.boxes)
    evidence = evidence_from(table.description(kinds=True), table.scene(), labels, known.kinds, known.sizes)
    truth = table.truth[[int(name[1:]) for name in evidence.description.nodes]]
    return evidence.problem, np.where(truth == UNMATCHED, len(table.boxes), truth)


def _calibration(objects: int, facts: float, tables: int, limit: float) -> None:
    said, right, decided, clock, worked = [], [], [], [], []
    off: list[NDArray[np.float64]] = []
    for seed in range(tables):
        problem, truth = _case(objects, facts, seed)
        before, started = time.process_time(), time.monotonic()
        found = posterior(problem, Deadline.after(limit))
        clock.append(time.monotonic() - started)
        worked.append(time.process_time() - before)
        likeliest, probability = found.marginals.argmax(axis=1), found.marginals.max(axis=1)
        known = [bool(is_decided(p, float(e))) for p, e in zip(probability, found.errors, strict=True)]
        said.append(probability)
        right.append(likeliest == truth)
        decided.append(np.array(known) & (likeliest < problem.unary.shape[1]))
        if objects == REFERENCE_OBJECTS:
            off.append(np.abs(found.marginals - _reference(problem)).max(axis=1))
    p, r, d = np.concatenate(said), np.concatenate(right), np.concatenate(decided)
    far = np.concatenate(off) if off else None
    print(
        f"{objects:7}  {facts:5}  {r.mean():.3f}  {p.mean():.3f}  {_calibration_error(p, r):11.3f}  {d.mean():7.3f}  "
        f"{f'{(d & r).sum()} of {d.sum()}':>14}  {'' if far is None else f'{far.mean():.3f}, {far.max():.3f}':>18}  "
        f"{max(clock):5.1f}   {max(worked):5.1f}",
        flush=True,
    )


def _reference(problem: Problem) -> NDArray[np.float64]:
    """Marginals by a run many times as long, with other random numbers."""
    before = ladders.PROPOSALS, ladders.TOLERANCE
    ladders.PROPOSALS, ladders.TOLERANCE = LONGER * before[0], 0.0
    try:
        return sampled_marginals(problem.compiled, exchangeable(problem), Deadline.never(), seed=1)[0]
    finally:
        ladders.PROPOSALS, ladders.TOLERANCE = before


def _calibration_error(probability: NDArray[np.float64], right: NDArray[np.bool_]) -> float:
    """The mean difference of what is said and what is right, over ten bins, by how many fall in each."""
    bins = np.clip((probability * 10).astype(int), 0, 9)
    return sum(
        float((bins == b).mean() * abs(probability[bins == b].mean() - right[bins == b].mean()))
        for b in np.unique(bins)
    )


def _limits(things: int, seconds: float) -> None:
    with tempfile.TemporaryDirectory() as folder:
        script, scene = Path(folder) / "large.layout", Path(folder) / "large.scene.json"
        _write(things, script, scene)
        command = [sys.executable, "-c", CHILD, str(script), str(scene), str(seconds)]
        out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    clock, worked, memory, said = out.strip().split(" ", 3)
    print(f"{things:6}  {seconds:5g} s  {clock:>6}  {worked:>9}  {memory:>4} MB  {said[:150]}", flush=True)


def _write(things: int, script: Path, scene: Path) -> None:
    """Write a table and 2.5 facts an object about it, half of them between neighbours, without comparing all pairs."""
    from scipy.spatial import cKDTree

    rng, relations = np.random.default_rng(0), default_ontology().relations
    boxes, _ = lay_boxes(things, rng)
    near = cKDTree(boxes.mean(axis=1)).query(boxes.mean(axis=1), 7)[1][:, 1:]
    said: dict[tuple[int, int], str] = {}
    while len(said) < 2.5 * things:
        subject = int(rng.integers(things))
        other = int(rng.choice(near[subject])) if rng.random() < 0.5 else int(rng.integers(things))
        if subject != other and (other, subject) not in said:
            name = int(box_relations(boxes[[subject, other]], relations).names[0, 1])
            word = relations.wide(list(relations.values())[name]).phrase
            said[subject, other] = f"d{subject:05} {word} d{other:05}\n"
    script.write_text("".join(said.values()), encoding="utf-8")
    objects = [
        {"id": f"o{p:05}", "min": boxes[p, 0].tolist(), "max": boxes[p, 1].tolist()} for p in rng.permutation(things)
    ]
    known = {"frame": "table", "viewpoint": "chair", "unit": "m", "objects": objects}
    scene.write_text(json.dumps(known), encoding="utf-8")


if __name__ == "__main__":
    main()
