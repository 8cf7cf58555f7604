"""Base class of results that can be shown as JSON, text, a data frame, a picture, and in a notebook.

Each type of answer derives from :class:`Answer`. Its rendering is registered by the name of its class in
:mod:`deixis.report.renderers`, which is looked up when a method is called: so no reasoning module imports the command
line, and no answer imports matplotlib before it is drawn.
"""

from __future__ import annotations

import json
from importlib import import_module
from typing import TYPE_CHECKING, Any

from deixis.arguments import checks_arguments
from deixis.printable import visible_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Answer:
    """Base class of results.

    ``repr`` and ``str`` give one line; :meth:`to_text` gives what the command of the same name prints.

    Examples
    --------
    >>> import deixis
    >>> script = deixis.read_script(text="fork left of plate")
    >>> script
    <Script <text>: 2 objects, 1 fact>
    >>> script.to_dict()["facts"][0]["subject"]
    'fork'
    >>> script.summary(), str(script)
    ('<text>: 2 objects, 1 fact', 'Script <text>: 2 objects, 1 fact')
    >>> print(script.to_json(indent=None)[:36])
    {"file": "<text>", "name": null, "ti
    >>> print(script.to_text())
    <text>: 2 objects, 1 fact
         1  left(fork, plate)
    """

    __slots__ = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the answer as plain data: dictionaries, lists, strings, numbers, booleans and None.

        Returns
        -------
        dict
            The object that the command of the same name prints with ``--json``; ``docs/schema`` holds its JSON Schema.
        """
        return _renderers().to_dict(self)  # type: ignore[no-any-return]

    @checks_arguments
    def to_json(self, indent: int | None = 2) -> str:
        """Return :meth:`to_dict` as JSON text.

        Parameters
        ----------
        indent
            Number of spaces for each level; None gives one line.

        Returns
        -------
        str
            The JSON text, with characters outside ASCII as they are.
        """
        return json.dumps(self.to_dict(), indent=indent, ensure_ascii=False, allow_nan=False)

    def to_text(self) -> str:
        """Return the lines that the command of the same name prints.

        Returns
        -------
        str
            The lines, joined by line ends.
        """
        return "\n".join(_renderers().to_lines(self))

    def to_dataframe(self) -> Any:
        """Return the table in the answer as a ``pandas.DataFrame``.

        Returns
        -------
        pandas.DataFrame
            One row for each entry of the table, with named columns.

        Raises
        ------
        deixis.extras.MissingExtraError
            If pandas is not installed. Deixis does not require it.
        deixis.DeixisError
            If this type of answer has no table.
        """
        return _renderers().to_dataframe(self)

    @checks_arguments
    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the answer, seen from above.

        Parameters
        ----------
        axes
            Axes to draw into. Without them a new figure is made, of a size that fits.

        Returns
        -------
        matplotlib.figure.Figure
            The figure that was drawn into; ``savefig`` writes it to a file.

        Raises
        ------
        deixis.extras.MissingExtraError
            If matplotlib is not installed.
        deixis.DeixisError
            If there is nothing to draw, as for a scene without objects, or this type of answer has no picture.
        """
        return _renderers().plot(self, axes)  # type: ignore[no-any-return]

    def _repr_html_(self) -> str:
        return _renderers().to_html(self)  # type: ignore[no-any-return]

    def _repr_png_(self) -> bytes | None:
        return _renderers().to_png(self)  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        return f"<{self}>"

    def __str__(self) -> str:
        return visible_line(f"{type(self).__name__} {self.summary()}")

    def summary(self) -> str:
        """Return the answer in a few words, for ``repr``.

        Returns
        -------
        str
            The summary, without the name of the type.
        """
        raise NotImplementedError


def _renderers() -> Any:
    return import_module("deixis.report.renderers")


def rounded(probability: float) -> str:
    """Return a probability with three digits; 1 only where it is 1.

    Parameters
    ----------
    probability
        The probability, in [0, 1].

    Returns
    -------
    str
        The digits.

    Examples
    --------
    >>> rounded(0.99974), rounded(0.4567), rounded(1.0)
    ('0.999', '0.457', '1')
    """
    return f"{probability if probability == 1.0 else min(probability, 0.999):.3g}"


def count(number: int, noun: str) -> str:
    """Return a number with its noun, in the singular for 1.

    Parameters
    ----------
    number
        The number, at least 0.
    noun
        The noun in the singular.

    Returns
    -------
    str
        The number and the noun, in the plural unless the number is 1.

    Examples
    --------
    >>> count(1, "fact"), count(3, "fact"), count(2, "category")
    ('1 fact', '3 facts', '2 categories')
    """
    if number == 1:
        return f"1 {noun}"
    return f"{number} {noun[:-1]}ies" if noun.endswith("y") else f"{number} {noun}s"


def share(part: int, total: int, noun: str) -> str:
    """Return a part of a total as a noun phrase: *both facts*, *2 of 5 facts*.

    Parameters
    ----------
    part
        Number of things that are meant, from 0 to ``total``.
    total
        Number of all things, at least 1.
    noun
        The noun in the singular.

    Returns
    -------
    str
        A noun phrase.

    Examples
    --------
    >>> share(1, 1, "fact"), share(2, 2, "fact"), share(5, 5, "fact"), share(2, 5, "fact")
    ('the only fact', 'both facts', 'all 5 facts', '2 of 5 facts')
    >>> share(0, 2, "name"), share(0, 5, "name")
    ('neither name', 'none of 5 names')
    """
    if part == total:
        return {1: f"the only {noun}", 2: count(2, noun).replace("2", "both")}.get(total, f"all {count(total, noun)}")
    if part == 0 and total > 1:
        return f"neither {noun}" if total == 2 else f"none of {count(total, noun)}"
    return f"{part} of {count(total, noun)}"
