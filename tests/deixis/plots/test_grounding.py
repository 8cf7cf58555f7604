"""Legend, axes and names in the picture of a grounded scene."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from deixis.grammar.layout.parser import parse_script
from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots.figure import save
from deixis.plots.grounding import Marks, grounding_figure
from deixis.workflows.grounding.ground import ground


def picture(script: str, unit: str = "m", viewpoint: str = "chair", frame: str = "table") -> Figure:
    things = PerceivedObject("a", (0, 0), (4, 6), label="cup"), PerceivedObject("b", (5, 0), (20, 8), label="plate")
    scene = Scene(things, frame=frame, viewpoint=viewpoint, unit=unit)
    return grounding_figure(ground(parse_script(script), scene), scene)


def legend(figure: Figure) -> list[str]:
    return [text.get_text() for shown in figure.legends for text in shown.get_texts()]


def test_the_legend_says_what_there_is() -> None:
    assert legend(picture("cup left of plate")) == ["1 fact satisfied"]
    assert legend(picture("cup right of plate")) == ["1 violated"]


@pytest.fixture(scope="module")
def row() -> Figure:
    """Two groups of indistinguishable things, in a row many times as wide as deep."""
    spoons = [PerceivedObject(f"s{n}", (0.05 * n, 0.3), (0.05 * n + 0.03, 0.44), "teaspoon") for n in range(16)]
    glasses = [PerceivedObject(f"g{n}", (1.4 + 0.1 * n, 0.3), (1.47 + 0.1 * n, 0.37), "wine_glass") for n in range(6)]
    scene = Scene((*spoons, PerceivedObject("p", (1.0, 0.3), (1.26, 0.56), "plate"), *glasses))
    script = "; ".join(
        [f"teaspoon_{n} is a teaspoon; teaspoon_{n} left of plate" for n in range(16)]
        + [f"wine_glass_{n} is a wine glass; wine_glass_{n} right of plate" for n in range(6)]
    )
    return grounding_figure(ground(parse_script(script), scene), scene)


def test_large_groups_are_abbreviated_to_fit_the_picture(row: Figure) -> None:
    spoons = next(entry for entry in legend(row) if "teaspoon" in entry)
    assert spoons.count("teaspoon") == 12 and spoons.endswith("4 more")
    assert all(line.split(" ")[0] != "glass" for entry in legend(row) for line in entry.split("\n"))
    (shown,) = row.legends
    extent, axes = shown.get_window_extent(), row.axes[0]
    assert extent.x0 > 0 and extent.x1 < row.bbox.width and extent.y0 > 0
    assert extent.y1 < axes.xaxis.label.get_window_extent().y0


def test_a_flat_table_fills_the_width_without_overlapping_names(row: Figure) -> None:
    assert row.axes[0].bbox.width > 0.85 * row.bbox.width
    extents = [text.get_window_extent() for text in row.axes[0].texts]
    assert len(extents) == 23
    assert not any(a.overlaps(b) for i, a in enumerate(extents) for b in extents[:i])


def test_a_picture_with_large_groups_is_saved_without_a_warning(row: Figure, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        save(row, tmp_path / "row.png")


def test_groups_beyond_the_colours_are_not_one_group() -> None:
    kinds = ("fork", "knife", "spoon", "plate", "cup", "bowl", "tray", "jug")
    things = [PerceivedObject(f"o{n}", (n, 0), (n + 0.5, 1), kinds[n // 2]) for n in range(16)]
    script = parse_script("; ".join(f"{kinds[n // 2]}_{n} is a {kinds[n // 2]}" for n in range(16)))
    entries = legend(grounding_figure(ground(script, Scene(tuple(things))), Scene(tuple(things))))
    assert sorted(entry.split()[4] for entry in entries) == sorted(kinds)
    assert all(len(entry.split(",")) == 2 for entry in entries)


def test_a_mark_is_in_the_legend_where_there_is_one() -> None:
    scene = Scene((PerceivedObject("a", (0, 0), (1, 1), "cup"),))
    found = ground(parse_script("cup is a cup"), scene)
    for marks, said in (
        (Marks(wrong={"a"}), ["misplaced, or (dashed) extra"]),
        (Marks(miscoloured={"a"}), ["of another colour"]),
        (Marks(unsure={"a"}), ["named by its place alone"]),
        (Marks(), []),
    ):
        assert legend(grounding_figure(found, scene, None, marks)) == said


@pytest.mark.parametrize(
    ("unit", "viewpoint", "frame", "across", "along"),
    [
        ("m", "chair", "table", "metres, to the right as seen from the chair", "metres, away from the chair"),
        ("px", "chair", "table", "pixels, to the right as seen from the chair", "pixels, away from the chair"),
        ("px", "camera", "table", "pixels, to the right", "pixels, up"),
        ("px", "chair", "image", "pixels, to the right", "pixels, up"),
    ],
)
def test_what_the_axes_mean_is_that_of_the_scene(
    unit: str, viewpoint: str, frame: str, across: str, along: str
) -> None:
    axes = picture("cup left of plate", unit, viewpoint, frame).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == (across, along)


def test_an_unnamed_thing_has_the_id_that_a_label_refers_to() -> None:
    scene = Scene((PerceivedObject("a", (0, 0), (1, 1), "cup"), PerceivedObject("b", (2, 0), (3, 1), "cup")))
    found = ground(parse_script("cup is a cup"), scene)
    (axes,) = grounding_figure(found, scene).axes
    named, other = sorted((text.get_text() for text in axes.texts), key=len, reverse=True)
    (match,) = found.matches.values()
    assert f"or at {match.alternatives[0].perceived}" in named
    assert other == f"cup ({match.alternatives[0].perceived})"
