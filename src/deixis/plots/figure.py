"""Figures, colours, axes and files that all pictures share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.errors import DeixisError
from deixis.extras import require
from deixis.perception.scene import UNKNOWN_VIEWPOINT, Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PALETTE = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442")
"""Okabe and Ito's palette: blue, orange, green, purple, sky blue, vermilion, yellow.

People with the common forms of colour blindness can tell these colours apart (https://jfly.uni-koeln.de/color/)."""

PALE_PALETTE = ("#99c7e0", "#f2cf80", "#b2e2d5", "#dba1c1", "#ddf0fb", "#eaae80", "#fcfad9")
"""Palette with each colour paler, by shares that give the largest minimum distance of all 14; ink is read on them."""

INK, QUIET, PAPER = "#22313f", "#9aa5ae", "#fbfaf7"
FADED_INK = "#77808a"
WRONG, BELONGS = PALETTE[5], PALETTE[0]
"""Colours of what is wrong, and of the places where things belong."""

LINE_COLOURS = (*PALETTE[:6], INK)
"""Colours of the lines of a chart; yellow is too pale for a line."""

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


def line_look(number: int) -> dict[str, Any]:
    """Return the colour and the dashes of a line of a chart, which differ for the first 14 lines.

    Parameters
    ----------
    number
        Number of the line, from 0.

    Returns
    -------
    dict
        Arguments of ``Axes.plot``.

    Examples
    --------
    >>> line_look(0), line_look(7)
    ({'color': '#0072b2', 'linestyle': '-'}, {'color': '#0072b2', 'linestyle': '--'})
    """
    row, column = divmod(number, len(LINE_COLOURS))
    return {"color": LINE_COLOURS[column], "linestyle": ("-", "--")[row % 2]}


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
