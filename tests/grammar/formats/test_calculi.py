"""Calculi in GQR's files: they are read correctly, their laws are checked, and errors name their place."""

from __future__ import annotations

import os
from itertools import combinations, permutations, product
from pathlib import Path

import numpy as np
import pytest
from commands import deixis
from make_opra import write as write_opra
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.grammar.formats.calculi import CalculusFileError, read_calculus
from deixis.reasoning.qualitative.calculi.calculus import TableCalculus, bits
from deixis.reasoning.qualitative.calculi.endpoints import composition_in
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.conflict import minimal_conflict
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve


def write(folder: Path, name: str, found: TableCalculus, more: str = "", signs: dict[str, str] | None = None) -> Path:
    """Write the three files of a calculus, with other signs for its atoms where ``signs`` has them."""
    atoms = [(signs or {}).get(atom, atom) for atom in found.atoms]
    spec = f"comp_table_file {name}.comp\nconverse_file {name}.conv\nidentity {atoms[found.identity]}\n"
    (folder / f"{name}.spec").write_text(f"# made\n{spec}calculus_size {len(atoms)}\n{more}", encoding="utf-8")
    lines = [f"{atom} :: {atoms[code]}" for atom, code in zip(atoms, found.converses.tolist(), strict=True)]
    (folder / f"{name}.conv").write_text("\n".join(lines), encoding="utf-8")
    lines = [
        f"{a} : {b} :: ( {' '.join(atoms[k] for k in bits(int(found.composition[i, j])))} )"
        for i, a in enumerate(atoms)
        for j, b in enumerate(atoms)
    ]
    (folder / f"{name}.comp").write_text("\n".join(lines), encoding="utf-8")
    return folder / f"{name}.spec"


def branching_time() -> TableCalculus:
    """Return the calculus of moments in a tree that branches towards the future: <, =, > and | for other branches.

    Three moments and the points where their branches part are at most five moments, so that the trees of five moments
    show every composition.
    """
    codes = np.full((120, 120), -1)  # 24 trees; no relation between moments of different trees
    for tree, parents in enumerate(np.ndindex(1, 1, 2, 3, 4)):
        above = np.eye(5, dtype=bool)
        for node in range(1, 5):
            above[node] |= above[parents[node]]
        inside = slice(5 * tree, 5 * tree + 5)
        codes[inside, inside] = np.where(np.eye(5), 1, np.where(above.T, 0, np.where(above, 2, 3)))
    converses = np.array([2, 1, 0, 3])
    return TableCalculus(
        "branching", ("<", "=", ">", "|"), converses, composition_in(codes, 4), 1, decided_by_closure=False
    )


def occlusion() -> TableCalculus:
    """Return the occlusion calculus (Köhler 2002) of things at different depths in a picture.

    The relations of three regions follow from which of their seven parts are present, and from their order of depth.
    """
    signs = ("I", "D", "O", "OT", "F", "FT", "B", "BT")
    cells = np.arange(1, 8)
    inside = [cells >> thing & 1 == 1 for thing in range(3)]
    table = np.zeros((8, 8), dtype=np.uint64)

    def atom(parts: NDArray[np.bool_], depth: tuple[int, ...], a: int, b: int) -> str | None:
        both, only_a, only_b = (
            bool((parts & where).any())
            for where in (inside[a] & inside[b], inside[a] & ~inside[b], ~inside[a] & inside[b])
        )
        if not both:
            return "D"
        if not only_a and not only_b:
            return None  # only the thing itself has the same region
        front = depth[a] < depth[b]
        if only_a and only_b:
            return "O" if front else "OT"
        within, around = ("F", "BT") if front else ("B", "FT")
        return around if only_a else within

    for present, depth in product(product((False, True), repeat=7), permutations(range(3))):
        parts = np.array(present)
        if not all((parts & where).any() for where in inside):
            continue
        first, second, third = (atom(parts, depth, a, b) for a, b in ((0, 1), (1, 2), (0, 2)))
        if first and second and third:
            table[signs.index(first), signs.index(second)] |= np.uint64(1 << signs.index(third))
        if first:  # the third thing is the first or the second thing
            back = atom(parts, depth, 1, 0)
            assert back
            table[signs.index(first), signs.index(back)] |= np.uint64(1)
            table[0, signs.index(first)] |= np.uint64(1 << signs.index(first))
            table[signs.index(first), 0] |= np.uint64(1 << signs.index(first))
    table[0, 0] = 1
    return TableCalculus("occ", signs, np.array([0, 1, 3, 2, 5, 4, 7, 6]), table, 0, decided_by_closure=False)


def test_the_occlusion_calculus_is_read(tmp_path: Path) -> None:
    text = read_calculus(write(tmp_path, "occ", occlusion()))
    occ = text.calculus
    assert not text.notes

    def composed(first: str, second: str) -> set[str]:
        return set(occ.members(occ.compose(occ.relation([first]), occ.relation([second]))))

    assert composed("F", "F") == {"F"} and composed("B", "F") == {"F", "B"}
    assert composed("O", "O") == {"D", "O", "F", "BT"}
    assert composed("BT", "B") == {"I", "O", "OT", "F", "FT", "B", "BT"}
    front, apart = occ.relation(["F"]), occ.relation(["D"])
    stated = (Constraint(0, 1, front), Constraint(1, 2, apart), Constraint(0, 2, occ.relation(["O", "B"])))
    assert solve(Network(occ, 3, stated)).verdict is Verdict.INCONSISTENT
    assert solve(Network(occ, 3, stated[:2])).verdict is Verdict.UNDECIDED


@pytest.mark.parametrize(("m", "atoms"), [(1, 20), (2, 72)])
def test_opra_is_read_and_refutes(m: int, atoms: int, tmp_path: Path) -> None:
    text = read_calculus(write_opra(m, tmp_path))
    opra = text.calculus
    assert not text.notes and len(opra.atoms) == atoms
    ahead, back, at = f"0_{2 * m}", f"{2 * m}_0", "s_0"
    assert opra.members(opra.compose(opra.relation([ahead]), opra.relation([ahead]))) == (ahead,)
    assert set(opra.members(opra.compose(opra.relation([ahead]), opra.relation([back])))) == {at, ahead, back}
    assert opra.converse(opra.relation([ahead])) == opra.relation([back])
    line = tuple(Constraint(k, k + 1, opra.relation([ahead])) for k in range(5))
    closed = close(Network(opra, 6, line))
    assert opra.members(closed.relation(0, 5)) == (ahead,) and opra.members(closed.relation(5, 0)) == (back,)
    circle = Network(opra, 6, (*line, Constraint(5, 0, opra.relation([ahead, "1_1"]))))
    assert solve(circle).verdict is Verdict.INCONSISTENT
    conflict = minimal_conflict(circle)
    assert conflict is not None and conflict.minimal and len(conflict.constraints) == 6
    around = Network(
        opra, 4, tuple(Constraint(a, b, opra.relation(["1_1", "s_1"])) for a, b in ((0, 1), (1, 2), (2, 3)))
    )
    solution = solve(around, scenario=True)
    assert solution.verdict is Verdict.UNDECIDED and solution.scenario is not None
    again = close(solution.scenario)
    assert again.consistent and again.narrowed == 0 and len(solution.scenario.constraints) == 6


def test_the_command_solves_in_opra(tmp_path: Path) -> None:
    path = write_opra(2, tmp_path)
    network = tmp_path / "n.csp"
    network.write_text("2 #\n0 1 ( 0_4 )\n1 2 ( 0_4 1_5 )\n0 2 ( 4_0 s_1 )\n.\n", encoding="utf-8")
    code, out, err = deixis("solve", network, "--calculus", path)
    assert (code, err) == (1, "") and "inconsistent; 3 things, 3 constraints in opra2" in out


def test_branching_time_is_read_and_refutes(tmp_path: Path) -> None:
    """Compare with the table of Broxvall and Jonsson (1999): the past of a moment is linear, its future is not."""
    text = read_calculus(write(tmp_path, "branching", branching_time()))
    brought = text.calculus
    assert not text.notes and brought.name == "branching"

    def composed(first: str, second: str) -> set[str]:
        return set(brought.members(brought.compose(brought.relation([first]), brought.relation([second]))))

    assert composed("<", ">") == {"<", "=", ">"}
    assert composed(">", "<") == {"<", "=", ">", "|"}
    assert composed("<", "|") == {"<", "|"} and composed("|", "<") == {"|"}
    below, apart = brought.relation(["<"]), brought.relation(["|"])
    stated = (Constraint(0, 2, below), Constraint(1, 2, below), Constraint(0, 1, apart))
    assert solve(Network(brought, 3, stated)).verdict is Verdict.INCONSISTENT
    solution = solve(Network(brought, 3, stated[1:]), scenario=True)
    assert solution.verdict is Verdict.UNDECIDED and "closed" in solution.reason
    assert solution.scenario is not None and len(solution.scenario.constraints) == 3


def test_a_file_may_state_that_closure_decides_atoms(tmp_path: Path) -> None:
    brought = read_calculus(write(tmp_path, "branching", branching_time(), "closure_decides atoms\n")).calculus
    some = brought.relation(["<", "|"])
    assert solve(Network(brought, 3, (Constraint(0, 1, some), Constraint(1, 2, some)))).verdict is Verdict.CONSISTENT


def test_a_file_may_list_relations_that_closure_decides(tmp_path: Path) -> None:
    found = branching_time()
    relations = [1 << code for code in range(4)] + [found.universal, 0b0111, 0b1001, 0b1100, 0b0101, 0b1101]
    closed = set(relations)
    while True:
        more = {a & b for a in closed for b in closed} | {found.converse(a) for a in closed}
        more |= {found.compose(1 << a, 1 << b) for a in range(4) for b in range(4)}
        if more <= closed:
            break
        closed |= more
    listed = "\n".join(f"( {' '.join(found.members(relation))} )" for relation in sorted(closed - {0}))
    (tmp_path / "good").write_text(listed, encoding="utf-8")
    brought = read_calculus(write(tmp_path, "branching", found, "closure_decides good\n")).calculus
    assert brought.decided_by_closure and len(brought.pieces(0b0111)) == 1
    (tmp_path / "good").write_text("\n".join(listed.splitlines()[1:]), encoding="utf-8")
    with pytest.raises(CalculusFileError, match=r"good:1:1: .* missing from the relations"):
        read_calculus(tmp_path / "branching.spec")


@pytest.mark.parametrize("name", ["point", "allen", "rcc5", "rcc8", "cd"])
def test_the_tables_of_a_known_calculus_are_recognised(name: str, tmp_path: Path) -> None:
    known = calculus(name)
    atoms = known.atoms
    table = [[known.compose(1 << i, 1 << j) for j in range(len(atoms))] for i in range(len(atoms))]
    converses = [known.converse(1 << i).bit_length() - 1 for i in range(len(atoms))]
    plain = TableCalculus(name, atoms, np.array(converses), np.array(table, dtype=np.uint64), known.identity)
    order = np.random.default_rng(1).permutation(len(atoms))
    place = np.argsort(order)
    mixed = TableCalculus(
        name,
        tuple(atoms[k] for k in order),
        place[plain.converses[order]],
        np.array([[sum(1 << int(place[k]) for k in bits(table[i][j])) for j in order] for i in order], dtype=np.uint64),
        int(place[known.identity]),
    )
    text = read_calculus(write(tmp_path, "other", mixed, signs={"DR": "DC", "PPI": "PPC"} if name == "rcc5" else None))
    assert text.calculus is known and name in text.notes[-1]


def test_a_contradictory_table_is_repaired_with_a_note(tmp_path: Path) -> None:
    found = branching_time()
    wrong = found.composition.copy()
    wrong[0, 0] |= np.uint64(0b1000)  # < : < may be |, but the converse > : > may not
    table = TableCalculus("wrong", found.atoms, found.converses, wrong, found.identity)
    text = read_calculus(write(tmp_path, "wrong", table))
    assert any("break the law 'converse of composition', first < : <" in note for note in text.notes)
    assert isinstance(text.calculus, TableCalculus)
    assert (text.calculus.composition == found.composition).all()


LINES = {
    "spec": ["comp_table_file a.comp", "converse_file a.conv", "identity =", "calculus_size 2"],
    "conv": ["= :: =", "# :: at the start of a line begins a comment", "! :: !"],
    "comp": ["= : = :: ( = )", "= : ! :: ( ! )", "! : = :: ( ! )", "! : ! :: ( = ! )"],
}


@pytest.mark.parametrize(
    ("file", "line", "text", "place", "message"),
    [
        ("spec", 0, "comp_table a.comp", "a.spec:4:1", "ends without 'comp_table_file'"),
        ("spec", 0, "comp_table_file b.comp", "a.spec:1:17", "there is no file 'b.comp'"),
        ("spec", 2, "identity EQ", "a.spec:3:10", "is not an atom"),
        ("spec", 3, "calculus_size two", "a.spec:4:15", "must be a number"),
        ("spec", 3, "calculus_size 3", "a.spec:4:15", "has 2 atoms"),
        ("spec", 3, "calculus_size 400", "a.spec:4:15", "must be at most 320"),
        ("spec", 3, "identity =", "a.spec:4:1", "given twice"),
        ("conv", 2, "! : !", "a.conv:3:1", "expected an atom"),
        ("conv", 2, "! :: ?", "a.conv:3:6", "no line states the converse of '?'"),
        ("conv", 2, "= :: =", "a.conv:3:1", "stated twice"),
        ("conv", 2, "! :: =", "a.conv:3:1", "converse of a converse"),
        ("comp", 1, "= : ! = ( ! )", "a.comp:2:1", "expected a composition"),
        ("comp", 1, "= : ! :: ( ? )", "a.comp:2:12", "is not an atom"),
        ("comp", 1, "= : = :: ( = )", "a.comp:2:1", "stated twice"),
        ("comp", 1, "", "a.comp:4:1", "1 compositions are missing; the first is that of = and !"),
    ],
)
def test_errors_name_their_place(file: str, line: int, text: str, place: str, message: str, tmp_path: Path) -> None:
    for ending, lines in LINES.items():
        changed = [text if (ending, k) == (file, line) else each for k, each in enumerate(lines)]
        (tmp_path / f"a.{ending}").write_text("\n".join(changed), encoding="utf-8")
    with pytest.raises(CalculusFileError) as error:
        read_calculus(tmp_path / "a.spec")
    assert f"{tmp_path / place}: " in str(error.value) and message in str(error.value)


def test_the_command_reads_a_specification_and_a_folder(tmp_path: Path) -> None:
    path = write(tmp_path, "branching", branching_time())
    network = tmp_path / "n.csp"
    network.write_text("2 #\n0 2 ( < )\n1 2 ( < )\n0 1 ( | )\n.\n", encoding="utf-8")
    for named in (path, tmp_path):
        code, out, err = deixis("solve", network, "--calculus", named)
        assert (code, err) == (1, "") and "inconsistent; 3 things, 3 constraints in branching" in out
    network.write_text("2 #\n0 2 ( < )\n1 2 ( < )\n.\n", encoding="utf-8")
    code, out, _ = deixis("solve", network, "--calculus", path)
    assert code == 3 and "closed" in out
    code, _, err = deixis("solve", network, "--calculus", tmp_path / "none.spec")
    assert code == 2 and "no such file" in err and "Traceback" not in err


def test_a_folder_needs_one_specification(tmp_path: Path) -> None:
    with pytest.raises(DeixisError, match="it has no specification"):
        read_calculus(tmp_path)


def folders() -> list[Path]:
    """Return the specifications in the folder that DEIXIS_DATA names."""
    root = os.environ.get("DEIXIS_DATA")
    return sorted(Path(root).glob("gqr/**/*.spec")) if root else []


@pytest.mark.skipif(not folders(), reason="set DEIXIS_DATA to a folder with specifications in gqr/")
def test_the_specifications_of_gqr_are_read() -> None:
    for path in folders():
        found = read_calculus(path).calculus
        stated = (Constraint(a, b, found.universal) for a, b in combinations(range(3), 2))
        assert solve(Network(found, 3, tuple(stated))).verdict is not Verdict.INCONSISTENT
