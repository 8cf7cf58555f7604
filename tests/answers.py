"""Checks that hold for each type of answer."""

from __future__ import annotations

import json

from matplotlib.figure import Figure

from deixis.answers import Answer
from deixis.report.renderers import RENDERERS, to_rows


def assert_is_answer(answer: Answer) -> None:
    """Check the short text, the plain data, the table, the notebook display and the picture of an answer."""
    name = type(answer).__name__
    assert repr(answer).startswith(f"<{name} ") and len(repr(answer)) < 160 and "\n" not in repr(answer)
    assert json.loads(answer.to_json()) == json.loads(json.dumps(answer.to_dict()))
    assert answer.to_text()
    assert answer._repr_html_().startswith(f"<p><b>{name}</b> ")
    if RENDERERS[name].rows is not None:
        assert len({tuple(row) for row in to_rows(answer)}) == 1
    if RENDERERS[name].figure is not None:
        axes = Figure().subplots()
        assert answer.plot(axes) is axes.figure
        assert axes.get_title(loc="left") or axes.get_title()
        assert (answer._repr_png_() or b"").startswith(b"\x89PNG")
