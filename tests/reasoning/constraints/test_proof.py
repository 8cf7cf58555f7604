"""Proofs that share parts are written once."""

from __future__ import annotations

from deixis.reasoning.constraints.proof import Proof, Rule


def test_shared_parts_are_written_once() -> None:
    leaf = Proof("a <= 1", Rule.STATED, source="f.json: fluents[0].start")
    why = Proof("step 0", Rule.SHORTEST_PATH, (leaf,))
    for k in range(1, 200):
        why = Proof(f"step {k}", Rule.SHORTEST_PATH, (why, why))
    lines = list(why.lines())
    assert len(lines) == 2 + 199 * 2
    assert sum("as above" in line for line in lines) == 199
    assert why.leaves() == (leaf,)
    assert why.stated() == (leaf.claim,)
