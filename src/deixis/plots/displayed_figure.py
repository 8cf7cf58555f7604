"""Matplotlib figures that notebooks display without pyplot."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

PNG_DPI = 110
"""Resolution of pictures as PNG, in dots per inch."""


class _DisplayedFigure(Figure):
    """A figure that a notebook shows as the value of a cell; it shows others only if pyplot made them."""

    def _repr_png_(self) -> bytes:
        return png_of(self)


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
    figure = _DisplayedFigure(**options)
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
