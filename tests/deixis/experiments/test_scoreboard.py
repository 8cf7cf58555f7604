"""Test the scoreboard on contestants of known quality, and the command on few cases."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import assert_is_answer
from hypothesis import given, settings
from hypothesis import strategies as st
from schemas import errors_in
from stored_pictures import assert_as_stored

from deixis.cli.app import main
from deixis.deadline import Deadline
from deixis.experiments.scoreboard.board import Board, groups, relative, right_up_to_interchangeability, run_contestants
from deixis.experiments.scoreboard.calibration import Forecasts, calibration
from deixis.experiments.scoreboard.cases import Group, Setting, generated_cases
from deixis.experiments.scoreboard.contestants import DEFAULT, Contestant, ContestantAnswer
from deixis.experiments.scoreboard.plot import plot_scoreboard
from deixis.experiments.scoreboard.report import lines, verdict
from deixis.experiments.scoreboard.run import Scoreboard, ScoreboardPlan, run, steps
from deixis.experiments.scoreboard.statistics import holm, interval, paired_p
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.report.renderers import to_rows

TINY = ScoreboardPlan(
    cases=1,
    time_limit=1.0,
    sizes=(5,),
    facts_each=(1.5,),
    off=(0.0, 0.1, 0.2),
    ablated_sizes=(5,),
    limited_sizes=(5,),
)
SETTING = Setting(8, 0.1, 1.5, True)


def _knowing(name: str) -> Contestant:
    """Return a contestant that finds the true map by the boxes of the things, with certainty."""
    truths = {tuple(case.description.nodes): case.truth for case in generated_cases([SETTING], 8, seed=1)}

    def solve(evidence: Evidence, deadline: Deadline) -> ContestantAnswer:
        truth = truths[evidence.description.nodes]
        marginals = np.zeros((len(truth), len(evidence.scene.nodes) + 1))
        marginals[np.arange(len(truth)), truth] = 1.0  # UNMATCHED is the last column
        return ContestantAnswer(truth, proved=True, marginals=marginals)

    return Contestant(name, "knows the truth", solve)


def _silent(name: str) -> Contestant:
    return Contestant(
        name, "leaves all out", lambda evidence, _: ContestantAnswer(np.full(len(evidence.labels), UNMATCHED))
    )


def _played(*contestants: Contestant) -> Board:
    return run_contestants(contestants, generated_cases([SETTING], 8, seed=1), 1.0, lambda _: None)


def test_scores_of_a_perfect_and_of_a_silent_contestant() -> None:
    board = _played(_knowing("exact"), _silent("silent"))
    assert board.mean("exact", SETTING, "right").mean == board.mean("exact", SETTING, "grouped").mean == 1
    assert board.mean("silent", SETTING, "right").mean == pytest.approx(1 / 8)
    assert board.mean("silent", SETTING, "facts").mean == 0
    assert board.mean("exact", Group(8, 0.1), "facts").mean == 1


def test_the_verdict_names_contestants_better_than_the_default() -> None:
    good = _played(_knowing("exact"), _silent("silent")).comparisons("right", seed=1)
    assert [one.verdict for one in good] == ["better"]
    assert "not significantly worse" in verdict(good)
    bad = _played(_silent("exact"), _knowing("knowing"), _silent("silent")).comparisons("right", seed=1)
    assert [one.verdict for one in bad] == ["worse", ""]
    assert verdict(bad) == "exact is significantly worse than: knowing (8 objects, 10 % off, -0.88)."


def test_a_certain_and_right_contestant_is_calibrated() -> None:
    found = calibration(_played(_knowing("exact")).forecasts)
    assert (found.count, found.error, found.decided, found.precision) == (8 * 7, 0.0, 1.0, 1.0)


def test_contestants_too_small_or_missing_are_left_out() -> None:
    small = Contestant("small", "", _silent("").solve, most=4)
    lacking = Contestant("lacking", "", _silent("").solve, lacking="not installed")
    board = _played(_knowing("exact"), small, lacking)
    assert {score.contestant for score in board.scores} == {"exact"}
    assert [one.name for one in board.contestants] == ["exact", "small"]


@given(st.integers(0, 100))
@settings(max_examples=10, deadline=None)
def test_shuffling_keeps_the_value_of_the_truth(seed: int) -> None:
    (case,) = generated_cases([SETTING], 1, seed)
    other = case.shuffled(np.random.default_rng(seed + 1))
    first, second = (one.evidence(SHIPPED) for one in (case, other))
    assert first.degrees(case.truth).sum() == second.degrees(other.truth).sum()
    assert first.problem.value(case.truth) == pytest.approx(second.problem.value(other.truth), rel=1e-5)


def test_kinds_make_sizes_count() -> None:
    (with_kinds,) = generated_cases([SETTING], 1, 1, kinds=True)
    (without,) = generated_cases([SETTING], 1, 1)
    assert with_kinds.evidence(SHIPPED).sizes.any()
    assert not without.evidence(SHIPPED).sizes.any()
    assert np.array_equal(with_kinds.truth, without.truth)


def _forks() -> RelationGraph:
    left = (default_ontology().relations["left"],)
    facts = [Fact(name, left, "plate") for name in ("a", "b", "c")]
    return RelationGraph.from_facts(default_ontology().relations, ["plate", "a", "b", "c"], facts)


@pytest.mark.parametrize(
    ("assignment", "share"),
    [
        ([0, 1, 2, 3], 1.0),
        ([0, 3, 1, 2], 1.0),
        ([1, 0, 2, 3], 0.5),
        ([0, 3, 1, UNMATCHED], 0.75),
        ([UNMATCHED, 3, 1, 4], 0.5),
    ],
)
def test_right_up_to_interchangeability_counts_one_to_one(assignment: Sequence[int], share: float) -> None:
    alike = groups(_forks())
    assert [group.tolist() for group in alike] == [[1, 2, 3]]
    assert right_up_to_interchangeability(np.array(assignment), np.arange(4), alike) == share


def test_any_missing_object_of_a_group_may_be_left_out() -> None:
    truth = np.array([0, UNMATCHED, 1, 2])
    assert right_up_to_interchangeability(np.array([0, 2, UNMATCHED, 1]), truth, groups(_forks())) == 1.0


def test_values_are_relative_to_the_best() -> None:
    assert relative([1.0, 2.0, -1.0]) == [0.5, 1.0, -0.5]
    assert all(np.isnan(relative([0.0, -1.0])))


def test_an_interval_by_hand() -> None:
    found = interval([1.0, 2.0, 3.0, float("nan")])
    assert (found.mean, found.count) == (2.0, 3)
    assert found.half == pytest.approx(4.3027 / np.sqrt(3), rel=1e-4)  # t(0.975, 2 degrees of freedom)


def test_few_differences_are_tested_by_all_signs() -> None:
    assert paired_p([1.0, 2.0, 3.0, 0.0], seed=0) == pytest.approx(2 / 8)
    assert paired_p([1.0, -1.0], seed=0) == paired_p([0.0] * 5, seed=0) == 1.0


def test_many_normal_differences_are_tested_as_student_s_t_does() -> None:
    from scipy.stats import ttest_1samp

    some = np.random.default_rng(3).normal(0.3, 1.0, 60)
    assert paired_p(some, seed=0) == pytest.approx(float(ttest_1samp(some, 0.0).pvalue), abs=0.01)


@given(st.lists(st.floats(0, 1), min_size=1, max_size=8))
def test_holm_never_lowers_a_p_nor_changes_their_order(ps: list[float]) -> None:
    adjusted = holm(ps)
    assert all(p <= q <= 1 for p, q in zip(ps, adjusted, strict=True))
    assert (np.diff(np.array(adjusted)[np.argsort(ps)]) >= 0).all()
    assert min(adjusted) == pytest.approx(min(1.0, len(ps) * min(ps)))


def test_calibration_by_hand() -> None:
    said, right = np.array([0.05, 0.55, 0.55, 0.99]), np.array([False, True, False, True])
    found = calibration([Forecasts("exact", Group(4, 0.0), said, right)])
    assert [one.count for one in found.bins] == [1, 0, 0, 0, 0, 2, 0, 0, 0, 1]
    assert found.error == pytest.approx((0.05 + 2 * 0.05 + 0.01) / 4)
    assert (found.decided, found.precision) == (0.25, 1.0)
    assert np.isnan(calibration([]).error)


@pytest.fixture(scope="module")
def tiny() -> Scoreboard:
    ticks: list[str] = []
    found = run(TINY, tick=ticks.append)
    assert len(ticks) == steps(TINY)
    return found


def _figures(found: Scoreboard) -> list[tuple[object, ...]]:
    return [(s.setting, s.contestant, s.right, s.grouped, repr(s.facts), repr(s.value)) for s in found.main.scores]


def test_the_same_seed_gives_the_same_figures(tiny: Scoreboard) -> None:
    assert _figures(run(TINY)) == _figures(tiny)


def test_the_text_fits_the_page_and_names_skipped_parts(tiny: Scoreboard) -> None:
    text = lines(tiny)
    assert max(map(len, text)) <= 120
    assert text[0] == "Scoreboard, seed 1, 1 s for a case"
    assert any("skipped: photographs: set DEIXIS_DATA" in line for line in text)
    for name in ("exact", "scalable", "similarity", "blondel", "heymans-singh", "graded off", "unary off", "both off"):
        assert any(line.startswith(name) for line in text), name


def test_one_contestant_reaches_the_best_on_every_case(tiny: Scoreboard) -> None:
    for score in tiny.main.scores:
        fellows = [one for one in tiny.main.scores if one.setting == score.setting and one.unit == score.unit]
        assert max(one.facts for one in fellows) == 1
        assert max(one.value for one in fellows) == 1
        assert score.right <= score.grouped


def test_limits_use_the_tables_of_the_board(tiny: Scoreboard) -> None:
    assert [one.setting for one in tiny.limits] == [Setting(5, off, 1.5, False) for off in TINY.off]
    for one in tiny.limits:
        assert one.incomplete == 0
        assert one.right.mean == tiny.main.mean(DEFAULT, one.setting, "right").mean
        assert one.short.mean == pytest.approx(one.words.mean - one.right.mean)


def test_the_result_is_an_answer(tiny: Scoreboard) -> None:
    assert_is_answer(tiny)
    row = next(row for row in to_rows(tiny) if row["engine"] == DEFAULT)
    assert 0 <= row["right"] <= row["grouped"] <= 1


def test_the_chart_is_as_stored(tiny: Scoreboard, tmp_path: Path) -> None:
    scores = tuple(replace(score, seconds=1e-4 * score.setting.objects) for score in tiny.main.scores)
    plot_scoreboard(replace(tiny, main=replace(tiny.main, scores=scores)), tmp_path / "board.png")
    assert_as_stored("scoreboard", tmp_path / "board.png")


def _command(*options: str) -> str:
    out = io.StringIO()
    sys.argv = ["deixis", "experiment", *options]
    with redirect_stdout(out), pytest.raises(SystemExit) as end:
        main()
    assert not end.value.code
    return out.getvalue()


def test_the_command_prints_json_and_draws(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, tiny: Scoreboard) -> None:
    monkeypatch.setattr(sys, "argv", [])
    monkeypatch.setattr("deixis.experiments.scoreboard.run.run", lambda plan, tick: tiny)
    picture = tmp_path / "board.png"
    data = json.loads(_command("scoreboard", "--quick", "--json", "--plot", str(picture)))
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert errors_in("scoreboard", data) == []
    assert data["seed"] == 1
    assert {entry["engine"] for entry in data["board"]["groups"]} >= {"exact", "similarity"}
    assert {entry["verdict"] for entry in data["comparisons"]} <= {"", "better", "worse"}
    assert data["limits"][0]["short"]["half"] is None  # of a single table


def test_an_unknown_experiment_is_an_error(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", ["deixis", "experiment", "figure7"])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert "No such command 'figure7'" in capsys.readouterr().err
