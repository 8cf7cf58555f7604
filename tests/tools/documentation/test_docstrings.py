"""Check that short names in the Python reference get their modules, and that wrong names are reported."""

from __future__ import annotations

import pytest

pytest.importorskip("sphinx", reason="needs sphinx, of the extra docs")

from documentation.docstrings import ARRAY, LITERAL_OR_BAR, names_of
from documentation.docstrings import _exists as exists


def test_names_that_are_imported_for_type_checking_are_known() -> None:
    names = names_of("deixis.workflows.grounding.ground")
    assert names["Scene"] == "deixis.perception.scene.Scene"
    assert names["GroundingRequest"] == "deixis.workflows.grounding.ground.GroundingRequest"


@pytest.mark.parametrize(
    ("name", "there"),
    [
        ("deixis.workflows.grounding.ground", True),
        ("deixis.workflows.grounding.ground.Stage", True),
        ("deixis.workflows.grounding.ground.gone", False),
    ],
)
def test_a_name_exists_as_a_module_or_in_one(name: str, there: bool) -> None:
    assert exists(name) == there


def test_array_types_are_written_short() -> None:
    full = "~numpy.ndarray[tuple[~typing.Any, ...], ~numpy.dtype[~numpy.float64]]"
    assert ARRAY.sub(r"NDArray[\1]", f"(points: {full})") == "(points: NDArray[float64])"


def test_bars_are_kept_in_code_and_escaped_elsewhere() -> None:
    escaped = LITERAL_OR_BAR.sub(lambda found: r"\|" if found[0] == "|" else found[0], "|a - b| is ``x | y``")
    assert escaped == r"\|a - b\| is ``x | y``"
