"""Network files: GQR's files are read, written files are read back, and errors name their place."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.grammar.errors import ScriptFileError
from deixis.grammar.formats.networks import (
    NetworkFileError,
    network_lines,
    parse_networks,
    read_networks,
    write_networks,
)
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.network import Constraint, Network

ALLEN, RA, RCC8, POINT = (calculus(name) for name in ("allen", "ra", "rcc8", "point"))


def read(text: str, *names: str) -> list[tuple[int, int, tuple[str, ...]]]:
    (only,) = parse_networks(text, [calculus(name) for name in names])
    return [(c.first, c.second, n.calculus.members(c.relation)) for n in only.networks for c in n.constraints]


def test_a_file_of_gqr_is_read() -> None:
    text = "2 #1-N3-R0.00-D9.00-S1126384369\n 0  1 ( = > di )\n 1  2 ( m mi )\n.\n"
    (found,) = parse_networks(text, [ALLEN], "a.csp")
    assert (found.comment, found.line, found.network.size) == ("1-N3-R0.00-D9.00-S1126384369", 1, 3)
    assert [c.relation for c in found.network.constraints] == [
        ALLEN.relation(["=", ">", "di"]),
        ALLEN.relation(["m", "mi"]),
    ]
    assert [str(c.source) for c in found.network.constraints] == ["a.csp:2:2", "a.csp:3:2"]


def test_several_networks_comments_and_empty_lines() -> None:
    text = "1 # first\n0 1 (<)\n.\n\n# between\n2 second\n# within\n\n0 1 ( < = )\n0 0 ( = )\n1 2(>)\n.\n"
    found = parse_networks(text, [POINT])
    assert [(each.comment, each.line, each.network.size) for each in found] == [("first", 1, 2), ("second", 6, 3)]
    assert [len(each.network.constraints) for each in found] == [1, 3]


@pytest.mark.parametrize(
    "text",
    ["1\n0 1 (<)\n.", "1\n0 1 (<) # why (not)\n.\n", "\ufeff1\r\n0 1 (<)\r\n.\r\n", "\n\n 1 #\n0\t1\t( < ) # why\n."],
)
def test_equivalent_spellings(text: str) -> None:
    assert read(text, "point") == [(0, 1, ("<",))]


def test_atoms_of_products_with_and_without_parentheses() -> None:
    expected = [(0, 1, ("<,m", "=,>"))]
    for relation in ("( <,m =,> )", "((<,m) (=,>))", "( ra:<,m ra:(=,>) )"):
        assert read(f"1\n0 1 {relation}\n.", "ra") == expected


def test_lines_name_one_of_several_calculi() -> None:
    text = "1\n0 1 ( rcc8:EC rcc8:DC )\n0 1 ( ra:<,< )\n."
    assert read(text, "ra", "rcc8") == [(0, 1, ("<,<",)), (0, 1, ("DC", "EC"))]


def test_an_empty_relation_is_a_contradiction() -> None:
    assert read("1\n0 1 ( )\n.", "point") == [(0, 1, ())]


@pytest.mark.parametrize(
    ("text", "place", "says"),
    [
        ("", ":1:1:", "no network"),
        ("# nothing\n\n", ":1:1:", "no network"),
        ("0 1 ( < )\n", ":2:", ""),
        ("abc\n", ":1:1:", "largest index"),
        ("-1\n", ":1:1:", "largest index"),
        ("9" * 5000, ":1:1:", "largest index"),
        ("2\n0 3 ( < )\n.", ":2:3:", "an index must be at most 2"),
        (f"2\n0 {'9' * 5000} ( < )\n.", ":2:3:", "an index must be at most 2"),
        ("2\n0 1 ( < ovrlaps )\n.", ":2:9:", "did you mean 'overlaps'"),
        ("2\n0 1 < m\n.", ":2:1:", "expected a constraint"),
        ("2\n0 ( < )\n.", ":2:1:", "expected a constraint"),
        ("2\n  0 1 ( < ) m\n.", ":2:3:", "expected a constraint"),
        ("2\n0 1 ( < \n.", ":2:1:", "expected a constraint"),
        ("2\n0 1 ( rcc8:EC )\n.", ":2:7:", "no relation"),
        ("2\n0 1 ( < ) ( > )\n.", ":2:9:", "one list of relations"),
        ("2\n0 1 ( < m ) (= )\n.", ":2:11:", "one list of relations"),
        ("2\n0 1 ( < )\n1 2 ( < )\n\n", ":3:1:", "the network of line 1 has not ended"),
        ("2\n0 1 ( < )\n.\n1\n# cut off", ":5:1:", "the network of line 4 has not ended"),
    ],
)
def test_errors_name_their_place(text: str, place: str, says: str) -> None:
    if not says:
        text, says = "0 1 ( < )\n0 1 ( < )\n", "an index must be at most 0"
    with pytest.raises(NetworkFileError) as error:
        parse_networks(text, [ALLEN], "bad.csp")
    assert f"bad.csp{place}" in str(error.value) and says in str(error.value)
    assert len(str(error.value)) < 2000


def test_all_errors_are_shown_up_to_a_limit() -> None:
    with pytest.raises(NetworkFileError) as error:
        parse_networks("1\n0 1 (?)\n0 2 (<)\n0 1 (!)\n.", [POINT])
    assert [problem.source.line for problem in error.value.problems] == [2, 3, 4]
    with pytest.raises(NetworkFileError) as error:
        parse_networks("1\n" + "x\n" * 100_000, [POINT])
    assert len(error.value.problems) == 50


@pytest.mark.parametrize("line", ["0 1 ( < )", "0 1 ( rcc8:DC ra:<,< )", "0 1 ( )"])
def test_a_line_belongs_to_one_calculus(line: str) -> None:
    with pytest.raises(NetworkFileError):
        parse_networks(f"1\n{line}\n.", [RA, RCC8])


@st.composite
def networks(draw: st.DrawFn, name: str) -> Network:
    chosen, size = calculus(name), draw(st.integers(1, 12))
    thing = st.integers(0, size - 1)
    relation = st.integers(0, chosen.universal)
    lines = draw(st.lists(st.tuples(thing, thing, relation), max_size=6))
    return Network(chosen, size, tuple(Constraint(*line) for line in lines))


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.sampled_from(["point", "allen", "ra", "rcc8", "cd", "ten"]).flatmap(networks), min_size=1, max_size=1)
)
def test_written_networks_are_read_back(written: list[Network]) -> None:
    (network,) = written
    (found,) = parse_networks(write_networks([(network, "a comment")]), [network.calculus])
    assert found.comment == "a comment"
    assert found.network.size == network.size
    assert [(c.first, c.second, c.relation) for c in found.network.constraints] == [
        (c.first, c.second, c.relation) for c in network.constraints
    ]


def test_several_calculi_are_written_and_read_back() -> None:
    both = [Network(RA, 2, (Constraint(0, 1, 5),)), Network(RCC8, 2, (Constraint(1, 0, 3),))]
    text = "\n".join(network_lines(both, "two"))
    (found,) = parse_networks(text, [RA, RCC8])
    assert [[c.relation for c in n.constraints] for n in found.networks] == [[5], [3]]


def test_a_hundred_thousand_lines_are_read_in_time() -> None:
    text = "999 #\n" + "".join(f"{i % 1000} {i * 7 % 1000} ( < m o )\n" for i in range(100_000)) + "."
    with processor_time_below(10):
        assert len(parse_networks(text, [ALLEN])[0].network.constraints) == 100_000


def test_a_huge_index_costs_nothing() -> None:
    assert read("999999999\n0 999999999 ( < )\n.", "point") == [(0, 999_999_999, ("<",))]


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(ScriptFileError, match="no such file"):
        read_networks(tmp_path / "none.csp", [POINT])
    with pytest.raises(OSError, match="folder"):
        read_networks(tmp_path, [POINT])
    (tmp_path / "bytes.csp").write_bytes(b"1\n0 1 (\xff)\n.")
    with pytest.raises(ScriptFileError, match="UTF-8"):
        read_networks(tmp_path / "bytes.csp", [POINT])
