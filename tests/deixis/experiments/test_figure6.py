"""Check the structure of the reproduced Figure 6 on one variant and few node orders, and that a seed determines it."""

from __future__ import annotations

import io
import json
import sys
from contextlib import redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

import numpy as np
import pytest
from answers import assert_is_answer
from schemas import errors_in
from stored_pictures import assert_as_stored

from deixis.cli.app import main
from deixis.experiments.figure6 import Figure6, Points, Spread, run, steps
from deixis.report.renderers import to_rows

CHOICES = ("facts decide", "similarity decides")
RIGHT = {f"{what}, {choice}" for what in ("right", "right up to interchangeability") for choice in CHOICES}
DROPPED = {f"exactly the absent dropped, {choice}" for choice in CHOICES}


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Figure6:
    return run(tmp_path_factory.mktemp("a"), variants=1, orders=3, seed=1)


def test_structure(result: Figure6) -> None:
    assert (result.a.script, result.b.script) == ("script1", "script2")
    assert result.b.subgraphs == 455
    assert result.a.subgraphs > 300
    assert result.a.accuracy.keys() == RIGHT
    assert result.b.accuracy.keys() == RIGHT | DROPPED
    for panel in (result.a, result.b):
        assert -1 <= panel.rho_similarity <= 1
        assert -1 <= panel.rho_facts <= 1
        for spread in (*panel.accuracy.values(), *panel.variants_accuracy.values()):
            assert 0 <= spread.low <= spread.median <= spread.high <= 1
            assert 0 <= spread.mean <= 1


def test_up_to_interchangeability_is_never_worse(result: Figure6) -> None:
    for panel in (result.a, result.b):
        for choice in CHOICES:
            exactly, roughly = (
                panel.accuracy[f"{what}, {choice}"] for what in ("right", "right up to interchangeability")
            )
            assert exactly.mean <= roughly.mean


def test_the_chart_is_as_stored(result: Figure6) -> None:
    assert_as_stored("figure6", Path(result.pictures[1]))


def test_facts_drop_exactly_the_absent(result: Figure6) -> None:
    assert result.b.accuracy["exactly the absent dropped, facts decide"].mean == 1


def test_the_pictures_are_written(result: Figure6) -> None:
    assert [Path(picture).name for picture in result.pictures] == ["figure6a.png", "figure6b.png"]
    for picture in result.pictures:
        data = Path(picture).read_bytes()
        assert data.startswith(b"\x89PNG\r\n\x1a\n")
        assert len(data) > 10_000


@pytest.mark.slow
def test_the_command_prints_the_same_figures_for_the_same_seed(result: Figure6, tmp_path: Path) -> None:
    out = io.StringIO()
    argv = f"deixis experiment figure6 --variants 1 --orders 3 --seed 1 --json --out {tmp_path}".split()
    with patch.object(sys, "argv", argv), redirect_stdout(out), pytest.raises(SystemExit) as end:
        main()
    data, expected = json.loads(out.getvalue()), json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert errors_in("figure6", data) == []
    assert not end.value.code
    assert data.pop("pictures") != expected.pop("pictures")
    assert data == expected


def test_each_sub_graph_is_a_point(result: Figure6) -> None:
    for panel in (result.a, result.b):
        assert len(panel.points.right) == panel.subgraphs
        assert ((panel.points.right >= 0) & (panel.points.right <= 1)).all()


def test_the_result_is_an_answer(result: Figure6) -> None:
    assert_is_answer(result)
    assert repr(result).startswith("<Figure6 1 variant, 3 node orders: ρ 0.")
    assert {row["panel"] for row in to_rows(result)} == {"a", "b"}
    assert "points" not in result.to_dict()["a"]


def test_each_place_setting_is_counted() -> None:
    ticks: list[int] = []
    with patch("deixis.experiments.figure6.SIZES", range(4, 6)), TemporaryDirectory() as folder:
        run(Path(folder), variants=1, orders=1, tick=lambda: ticks.append(1))
    assert len(ticks) == steps(1) == 4


def test_the_text(result: Figure6) -> None:
    lines = result.to_text().splitlines()
    assert lines[0] == "Figure 6: 1 variant, 3 node orders, seed 1"
    assert sum("Spearman's rho" in line for line in lines) == 2
    assert lines[-2:] == list(result.pictures)


def test_spread_percentiles() -> None:
    spread = Spread.of([0.0, 0.5, 1.0])
    assert (spread.mean, spread.median) == (0.5, 0.5)
    assert str(spread) == "0.50 (5 % 0.05, median 0.50, 95 % 0.95)"


def test_a_constant_has_zero_correlation() -> None:
    points = Points(np.ones(4), np.arange(4.0), np.array([0.0, 0.2, 0.5, 1.0]))
    assert points.rho(points.similarity) == 0
    assert points.rho(points.facts) == pytest.approx(1)
