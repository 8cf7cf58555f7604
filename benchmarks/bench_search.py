"""Time the verdict on hard constraint networks, beside GQR.

Random networks are of the model A(n, d, l) of Nebel 1997: each pair is constrained with the probability that gives a
mean degree d, and each atom is in a label with the probability that gives l of them on average. ``DEIXIS_DATA`` leads
to GQR's own instances of 320 things. GQR takes part, as a process that reads files, if ``gqr`` is on the PATH.
Otherwise the stated figures are those measured once on another machine with GQR built from source, for eight other
networks of 60 things of the same model, and for its own instances, of which it solved four.

OPRA (Moratz 2006) is an example of a user's own calculus, whose relations take two words: no tractable subclass is
known, and a closed network of atoms, reported here as *undecided*, may be inconsistent.

Every consistent network is proved: a scenario, one atom for each pair, that closure does not change and that has only
stated atoms. Start-up (imports, compiled loops and tables) is timed separately, in a process of its own.
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
from common import data_folder
from records import command_line, count, recorded, seconds

from deixis.deadline import Deadline
from deixis.grammar.formats.calculi import read_calculus
from deixis.grammar.formats.networks import read_networks, write_networks
from deixis.reasoning.qualitative.calculi.calculus import Calculus
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.calculi.tractable import RCC8_C8, RCC8_HORN, RCC8_Q8
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Solution, Verdict, solve

TIME_LIMIT = 60.0  # seconds for a network
START = """
import time
started = time.perf_counter()
from deixis.kernels import compile_solving
compile_solving(wide=False)
print(time.perf_counter() - started)
"""


def random_network(chosen: Calculus, things: int, degree: float, atoms: float, rng: np.random.Generator) -> Network:
    size, stated = len(chosen.atoms), []
    for i in range(things):
        for j in np.flatnonzero(rng.random(things - i - 1) < degree / (things - 1)) + i + 1:
            codes: list[int] = []
            while not codes:
                codes = np.flatnonzero(rng.random(size) < atoms / size).tolist()
            stated.append(Constraint(i, int(j), sum(1 << code for code in codes)))
    return Network(chosen, things, tuple(stated))


def hard_regions(things: int, degree: float, rng: np.random.Generator) -> Network:
    """Return a network of RCC-8 whose labels are in no maximal tractable subclass (Renz and Nebel 2001)."""
    classes = (RCC8_HORN, RCC8_C8, RCC8_Q8)
    hard = [label for label in range(1, 256) if not any(label in each.relations for each in classes)]
    upper = np.argwhere(np.triu(rng.random((things, things)) < degree / (things - 1), 1)).tolist()
    return Network(calculus("rcc8"), things, tuple(Constraint(i, j, int(rng.choice(hard))) for i, j in upper))


def uncached(network: Network) -> Network:
    """Return the network without its cached closure, so that each run starts from the constraints."""
    return Network(network.calculus, network.size, network.constraints)


def proved(network: Network) -> bool:
    found = solve(uncached(network), Deadline.after(TIME_LIMIT), scenario=True).scenario
    if found is None:
        return False
    stated = all(found.stated(c.first, c.second) & c.relation for c in network.constraints[:200])
    closed = close(found)
    return stated and closed.consistent and closed.narrowed == 0


def gqr(networks: list[Network]) -> str:
    program = shutil.which("gqr")
    if program is None:
        return "not on the PATH"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "networks.csp"
        path.write_text(write_networks((each, str(k)) for k, each in enumerate(networks)), encoding="utf-8")
        started = time.perf_counter()
        limit = TIME_LIMIT * len(networks)
        try:
            subprocess.run([program, "c", "-C", "allen", str(path)], check=True, capture_output=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return f"more than {limit:.0f} s"
    return f"{time.perf_counter() - started:.2f} s"


def report(name: str, networks: list[Network], stated: str = "", runs: int = 3) -> None:
    """Print the median over the runs of the seconds for all networks, by the clock and of processor time."""
    clock, processor = [], []
    solutions: list[Solution] = []
    for _ in range(runs):
        fresh = [uncached(network) for network in networks]
        started = time.perf_counter(), time.process_time()
        solutions = [solve(network, Deadline.after(TIME_LIMIT)) for network in fresh]
        clock.append(time.perf_counter() - started[0])
        processor.append(time.process_time() - started[1])
    verdicts = Counter(str(solution.verdict) for solution in solutions)
    consistent = [n for n, s in zip(networks, solutions, strict=True) if s.verdict is Verdict.CONSISTENT]
    proofs = sum(map(proved, consistent))
    conflicts = sum(solution.dead_ends for solution in solutions)
    seconds(name, statistics.median(processor))
    count(f"{name}: decided", verdicts.total() - verdicts["undecided"])
    count(f"{name}: of them consistent, proved by a scenario", proofs)
    print(
        f"{name:<48} {statistics.median(clock):7.3f} s ({statistics.median(processor):.3f} s of processor time)   "
        + ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))
        + f", {proofs} of {len(consistent)} proved by a scenario, {conflicts:,} contradictions"
    )
    if networks[0].calculus.name == "allen":
        print(f"{'':<48} GQR: {gqr(networks)}" + (f"; stated {stated}" if stated else ""))


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        allen = calculus("allen")
        started = subprocess.run([sys.executable, "-c", START], capture_output=True, text=True, check=True)
        print(f"start-up, once per process: {float(started.stdout):.2f} s")
        rng = np.random.default_rng(15)
        solve(random_network(allen, 20, 9.5, 6.5, rng))  # loads
        for things, degree, many, known in ((60, 9.5, 8, "0.11 s"), (100, 10.0, 8, "")):
            networks = [random_network(allen, things, degree, 6.5, rng) for _ in range(many)]
            report(f"{many} Allen networks, {things} things, degree {degree}", networks, known, runs=3 if known else 1)
        report("8 RCC-8 networks, 80 things, degree 15", [hard_regions(80, 15.0, rng) for _ in range(8)])
        with tempfile.TemporaryDirectory() as folder:
            tool = Path(__file__).parents[1] / "tools" / "make_opra.py"
            subprocess.run([sys.executable, str(tool), "2", folder], check=True, capture_output=True)
            opra = read_calculus(folder).calculus
        points = [random_network(opra, 40, degree, 24.0, rng) for degree in (4.0, 6.0, 8.0, 10.0)]
        solve(points[0], Deadline.after(TIME_LIMIT))  # loads
        report("4 OPRA networks of 72 atoms, 40 points, degree 4-10", points, runs=1)
        data = data_folder("gqr")
        if data is not None:
            own = [text.network for text in read_networks(data / "example-5x320.csp", [allen])]
            report("GQR's own five Allen networks, 320 things", own, "19 s for four of the five")


if __name__ == "__main__":
    main()
