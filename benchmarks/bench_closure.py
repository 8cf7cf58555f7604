"""Time algebraic closure of random networks, beside a direct path consistency algorithm and GQR.

The peer is path consistency over 13-bit masks, axis by axis, compiled by numba: a queue of pairs; the composition of
two relations is an OR, over the atoms of the left one, of a table that covers every right one. The results are
compared. GQR takes part, as a process that reads files, if ``gqr`` is on the PATH.

Rectangles come from random boxes, so that the networks are consistent; each fact has the pair's own atoms and, on each
axis, every other atom with a probability of 0.1. Allen networks are made the same way; of 10,000 constraints several
relate the same pair.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from functools import partial
from pathlib import Path
from typing import cast

import numpy as np
from common import medians
from numba import njit
from numpy.typing import NDArray
from records import command_line, count, ratio, recorded

from deixis.grammar.formats.networks import write_networks
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus, TableCalculus
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import Closure, close
from deixis.reasoning.qualitative.networks.network import Constraint, Network, on_axes

ALLEN = cast(TableCalculus, calculus("allen"))
RA = cast(ProductCalculus, calculus("ra"))
Masks = NDArray[np.uint16]


def network(things: int, facts: int, axes: int, seed: int) -> Network:
    rng = np.random.default_rng(seed)
    ends = np.sort(rng.uniform(0, 10, (axes, things, 2)), axis=2)
    pairs = [rng.choice(things, 2, replace=False) for _ in range(facts)]
    first, second = np.array(pairs).T
    codes = [allen_relations(e[first, 0], e[first, 1], e[second, 0], e[second, 1]) for e in ends]
    others = (rng.random((axes, facts, 13)) < 0.1) @ (1 << np.arange(13))
    masks = [[int(m) | 1 << int(c) for m, c in zip(ms, cs, strict=True)] for ms, cs in zip(others, codes, strict=True)]
    relations = masks[0] if axes == 1 else [RA.of_axes(both) for both in zip(*masks, strict=True)]
    stated = zip(first.tolist(), second.tolist(), relations, strict=True)
    return Network(ALLEN if axes == 1 else RA, things, tuple(Constraint(i, j, r) for i, j, r in stated))


@njit(cache=True)
def straight(net, table, converses):  # type: ignore[no-untyped-def]
    """Compute path consistency in place, (n, n) masks; return False if a pair is emptied."""
    n = len(net)
    queued = np.zeros((n, n), dtype=np.bool_)
    queue = np.empty((n * n, 2), dtype=np.int32)
    head = length = 0
    for i in range(n):
        for j in range(i + 1, n):
            if net[i, j] != 8191:
                queue[length] = i, j
                queued[i, j] = True
                length += 1
    while length:
        i, j = queue[head]
        head = (head + 1) % (n * n)
        length -= 1
        queued[i, j] = False
        for k in range(n):
            for a, b in ((i, j), (j, i)):
                if k in (i, j):
                    continue
                through = 0
                for atom in range(13):
                    if net[a, b] >> atom & 1:
                        through |= table[atom, net[b, k]]
                left = net[a, k] & through
                if left == net[a, k]:
                    continue
                if left == 0:
                    return False
                net[a, k] = left
                net[k, a] = converses[left]
                low, high = min(a, k), max(a, k)
                if not queued[low, high]:
                    queued[low, high] = True
                    queue[(head + length) % (n * n)] = low, high
                    length += 1
    return True


def tables() -> tuple[Masks, Masks]:
    """Return the compositions of each atom with every relation, (13, 8192), and each relation's converse, (8192,)."""
    compositions = [[ALLEN.compose(1 << atom, mask) for mask in range(8192)] for atom in range(13)]
    converses = [ALLEN.converse(mask) for mask in range(8192)]
    return np.array(compositions, dtype=np.uint16), np.array(converses, dtype=np.uint16)


def uncached(network: Network) -> Network:
    """Return the network without its cached closure, so that each run starts from the constraints."""
    return Network(network.calculus, network.size, network.constraints)


def peer(nets: list[Network], table: Masks, converses: Masks) -> list[list[Masks]]:
    closed = []
    for each in nets:
        axes = []
        for axis in on_axes(uncached(each)) or ():
            net = np.full((axis.size, axis.size), 8191, dtype=np.uint16)
            np.fill_diagonal(net, 1 << ALLEN.identity)
            stated = axis.arrays
            masks = np.array(stated.relations, dtype=np.uint16)[stated.ids]
            np.bitwise_and.at(net, (stated.firsts, stated.seconds), masks)
            np.bitwise_and.at(net, (stated.seconds, stated.firsts), converses[masks])
            straight(net, table, converses)
            axes.append(net)
        closed.append(axes)
    return closed


def ours(nets: list[Network]) -> list[Closure]:
    return [close(uncached(each)) for each in nets]


def gqr(folder: Path, nets: list[Network]) -> float | None:
    """Return the seconds of ``gqr c``, reading included; None if there is no such program."""
    program = shutil.which("gqr")
    if program is None:
        return None
    path = folder / "networks.csp"
    path.write_text(write_networks((each, str(k)) for k, each in enumerate(nets)), encoding="utf-8")
    command = [program, "c", "-C", "allen", str(path)]
    (seconds,) = medians(lambda: subprocess.run(command, check=True, capture_output=True), runs=5)
    return seconds


def compare(name: str, nets: list[Network], table: Masks, converses: Masks) -> None:
    mine, theirs = ours(nets), peer(nets, table, converses)
    same = all(
        np.array_equal(part[:, :, 0], net)
        for closure, axes in zip(mine, theirs, strict=True)
        for part, net in zip(closure.parts, axes, strict=True)
    )
    seconds, straightly = medians(partial(ours, nets), partial(peer, nets, table, converses), runs=5)
    verdict = "same result" if same else "RESULTS DIFFER"
    times = f"{straightly / seconds:.1f} times"
    ratio(f"{name}, plain compiled path consistency", straightly, seconds, "numba")
    count(f"{name}: networks with another result than the plain algorithm", 0 if same else len(nets))
    print(f"{name:<42} deixis {seconds:.3f} s   straight numba {straightly:.3f} s ({times})   {verdict}")
    if nets[0].calculus is ALLEN:
        with tempfile.TemporaryDirectory() as folder:
            process = gqr(Path(folder), nets)
        print(
            f"{'':<42} GQR, as a process "
            + ("not measured: no gqr on the PATH" if process is None else f"{process:.3f} s")
        )


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        table, converses = tables()
        for things, facts in ((200, 500), (500, 1_000)):
            nets = [network(things, facts, 2, seed=1)]
            compare(f"rectangle algebra, {things} things, {facts:,} facts", nets, table, converses)
        for facts in (1_000, 10_000):
            nets = [network(80, facts, 1, seed) for seed in range(100)]
            compare(f"100 Allen networks, 80 things, {facts:,} facts", nets, table, converses)


if __name__ == "__main__":
    main()
