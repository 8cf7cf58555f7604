"""Measure joint solving of networks in several calculi: the share decided, and the processor time.

Satisfiable networks hold the relations of random boxes, in each calculus for a share of the pairs, every other relation
with atoms beside the true one. Consistent verdicts are verified again. *Closing alone* is the share decided without a
search for boxes. Two other kinds of networks follow: contradictory ones, in which one pair gets a relation that joint
closure excludes, and changed ones, in which some relations are replaced at random; these may be satisfiable or not.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from records import command_line, recorded, share

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.bridges import links_between
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.combination import close_jointly, solve_jointly
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.realisation.boxes import satisfies
from deixis.reasoning.qualitative.relate import relate

COMBINATIONS = (
    "ra+rcc8",
    "ra+cd",
    "ten+ra",
    "cd+distance",
    "direction-distance+cd",
    "direction-distance+distance",
    "ra+cd+rcc8",
    "ten+ra+rcc8",
    "ra+cd+distance",
    "direction-distance+cd+ra",
    "ten+ra+cd+distance",
)
SHARES = (1.0, 0.6, 0.3, 0.15)  # share of the pairs with a relation, in each calculus
WIDTHS = (0.0, 0.15, 0.4)  # chances of atoms beside the true one
CHANGED = 0.15  # share of the relations


def random_boxes(count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return boxes anywhere, or on a grid, where they share sides and centres; shape (count, 2, 2)."""
    spread = rng.choice([1.0, 3.0, 6.0])
    centres, halves = rng.uniform(0, spread, (count, 2)), rng.uniform(0.1, 0.4 * spread, (count, 2))
    if rng.random() < 0.5:
        grid = spread / 8
        centres, halves = np.round(centres / grid) * grid, np.maximum(np.round(halves / grid), 1) * grid
    return np.stack([centres - halves, centres + halves], axis=1)


def borne(names: str, count: int, rng: np.random.Generator) -> list[Network]:
    """Return the relations of random boxes in some calculi."""
    boxes, share, width = random_boxes(count, rng), rng.choice(SHARES), rng.choice(WIDTHS)
    found = []
    for name in names.split("+"):
        chosen, codes, stated = calculus(name), relate(boxes, name, reference=1.0), []
        for i, j in np.argwhere(np.triu(rng.random((count, count)) < share, 1)).tolist():
            others = np.flatnonzero(rng.random(len(chosen.atoms)) < rng.choice([0.0, width])).tolist()
            stated.append(Constraint(i, j, 1 << int(codes[i, j]) | sum(1 << k for k in others if k != codes[i, j])))
        found.append(Network(chosen, count, tuple(stated)))
    return found


def contradictory(nets: list[Network], rng: np.random.Generator) -> list[Network] | None:
    """Return the networks with an excluded relation on one pair; None if joint closure excludes nothing new."""
    closed = close_jointly(nets, links_between([net.calculus for net in nets]))
    stated_pairs = [{(c.first, c.second) for c in net.constraints} for net in nets]
    pairs = [
        (k, i, j)
        for k, net in enumerate(nets)
        for i, j in np.argwhere(np.triu(np.ones((net.size, net.size)), 1)).tolist()
        if (i, j) not in stated_pairs[k] and closed.relation(net.calculus.name, i, j) != net.calculus.universal
    ]
    if not pairs:
        return None
    k, i, j = pairs[rng.integers(len(pairs))]
    excluded = nets[k].calculus.universal & ~closed.relation(nets[k].calculus.name, i, j)
    return [net.only([*net.constraints, Constraint(i, j, excluded)]) if net is nets[k] else net for net in nets]


def changed(nets: list[Network], rng: np.random.Generator) -> list[Network]:
    """Return the networks with some relations replaced by a quarter of all atoms."""

    def replaced(net: Network, c: Constraint) -> Constraint:
        atoms = len(net.calculus.atoms)
        others = rng.choice(atoms, max(1, atoms // 4), replace=False).tolist()
        return Constraint(c.first, c.second, sum(1 << k for k in others)) if rng.random() < CHANGED else c

    return [net.only([replaced(net, c) for c in net.constraints]) for net in nets]


@dataclass
class Tally:
    verdicts: Counter[str] = field(default_factory=Counter)
    closing: int = 0  # decided without boxes
    seconds: list[float] = field(default_factory=list)

    def share(self, verdict: str) -> float:
        return self.verdicts[verdict] / max(1, self.verdicts.total())

    def solve(self, nets: list[Network], limit: float) -> None:
        links = links_between([net.calculus for net in nets])
        started = time.process_time()
        found = solve_jointly(nets, links, Deadline.after(limit))
        self.seconds.append(time.process_time() - started)
        assert found.boxes is None or all(satisfies(found.boxes, net) for net in nets)
        self.verdicts[str(found.verdict)] += 1
        self.closing += found.verdict == "consistent" and found.boxes is None

    def __str__(self) -> str:
        return f"{np.median(self.seconds):.2f} s (95 %: {np.quantile(self.seconds, 0.95):.2f} s)"


def generated(names: str, size: int, runs: int) -> Iterator[tuple[list[Network], np.random.Generator]]:
    for seed in range(runs):
        rng = np.random.default_rng([seed, size, *names.encode()])
        yield borne(names, size, rng), rng


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--runs", type=int, default=10, help="networks of each kind")
    parser.add_argument("--sizes", type=int, nargs="+", default=[4, 8, 12, 20])
    parser.add_argument("--limit", type=float, default=10.0, help="seconds for each network")
    parser.add_argument("--only", nargs="+", default=COMBINATIONS)
    with recorded(parser) as options:
        Tally().solve(borne("ra+rcc8", 4, np.random.default_rng(0)), options.limit)  # compiles
        for size in options.sizes:
            whole, contrary, mixed = Tally(), Tally(), Tally()
            for names in options.only:
                own = Tally()
                for nets, rng in generated(names, size, options.runs):
                    own.solve(nets, options.limit)
                    against = contradictory(nets, rng)
                    if against is not None:
                        contrary.solve(against, options.limit)
                    mixed.solve(changed(nets, rng), options.limit)
                whole.verdicts += own.verdicts
                whole.closing += own.closing
                whole.seconds += own.seconds
                wrong = "   REFUTED" if own.verdicts["inconsistent"] else ""
                print(
                    f"{size:>3} things  {names:<28} consistent {own.share('consistent'):.2f}   {own}{wrong}", flush=True
                )
            count = whole.verdicts.total()
            share(f"{size} objects, satisfiable: proved consistent", whole.verdicts["consistent"], count)
            share(
                f"{size} objects, contradictory: refuted", contrary.verdicts["inconsistent"], contrary.verdicts.total()
            )
            print(
                f"{size:>3} things  satisfiable   consistent {whole.share('consistent'):.3f} of {count}, "
                f"by closing alone {whole.closing / count:.3f}   {whole}"
            )
            wrong = f"   {contrary.verdicts['consistent']} CALLED CONSISTENT" if contrary.verdicts["consistent"] else ""
            refuted = f"inconsistent {contrary.share('inconsistent'):.3f} of {contrary.verdicts.total()}"
            print(f"{size:>3} things  contradictory {refuted}   {contrary}{wrong}")
            print(
                f"{size:>3} things  changed       consistent {mixed.share('consistent'):.3f}, inconsistent "
                f"{mixed.share('inconsistent'):.3f}, undecided {mixed.share('undecided'):.3f}   {mixed}",
                flush=True,
            )


if __name__ == "__main__":
    main()
