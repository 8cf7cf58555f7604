"""Figures, colours, axes and files that all pictures share."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.errors import DeixisError
from deixis.extras import require
from deixis.perception.scene import UNKNOWN_VIEWPOINT, Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, QUIET, WRONG, PAPER = "#22313f", "#9aa5ae", "#d55e00", "#fbfaf7"
FADED_INK = "#77808a"
BELONGS = "#0072b2"
"""Colour of the places where things belong.

Like WRONG and the colours of groups it is of Okabe and Ito's palette, which people with the common forms of colour
blindness can tell apart (https://jfly.uni-koeln.de/color/)."""

MARGIN = 0.12
"""Margin of the picture, in inches."""


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure to a file, making its folder.

    Parameters
    ----------
    figure
        The figure.
    path
        The file; its ending says which format.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    """
    import warnings

    target = require_picture(path)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)
            figure.savefig(target, dpi=180, facecolor=PAPER)
    except OSError as error:
        raise DeixisError(f"{target}: cannot write the picture: {error.strerror}") from error


def require_picture(path: str | Path) -> Path:
    """Check the path of a picture, and make its folder.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    DeixisError
        If the picture cannot be written there, or its ending is not that of a picture.
    MissingExtraError
        If matplotlib is not installed.
    """
    require("matplotlib", f"{path}: drawing a picture")
    target = Path(path)
    if target.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise DeixisError(f"{target}: the name of a picture must end in .png, .svg or .pdf")
    if target.is_dir():
        raise DeixisError(f"{target}: this is a folder; name a file for the picture")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DeixisError(f"{target}: the folder of the picture cannot be created: {error.strerror}") from error
    return target


def new_figure(width: float, height: float, **subplots: Any) -> tuple[Figure, Any]:
    """Return an empty figure that needs no display, and that a notebook shows as the value of a cell.

    Parameters
    ----------
    width, height
        Size in inches.
    subplots
        Arguments of ``Figure.subplots``.

    Returns
    -------
    tuple
        The figure, and its axes or an array of them.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    """
    require("matplotlib", "drawing a picture")
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    from deixis.plots.displayed_figure import displayed_figure

    room = ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=MARGIN)
    figure = displayed_figure(figsize=(width, height), facecolor=PAPER, layout=room)
    return figure, figure.subplots(**subplots)


class Names:
    """Names in a picture, each put where it covers no other one, if there is such a place.

    Parameters
    ----------
    axes
        The axes to write into.
    letter
        Width and height of a letter in the axes' units.
    size
        Size of the letters in points.
    """

    def __init__(self, axes: Axes, letter: tuple[float, float], size: float) -> None:
        self._axes, self._letter, self._size = axes, letter, size
        self._placed: list[tuple[float, float, float]] = []

    def write(self, name: str, x: float, heights: Sequence[float], colour: str = INK) -> None:
        """Write a name.

        Parameters
        ----------
        name
            The name.
        x
            Its middle.
        heights
            Heights of its middle that are tried in turn; the first one is taken if all are crowded.
        colour
            Its colour.
        """
        from matplotlib.patheffects import withStroke

        width, high = len(name) * self._letter[0], self._letter[1]

        def crowded(y: float) -> bool:
            return any(
                abs(x - other) < (width + wide) / 2 and abs(y - height) < high for other, height, wide in self._placed
            )

        y = next((y for y in heights if not crowded(y)), heights[0])
        self._placed.append((x, y, width))
        stroke = withStroke(linewidth=2.2, foreground="#ffffff")
        self._axes.text(x, y, name, color=colour, fontsize=self._size, ha="center", va="center", path_effects=[stroke])


def canvas(axes: Axes | None, width: float, height: float) -> tuple[Figure, Axes]:
    """Return axes to draw into, with their figure.

    Parameters
    ----------
    axes
        Axes, or None for those of a new figure.
    width, height
        Size of a new figure in inches.

    Returns
    -------
    tuple
        Figure and axes.
    """
    if axes is None:
        return new_figure(width, height)
    return axes.figure.figure, axes


def dress_chart(axes: Axes, title: str, across: str) -> None:
    """Set the title, the label of the horizontal axis, and the colours and grid of a chart.

    Parameters
    ----------
    axes
        Axes with the drawn chart.
    title
        Title.
    across
        Label of the horizontal axis.
    """
    axes.set_title(title, color=INK, fontsize=10, loc="left")
    axes.set_xlabel(across, color=INK, fontsize=9)
    axes.tick_params(colors=INK, labelsize=8)
    axes.set_facecolor(PAPER)
    axes.grid(color=QUIET, alpha=0.25, linewidth=0.6)
    for side in axes.spines.values():
        side.set_color(QUIET)


def dress_table(axes: Axes, scene: Scene, title: str | None) -> None:
    """Set the labels, colours and title of a table seen from above; its aspect and margins are set before.

    Parameters
    ----------
    axes
        Axes with the drawn table.
    scene
        The scene.
    title
        Title, or None.
    """
    axes.autoscale_view()
    across, along = f"to the right as seen from the {scene.viewpoint}", f"away from the {scene.viewpoint}"
    if scene.frame == "image" or (scene.unit == "px" and scene.viewpoint != Scene(()).viewpoint):
        across, along = "to the right", "up"  # the image need not be a plan
    elif scene.viewpoint == UNKNOWN_VIEWPOINT or scene.viewer is not None:
        across, along = "along x", "along y"
    unit = "pixels" if scene.unit == "px" else "metres"
    axes.set_xlabel(f"{unit}, {across}", color=INK, fontsize=8.5)
    axes.set_ylabel(f"{unit}, {along}", color=INK, fontsize=8.5)
    axes.tick_params(colors=INK, labelsize=8)
    axes.set_facecolor(PAPER)
    for side in axes.spines.values():
        side.set_color(QUIET)
    if title:
        axes.set_title(title, color=INK, fontsize=12, loc="left", parse_math=False)
