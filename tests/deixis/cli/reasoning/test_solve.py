"""The solve command: verdicts and exit codes, what it prints, and one clear message for what is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example
from deixis.grammar.formats.networks import parse_networks
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.search.consistency import Verdict
from deixis.report.reasoning.solve import solved_lines
from deixis.workflows.reasoning.solve import SolvedNetwork

FIGURE_5, SETTING = example("closed_but_inconsistent.csp"), example("place_setting.csp")
JOINT = example("boxes_and_regions.csp")
CHAIN = "2 # chain\n0 1 ( < )\n1 2 ( < m )\n.\n"
CIRCLE = "3 # circle\n0 1 ( < )\n3 2 ( < = > )\n1 2 ( < )\n2 0 ( < )\n.\n"


def write(folder: Path, text: str) -> Path:
    path = folder / "network.csp"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_consistent_network(tmp_path: Path) -> None:
    code, out, err = deixis("solve", write(tmp_path, CHAIN), "--calculus", "allen")
    assert (code, err) == (0, "")
    assert out.startswith("line 1 (chain): consistent; 3 things, 2 constraints in allen, 1 pair narrowed")


def test_an_inconsistent_network_prints_its_minimal_conflict(tmp_path: Path) -> None:
    path = write(tmp_path, CIRCLE)
    code, out, _ = deixis("solve", path, "--calculus", "point")
    assert code == 1
    assert [line.strip() for line in out.splitlines()[2:5]] == [
        f"{path}:2:1: 0 1 ( < )",
        f"{path}:4:1: 1 2 ( < )",
        f"{path}:5:1: 2 0 ( < )",
    ]
    assert "3 2" not in out


def test_the_verdict_alone_names_no_conflict(tmp_path: Path) -> None:
    code, out, _ = deixis("solve", write(tmp_path, CIRCLE), "--calculus", "point", "--verdict")
    assert code == 1
    assert len(out.splitlines()) == 1 and "inconsistent" in out
    code, _, err = deixis("solve", write(tmp_path, CIRCLE), "--calculus", "point", "--verdict", "--closure")
    assert code == 2 and "--verdict must not be given with" in err


def test_what_closure_lets_pass_is_caught() -> None:
    code, out, _ = deixis("solve", FIGURE_5, "--calculus", "allen")
    assert code == 1 and "0 pairs narrowed" in out


def test_an_undecided_network(tmp_path: Path) -> None:
    path = write(tmp_path, "1\n0 1 ( ra:d,d )\n0 1 ( rcc8:DC )\n.\n")
    code, out, _ = deixis("solve", path, "--calculus", "ra+rcc8")
    assert code == 3 and "proves nothing" in out and "regions of other shapes may" in out
    code, out, _ = deixis("solve", FIGURE_5, "--calculus", "allen", "--time-limit", "0")
    assert code == 3 and "time limit" in out


@pytest.mark.parametrize("option", ["--closure", "--scenario"])
def test_a_network_that_is_printed_can_be_read_again(option: str) -> None:
    code, out, _ = deixis("solve", SETTING, "--calculus", "ra", option)
    assert code == 0
    (found,) = parse_networks(out, [calculus("ra")])
    (stated,) = parse_networks(SETTING.read_text(encoding="utf-8"), [calculus("ra")])
    for c in stated.network.constraints:
        assert not found.network.stated(c.first, c.second) & ~c.relation
    assert len(found.network.constraints) == 10
    if option == "--scenario":
        assert all(c.relation.bit_count() == 1 for c in found.network.constraints)


def test_a_file_takes_the_network(tmp_path: Path) -> None:
    target = tmp_path / "closed.csp"
    code, out, _ = deixis("solve", write(tmp_path, CHAIN), "--calculus", "allen", "--closure", "-o", target)
    assert code == 0 and out.startswith("line 1")
    assert target.read_text(encoding="utf-8") == "2 # chain\n0 1 ( < )\n0 2 ( < )\n1 2 ( < m )\n.\n"


def test_why_two_things_are_related_as_they_are(tmp_path: Path) -> None:
    path = write(tmp_path, CHAIN)
    code, out, _ = deixis("solve", path, "--calculus", "allen", "--explain", 0, 2)
    assert code == 0
    assert out.splitlines()[1:] == [
        "0 ( < ) 2   composed",
        f"    0 ( < ) 1   stated {path}:2:1",
        f"    1 ( < m ) 2   stated {path}:3:1",
    ]
    code, out, _ = deixis("solve", write(tmp_path, "2\n0 1 ( < )\n."), "--calculus", "allen", "--explain", 0, 2)
    assert code == 0 and "Nothing follows about 0 and 2" in out


def test_several_networks_give_the_worst_verdict(tmp_path: Path) -> None:
    code, out, _ = deixis("solve", write(tmp_path, CHAIN + CIRCLE), "--calculus", "point", "--json")
    assert code == 2  # point has no 'm'
    code, out, _ = deixis("solve", write(tmp_path, CHAIN + CIRCLE), "--calculus", "allen", "--json")
    assert code == 1
    first, second = json.loads(out)["networks"]
    assert (first["verdict"], second["verdict"]) == ("consistent", "inconsistent")
    assert [c["line"] for c in second["conflict"]] == [6, 8, 9] and second["conflict_minimal"]


def test_calculi_are_closed_together() -> None:
    code, out, _ = deixis("solve", JOINT, "--calculus", "ra+rcc8")
    assert code == 1
    assert "ra -> rcc8: " in out
    assert len([line for line in out.splitlines() if ".csp:" in line]) == 3


def test_boxes_show_how_several_calculi_can_hold_together(tmp_path: Path) -> None:
    said = "0 7 ( ra:<,= )\n0 3 ( rcc8:NTPP )\n3 7 ( rcc8:DC rcc8:PO )\n7 9 ( cd:N cd:NE )\n"
    path = write(tmp_path, f"9\n{said}.\n")
    code, out, _ = deixis("solve", path, "--calculus", "ra+rcc8+cd")
    assert code == 0 and "consistent" in out and "box" not in out
    code, out, _ = deixis("solve", path, "--calculus", "ra+rcc8+cd", "--scenario")
    calculi = [calculus(name) for name in ("ra", "rcc8", "cd")]
    (found,), (stated,) = parse_networks(out, calculi), parse_networks(path.read_text(encoding="utf-8"), calculi)
    assert code == 0 and [len(network.constraints) for network in found.networks] == [6, 6, 6]
    for shown, asked in zip(found.networks, stated.networks, strict=True):
        assert all(c.relation.bit_count() == 1 for c in shown.constraints)
        assert not any(shown.stated(c.first, c.second) & ~c.relation for c in asked.constraints)
    boxes = json.loads(deixis("solve", path, "--calculus", "ra+rcc8+cd", "--json")[1])["networks"][0]["boxes"]
    placed = {box["thing"]: (box["min"], box["max"]) for box in boxes}
    assert sorted(placed) == [0, 3, 7, 9]
    assert placed[0][1][0] < placed[7][0][0] and placed[0][0][1] == placed[7][0][1]
    assert out.count("box ") == 4


@pytest.mark.parametrize("option", [[], ["--scenario"]])
def test_points_prove_distances(tmp_path: Path, option: list[str]) -> None:
    path = write(tmp_path, "2\n0 1 ( near )\n1 2 ( medium far )\n0 2 ( far )\n.\n")
    code, out, _ = deixis("solve", path, "--calculus", "distance", *option)
    assert code == 0 and ("0 2 ( far )" in out) == bool(option)


def test_things_that_nothing_is_said_about_cost_nothing(tmp_path: Path) -> None:
    code, out, _ = deixis("solve", write(tmp_path, "99999999\n0 99999999 ( < )\n."), "--calculus", "allen")
    assert code == 0 and "100,000,000 things" in out


def test_gaps_in_the_numbering_do_not_slow_down_solving(tmp_path: Path) -> None:
    path = write(tmp_path, "50000000\n0 7 ( < )\n7 50000000 ( < )\n.")
    code, out, _ = deixis("solve", path, "--calculus", "allen", "--explain", 0, 50_000_000)
    assert code == 0 and out.splitlines()[1] == "0 ( < ) 50000000   composed"
    code, out, _ = deixis("solve", path, "--calculus", "allen", "--explain", 0, 8)
    assert code == 0 and "Nothing follows about 0 and 8" in out
    joint = "50000000\n0 7 ( ra:<,< )\n7 50000000 ( ra:<,< )\n{}.".format
    code, out, _ = deixis("solve", write(tmp_path, joint("0 50000000 ( rcc8:EC )\n")), "--calculus", "ra+rcc8")
    assert code == 1 and "network.csp:4:1: 0 50000000 ( EC )" in out and "any one of these" in out
    code, out, _ = deixis("solve", write(tmp_path, joint("")), "--calculus", "ra+rcc8", "--closure")
    assert code == 0 and "0 50000000 ( ra:<,< )" in [" ".join(line.split()) for line in out.splitlines()]


def test_of_what_is_inconsistent_there_is_nothing_to_explain(tmp_path: Path) -> None:
    path = write(tmp_path, CIRCLE)
    code, out, _ = deixis("solve", path, "--calculus", "point", "--explain", 0, 1)
    assert code == 1 and "These cannot all hold" in out
    assert out.splitlines()[-1] == "There is nothing to explain about 0 and 1: the constraints cannot all hold."
    code, _, err = deixis("solve", path, "--calculus", "point", "--explain", 0, 9)
    assert code == 2 and "no object 9" in err


def test_a_search_conflict_lists_only_lines_of_its_calculus(tmp_path: Path) -> None:
    lines = ["3 0 m s", "3 1 o", "3 2 m s", "0 1 d di", "1 2 d di", "0 2 f fi"]
    parts = (line.split(maxsplit=2) for line in lines)
    said = [f"{i} {j} ( {' '.join(f'ra:{sign},=' for sign in signs.split())} )" for i, j, signs in parts]
    path = write(tmp_path, "\n".join(["4", *said, "0 4 ( rcc8:DC )", "."]))
    code, out, _ = deixis("solve", path, "--calculus", "ra+rcc8")
    assert code == 1
    assert len([line for line in out.splitlines() if ".csp:" in line]) == 6 and "any one of these" in out


def test_a_conflict_cut_short_says_that_it_may_not_be_minimal() -> None:
    (text,) = parse_networks(FIGURE_5.read_text(encoding="utf-8"), [calculus("allen")])
    stated = tuple((text.network, c) for c in text.network.constraints)
    solved = SolvedNetwork(text, Verdict.INCONSISTENT, "", 0, 0.0, conflict=stated, minimal=False)
    lines = list(solved_lines(solved))
    assert "not proved minimal" in lines[1] and lines[-1] == "Leave out or change some of these."


@pytest.mark.parametrize(
    ("text", "options", "says"),
    [
        (CHAIN, ["--calculus", "alen"], "did you mean 'allen'"),
        (CHAIN, ["--calculus", "allen+allen"], "each calculus once"),
        (CHAIN, ["--calculus", "allen+rcc8"], "no bridge connects allen"),
        (CHAIN, ["--calculus", "allen", "--closure", "--scenario"], "must not be given together; choose one"),
        (CHAIN, ["--calculus", "allen", "-o", "x.csp"], "give one of them"),
        ("1\n0 1 ( ra:<,= )\n.", ["--calculus", "ra+cd", "--explain", "0", "1"], "one calculus at a time"),
        (CHAIN, ["--calculus", "allen", "--explain", "0", "7"], "no object 7"),
        ("1\n0 1 ( ovrlaps )\n.", ["--calculus", "allen"], "did you mean 'overlaps'"),
        ("", ["--calculus", "allen"], "no network"),
        ("2\n0 1 ( < )\n1 2 ( < )\n", ["--calculus", "allen"], "has not ended"),
        ("1\n0 1 ( < ) ( > )\n.", ["--calculus", "allen"], "one list of relations"),
    ],
)
def test_bad_input_is_one_message(tmp_path: Path, text: str, options: list[str], says: str) -> None:
    code, out, err = deixis("solve", write(tmp_path, text), *options)
    assert (code, out) == (2, "")
    assert says in err and "Traceback" not in err


def test_more_things_than_fit_are_refused(tmp_path: Path) -> None:
    lines = "".join(f"{i} {i + 1} ( < )\n" for i in range(30_000))
    code, _, err = deixis("solve", write(tmp_path, f"30000\n{lines}.\n"), "--calculus", "allen")
    assert code == 2 and "things can be closed" in err


@pytest.mark.parametrize("option", ["--closure", "--scenario", "--json"])
@pytest.mark.parametrize("calculus", ["allen", "ra", "ra+rcc8"])
def test_a_network_that_says_nothing(tmp_path: Path, option: str, calculus: str) -> None:
    code, out, err = deixis("solve", write(tmp_path, "2 # nothing\n.\n"), "--calculus", calculus, option)
    assert (code, err) == (0, "") and "consistent" in out
