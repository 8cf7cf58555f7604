"""Imagined tables: what they are checked and grounded as, what the command prints and writes, and why there is none."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from commands import deixis
from hypothesis import given, settings
from hypothesis import strategies as st
from random_scripts import scripts

from deixis.grammar.layout.parser import parse_script, read_layout
from deixis.grammar.script import Script
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.answers.answer import Outcome
from deixis.reasoning.grounding.answers.claims import ClaimVerdict
from deixis.session import Session
from deixis.workflows.grounding.ground import ground
from deixis.workflows.layouts.imagine import ImaginedTable, imagine

EXAMPLES = Path(__file__).parents[4] / "examples"
POSSIBLE = ["formal_dinner", "script1", "script2"]


def table(text: str) -> ImaginedTable:
    found = imagine(parse_script(text))
    assert found.tables, found.none
    return found.tables[0]


def require_well_laid(script: Script, imagined: ImaginedTable) -> None:
    """Require that check and grounding find every firm fact, except those that the table notes."""
    noted = {str(fact) for fact in (*imagined.named_otherwise, *imagined.not_shown)}
    checked = Session(memory="not-needed").check(script, imagined.scene)
    assert {str(entry.fact) for entry in checked.table.broken} <= noted
    assert checked.table.well or noted
    found = ground(script, imagined.scene)
    hedged = {str(waived.fact) for waived in imagined.waived}
    missed = [entry for entry in found.outcomes if entry.outcome is not Outcome.SATISFIED]
    assert {str(entry.fact) for entry in missed} <= noted | hedged


# ---- round trip -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", POSSIBLE)
@pytest.mark.parametrize("seed", [0, 1])
def test_imagined_examples_are_checked_and_grounded_as_laid_well(name: str, seed: int) -> None:
    script = read_layout(str(EXAMPLES / f"{name}.layout"))
    found = imagine(script, seed=seed)
    assert [(entry.finished, entry.overlapping, entry.named_otherwise) for entry in found.tables] == [(True, (), ())]
    require_well_laid(script, found.tables[0])


FORMS = [
    *("{a} between {b} and {c}", "{a} at the left edge", "{a} at the far right corner", "{a} in the middle"),
    *("{a} near {b}", "{a} next to {b}", "{a} left of {b}", "{a} at most 10 cm from {b}", "{a} about 15 cm from {b}"),
    *("{a} nearest to {b}", "{a}, {b}, {c} in a row", "{a}, {b}, {c} in a row from left to right", "{a} on tray"),
    *(
        "{a} closer to {b} than {c}",
        "{a} far from {b}",
        "{a} behind {b}",
        "{a} is leftmost",
        "nothing between {a}, {b}",
    ),
    *("{a}, {b}, {c} near each other", "{a} second from the left", "not {a} at the near edge", "{a} in front of {b}"),
]


def true_script(seed: int) -> Script:
    """Return a script of four statements that hold on a random table of five things."""
    rng = np.random.default_rng(seed)
    names = list(rng.permutation(["plate", "cup", "fork", "knife", "bowl", "jug"])[:5])
    apart = False
    while not apart:
        low = rng.uniform(0, 0.8, (5, 2))
        boxes = np.stack([low, low + rng.uniform(0.03, 0.2, (5, 2))], axis=1)
        off = np.maximum(boxes[:, None, 0], boxes[None, :, 0]) >= np.minimum(boxes[:, None, 1], boxes[None, :, 1])
        apart = bool(np.all(np.any(off, axis=2, keepdims=True)[~np.eye(5, dtype=bool)]))
    things = (PerceivedObject(f"o{i}", tuple(b[0]), tuple(b[1]), names[i]) for i, b in enumerate(boxes.tolist()))
    scene, declared = Scene(tuple(things)), "; ".join(f"{name} is a {name}" for name in names)
    statements: dict[str, None] = {}
    while len(statements) < 4:
        a, b, c, *_ = rng.permutation(names)
        statement = FORMS[rng.integers(len(FORMS))].format(a=a, b=b, c=c)
        checked = Session(memory="not-needed").check(parse_script(f"{statement}; {declared}"), scene).table
        clear = all(entry.degree is None or entry.degree > 0.7 for entry in checked.claims)
        if checked.well and clear:
            statements[statement] = None
    return parse_script("layout on tray\n" + "\n".join(statements))


@pytest.mark.parametrize("seed", range(4))
def test_claims_and_graded_words_hold_on_imagined_tables(seed: int) -> None:
    script = true_script(seed)
    (imagined,) = imagine(script).tables
    assert imagined.not_shown == ()
    assert not {entry.verdict for entry in imagined.claims} & {ClaimVerdict.VIOLATED, ClaimVerdict.OPEN}
    checked = Session(memory="not-needed").check(script, imagined.scene)
    assert checked.table.well
    assert checked.conforms


def test_a_claim_that_no_place_satisfies_is_noted() -> None:
    found = imagine(parse_script("cup at the left edge; cup at the right edge; jug left of cup; cup left of pot"))
    (imagined,) = found.tables
    assert [entry.claim.value for entry in imagined.claims if entry.verdict is ClaimVerdict.VIOLATED]
    assert "no place was found where it does" in found.to_text()


def test_a_graded_word_that_the_table_does_not_show_is_noted() -> None:
    assert len(table("fork near plate; fork far from plate").not_shown) == 1
    assert table("fork next to plate").not_shown == ()


@settings(max_examples=15, deadline=None)
@given(scripts())
def test_imagined_random_scripts_are_laid_well_or_have_no_table(
    script: Script,
) -> None:
    found = imagine(script, any_size=True)
    if found.tables:
        require_well_laid(script, found.tables[0])
    else:
        assert found.none is not None
        assert found.none.facts


RELATION = st.sampled_from(["left of", "right of", "above", "below", "top left of", "on", "directly left of", "under"])
NAME = st.sampled_from(["dinner plate", "fork", "napkin", "cup", "saucer", "tray", "wine glass"])
SENTENCE = st.builds(
    lambda front, a, r, b: f"{front}{a} {r} {b}",
    st.sampled_from(["", "", "not ", "usually ", "optional "]),
    NAME,
    RELATION,
    NAME,
).filter(
    lambda text: (
        text.count("fork") < 2
        and len({w for w in ("plate", "napkin", "cup", "tray", "glass") if text.count(w) > 1}) == 0
    )
)


@settings(max_examples=25, deadline=None)
@given(st.lists(SENTENCE.filter(lambda text: text.count("saucer") < 2), min_size=1, max_size=7))
def test_tables_of_usual_sizes_are_laid_well_with_those_sizes(sentences: list[str]) -> None:
    script = parse_script("\n".join(sentences))
    found = imagine(script)
    assert found.decided
    for imagined in found.tables:
        require_well_laid(script, imagined)
        for thing, sized in zip(imagined.scene.objects, imagined.objects, strict=True):
            sides = sorted(high - low for low, high in zip(thing.minimum, thing.maximum, strict=True))
            assert sized.size.width.admits(sides[0], 1e-9)
            assert sized.size.length.admits(sides[1], 1e-9)


# ---- what is imagined -------------------------------------------------------------------------------------------


def test_labels_and_viewpoint_come_from_the_script() -> None:
    scene = table("layout t seen from door\nfork left of plate").scene
    assert [thing.label for thing in scene.objects] == ["fork", "plate"]
    assert scene.viewpoint == "door"


def test_cutlery_stands_upright_and_lies_across_above_a_plate() -> None:
    found = table("fork left of plate; dessert_spoon above plate")
    sides = {
        thing.label: (thing.maximum[0] - thing.minimum[0], thing.maximum[1] - thing.minimum[1])
        for thing in found.scene.objects
    }
    assert sides["fork"][0] < sides["fork"][1]
    assert sides["dessert_spoon"][0] > sides["dessert_spoon"][1]


def test_what_lies_on_a_plate_lies_in_its_middle() -> None:
    found = table("napkin on dinner_plate")
    (napkin, plate) = found.scene.boxes
    assert napkin.mean(axis=0) == pytest.approx(plate.mean(axis=0), abs=0.001)


def test_a_declared_kind_decides_over_the_name() -> None:
    assert table("my_plate is a teaspoon; my_plate left of cup").objects[0].size.length.greatest == pytest.approx(0.16)


def test_imagined_tables_differ_and_repeat_for_a_seed() -> None:
    script = parse_script("fork left of plate; cup above or right of plate")
    found = imagine(script, seed=4, count=5)
    boxes = [imagined.scene.boxes.tobytes() for imagined in found.tables]
    assert len(set(boxes)) == 5
    assert boxes == [imagined.scene.boxes.tobytes() for imagined in imagine(script, seed=4, count=5).tables]
    for imagined in found.tables:
        require_well_laid(script, imagined)


@pytest.mark.parametrize("bad", [{"count": 0}, {"seed": -1}, {"time_limit": -1.0}, {"time_limit": float("nan")}])
def test_settings_that_make_no_sense_are_refused(bad: dict[str, float]) -> None:
    (name,) = bad
    with pytest.raises(SettingError, match=f"^`{name}` must be .* got "):
        imagine(parse_script("a left of b"), **bad)  # type: ignore[arg-type]


def test_a_script_of_nothing_is_an_empty_table() -> None:
    assert len(table("# nothing").scene.objects) == 0


# ---- the command ------------------------------------------------------------------------------------------------


def script_file(folder: Path, text: str) -> Path:
    file = folder / "a.layout"
    file.write_text(text, encoding="utf-8")
    return file


def test_the_command_writes_a_picture_and_a_scene_laid_well(tmp_path: Path) -> None:
    scene, plot = tmp_path / "new" / "t.scene.json", tmp_path / "new" / "t.png"
    script = EXAMPLES / "formal_dinner.layout"
    code, out, _ = deixis("imagine", script, "-o", scene, "--plot", plot)
    assert code == 0
    assert "All 11 facts hold." in out
    assert f"Written: {scene}" in out
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert deixis("check", script, scene, "--memory", tmp_path / "memory")[0] == 0


def test_several_tables_go_to_numbered_files(tmp_path: Path) -> None:
    script = script_file(tmp_path, "fork left of plate")
    code, out, _ = deixis("imagine", script, "--count", 2, "-o", tmp_path / "t.scene.json")
    assert (code, "Table 2" in out) == (0, True)
    assert sorted(path.name for path in tmp_path.glob("*.json")) == ["t-1.scene.json", "t-2.scene.json"]


def test_a_contradiction_is_printed_with_its_lines_and_exits_1() -> None:
    script = EXAMPLES / "contradiction.layout"
    code, out, _ = deixis("imagine", script)
    assert code == 1
    assert "There is no such table with things of any size" in out
    conflict = {line.strip() for line in out.splitlines() if line.startswith("    ")}
    assert conflict == {
        f"{script}:{line}"
        for line in (
            "5:1: left(salad_fork, dinner_fork)",
            "6:1: left(dinner_fork, dinner_plate)",
            "8:1: left(dinner_plate, salad_fork)",
        )
    }


def test_a_contradiction_that_needs_exhaustion_is_found_too(tmp_path: Path) -> None:
    text = "a left of or above b\nnot left(a, b)\nb above c\nc above a\nd left of a"
    code, out, _ = deixis("imagine", script_file(tmp_path, text))
    assert code == 1
    assert "d" not in {line.split("(")[-1][0] for line in out.splitlines() if line.startswith("    ")}


def test_conflicting_sizes_are_reported_and_any_size_has_a_table(tmp_path: Path) -> None:
    script = script_file(tmp_path, "dinner_plate on teaspoon\nteaspoon left of cup")
    code, out, _ = deixis("imagine", script)
    assert code == 1
    assert f"{script}:1:1: on(dinner_plate, teaspoon)" in out
    assert "dinner_plate, a dinner plate: 22.9 to 30.5 cm across" in out
    assert "cup" not in out
    code, out, _ = deixis("imagine", script, "--any-size", "--json")
    assert code == 0
    assert json.loads(out)["tables"][0]["facts"] == {"stated": 2, "satisfied": 2}


def test_json_says_what_the_text_says(tmp_path: Path) -> None:
    script = script_file(tmp_path, "fork left of plate\nusually fork right of plate")
    found = json.loads(deixis("imagine", script, "--json")[1])
    assert (found["decided"], found["conflict"]) == (True, None)
    (given_up,) = found["tables"][0]["given_up"]
    assert (given_up["relation"], given_up["line"]) == ("right", 2)
    assert [entry["line"] for entry in given_up["because"]] == [1]
    conflict = json.loads(deixis("imagine", EXAMPLES / "contradiction.layout", "--json")[1])["conflict"]
    assert sorted(entry["line"] for entry in conflict["facts"]) == [5, 6, 8]
    assert (conflict["sizes"], conflict["minimal"]) == ([], True)


def test_given_up_facts_are_reported_with_the_reason(tmp_path: Path) -> None:
    script = script_file(tmp_path, "fork left of plate\nusually fork right of plate")
    out = deixis("imagine", script)[1]
    assert f"Given up: right(fork, plate) ({script}:2:1) [weight 0.8], which goes against" in out
    assert f"    {script}:1:1: left(fork, plate)" in out


def test_where_the_time_is_up_the_exit_code_is_3(tmp_path: Path) -> None:
    code, out, _ = deixis("imagine", script_file(tmp_path, "fork left of plate"), "--time-limit", 0)
    assert (code, out.startswith("Undecided")) == (3, True)


def test_bad_input_is_one_message_and_exit_code_2(tmp_path: Path) -> None:
    script = script_file(tmp_path, "fork left of plate")
    for arguments, message in (
        (["nowhere.layout"], "there is no such file"),
        ([script_file(tmp_path, "fork lft of plate")], "did you mean 'left of'?"),
        ([script, "--plot", tmp_path / "t.txt"], "the name of a picture must end in .png, .svg or .pdf"),
        ([script, "-o", tmp_path], "this is a folder"),
        ([script, "-o", script], "this is the script"),
    ):
        code, _, error = deixis("imagine", *arguments)
        assert (code, message in error) == (2, True), error
        assert "Traceback" not in error


# ---- the picture ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", POSSIBLE)
def test_no_name_in_a_picture_covers_another(name: str) -> None:
    from deixis.plots.imagine import table_figure

    script = read_layout(str(EXAMPLES / f"{name}.layout"))
    imagined = imagine(script).tables[0]
    figure = table_figure(imagined, script.ontology.kinds, script.title)
    extents = [text.get_window_extent() for text in figure.axes[0].texts]
    assert len(extents) == len(script.objects)
    assert not any(a.overlaps(b) for i, a in enumerate(extents) for b in extents[:i])


# ---- the page ---------------------------------------------------------------------------------------------------

PAGE = (Path(__file__).parents[4] / "docs" / "guides" / "imagine.md").read_text(encoding="utf-8")
SHOWN = re.findall(r"```layout\n(.*?)```\n```text\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize(("text", "shown"), SHOWN)
def test_the_examples_of_the_page_give_what_it_shows(
    text: str, shown: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("example.layout").write_text(text, encoding="utf-8")
    assert _without_reason(deixis("imagine", "example.layout")[1]) == _without_reason(shown)


def _without_reason(shown: str) -> str:
    """Remove the explanation of a contradiction, which the tests of inference check."""
    return re.sub(r"(with things of any size).*", r"\1.", shown)


def test_the_page_has_examples() -> None:
    assert len(SHOWN) == 4


def test_a_long_row_is_imagined_well_before_the_time_is_up() -> None:
    row = "; ".join(f"thing_{i} left of thing_{i + 1}" for i in range(199))
    found = imagine(parse_script(row), time_limit=20)
    assert found.tables and found.tables[0].finished
    assert len(found.tables[0].holds) == 199


@pytest.mark.parametrize("many", [8, 40])
def test_things_of_unknown_kind_keep_their_size_under_many_facts(many: int) -> None:
    facts = "; ".join(f"a{j} right of a{i}" for j in range(many) for i in range(j))
    boxes = table(facts).scene.boxes
    assert (boxes[:, 1] - boxes[:, 0])[:, :2].round(3).tolist() == [[0.08, 0.12]] * many


def test_names_in_any_script_are_drawn_within_the_frame() -> None:
    from deixis.plots.imagine import table_figure

    row = ", ".join(["日本語", *(f"wine_glass_{i}" for i in range(25)), '"_"'])
    found = table(f"left to right: {row}")
    figure = table_figure(found, default_ontology().kinds)
    (axes,) = figure.axes
    assert {"日本語", "wine glass 0", "_"} <= {text.get_text() for text in axes.texts}
    middles = [axes.transData.transform(text.get_position()) for text in axes.texts]
    assert all(axes.bbox.contains(x, y) for x, y in middles)


def test_a_keyboard_lies_across_and_a_fork_does_not() -> None:
    (table,) = imagine(parse_script("keyboard below monitor; fork left of keyboard")).tables
    sides = {thing.label: np.subtract(thing.maximum, thing.minimum) for thing in table.scene.objects}
    assert sides["keyboard"][0] > sides["keyboard"][1] and sides["monitor"][0] > sides["monitor"][1]
    assert sides["fork"][0] < sides["fork"][1]
