"""Names in pictures: which are written, which are left out."""

from __future__ import annotations

from matplotlib.figure import Figure

from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots.arrows import arrow_path
from deixis.plots.figure import dress_table, new_figure
from deixis.plots.names import write_names
from deixis.plots.placement import MANY, crosses


def written(things: list[PerceivedObject], quiet: tuple[str, ...] = ()) -> Figure:
    figure, axes = new_figure(9.0, 7.0)
    axes.set_xlim(0, 10)
    axes.set_ylim(0, 10)
    dress_table(axes, Scene(tuple(things)), None)
    write_names(figure, axes, things, quiet)
    return figure


def grid(number: int, side: float) -> list[PerceivedObject]:
    columns = int(10 / side)
    corners = [(side * (n % columns), side * (n // columns)) for n in range(number)]
    return [PerceivedObject(f"thing_{n}", (x, y), (x + 0.8 * side, y + 0.8 * side)) for n, (x, y) in enumerate(corners)]


def test_the_axis_counts_the_names_that_have_no_room() -> None:
    (axes,) = written(grid(900, 0.33)).axes
    assert not axes.texts
    assert axes.get_xlabel().endswith("; 900 names left out for lack of room")


def test_names_are_written_where_there_is_room_among_many_things() -> None:
    dense = [PerceivedObject(f"d{n}", (0, 0), (0.01, 0.01)) for n in range(MANY)]
    far = PerceivedObject("far", (5, 5), (9, 9))
    (axes,) = written([*dense, far]).axes
    texts = [text.get_text() for text in axes.texts]
    assert "far" in texts and 1 < len(texts) < 50
    assert f"{MANY + 1 - len(texts)} names left out" in axes.get_xlabel()


def test_the_axis_counts_no_names_where_all_are_written() -> None:
    (axes,) = written(grid(20, 2.0)).axes
    assert len(axes.texts) == 20 and "left out" not in axes.get_xlabel()


def test_a_name_as_long_as_the_picture_is_shortened() -> None:
    (axes,) = written([PerceivedObject("x" * 400, (1, 1), (9, 9))]).axes
    assert [text.get_text() for text in axes.texts] == ["x" * 47 + "…"]


def test_names_of_unnamed_things_are_grey_and_slanted() -> None:
    (axes,) = written(grid(2, 2.0), quiet=("thing_1",)).axes
    assert [text.get_fontstyle() for text in axes.texts] == ["normal", "italic"]


def test_leader_lines_cross_no_other_thing_and_no_name() -> None:
    things = [PerceivedObject(f"a_rather_long_name_{n}", (4 + 0.2 * n, 4), (4.1 + 0.2 * n, 6)) for n in range(10)]
    figure = written(things)
    (axes,) = figure.axes
    names = [text.get_window_extent() for text in axes.texts]
    for line in axes.lines:
        (x0, y0), (x1, y1) = axes.transData.transform(line.get_xydata()).tolist()
        boxes = axes.transData.transform([[thing.minimum, thing.maximum] for thing in things]).reshape(-1, 4)
        assert crosses(((x0, y0), (x1, y1)), boxes).sum() <= 1  # the thing itself
    for index, name in enumerate(names):
        assert not any(name.overlaps(other) for other in names[:index])


def test_a_word_covers_neither_end_of_a_short_arrow() -> None:
    figure, axes = new_figure(9.0, 7.0)
    axes.set_xlim(0, 10)
    axes.set_ylim(0, 10)
    arrow = ((5.0, 5.0), (5.2, 4.8))
    path = arrow_path(arrow)
    write_names(figure, axes, [], arrows=[path], words=[("above", path)])
    (word,) = axes.texts
    extent = word.get_window_extent()
    assert not any(extent.contains(*axes.transData.transform(end)) for end in arrow)
