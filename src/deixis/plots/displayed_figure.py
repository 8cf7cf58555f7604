"""A matplotlib figure that notebooks display without pyplot."""

from __future__ import annotations

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

PNG_DPI = 110
"""Resolution of pictures as PNG, in dots per inch."""


class DisplayedFigure(Figure):
    """A figure with a canvas of its own, which a notebook shows as the value of a cell.

    A notebook shows other figures only if pyplot made them.

    Examples
    --------
    >>> figure = DisplayedFigure(figsize=(1, 1))
    >>> png_of(figure) == figure._repr_png_()
    True
    """

    def __init__(self, *args: object, **options: object) -> None:
        super().__init__(*args, **options)  # type: ignore[arg-type]
        FigureCanvasAgg(self)

    def _repr_png_(self) -> bytes:
        return png_of(self)


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
