"""Matplotlib figures that notebooks display without pyplot."""

from __future__ import annotations

import io
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PNG_DPI = 110
"""Resolution of pictures as PNG, in dots per inch."""


@cache
def _figure_class() -> type[Figure]:
    """Return the class of figures that a notebook shows as the value of a cell; it shows others only from pyplot."""
    from matplotlib.figure import Figure

    class DisplayedFigure(Figure):
        def _repr_png_(self) -> bytes:
            return png_of(self)

    return DisplayedFigure


def displayed_figure(**options: Any) -> Figure:
    """Return an empty figure with a canvas of its own, which a notebook shows as the value of a cell.

    Parameters
    ----------
    options
        Arguments of matplotlib's ``Figure``.

    Returns
    -------
    Figure
        The figure.

    Examples
    --------
    >>> figure = displayed_figure(figsize=(1, 1))
    >>> png_of(figure) == figure._repr_png_()
    True
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = _figure_class()(**options)
    FigureCanvasAgg(figure)
    return figure


def png_of(figure: Figure) -> bytes:
    """Return a figure as PNG.

    Parameters
    ----------
    figure
        Figure with a canvas.

    Returns
    -------
    bytes
        The picture at :data:`PNG_DPI` dots per inch.
    """
    target = io.BytesIO()
    figure.savefig(target, format="png", dpi=PNG_DPI)
    return target.getvalue()
