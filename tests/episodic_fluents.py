"""Fluents for tests of the blackboard."""

from __future__ import annotations

from hypothesis import strategies as st

from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.reasoning.temporal.bounds import Bounds

SEEN = Source(Origin.SEEN, "tracker", "frame 1")


def on(id: str, start: float | Bounds | None = 0.0, finish: float | Bounds | None = None) -> EpisodicFluent:
    """Return the fluent that a cup is on the table.

    Parameters
    ----------
    id
        Its id.
    start, finish
        Times in seconds, bounds, or None.

    Returns
    -------
    EpisodicFluent
        The fluent.
    """
    return episodic(id, ("cup", "on", "table"), start=start, finish=finish, source=SEEN)


@st.composite
def some_fluents(draw: st.DrawFn, most: int = 12) -> list[EpisodicFluent]:
    """Draw fluents with ids of their own, some with unknown or uncertain times.

    Parameters
    ----------
    draw
        Function that draws from a strategy.
    most
        Maximum number of fluents.

    Returns
    -------
    list of EpisodicFluent
        The fluents.
    """
    times = st.integers(-20, 20).map(float)
    found = []
    for number in range(draw(st.integers(0, most))):
        start, finish = Bounds(), Bounds()
        if draw(st.booleans()):
            first = draw(times)
            start = Bounds(first, first + draw(st.sampled_from([0.0, 1.0, 5.0])))
        if draw(st.booleans()):
            earliest = max(draw(times), start.upper + 1 if start != Bounds() else -30.0)
            finish = Bounds(earliest, earliest + draw(st.sampled_from([0.0, 0.000001, 3.0])))
        statement = (draw(st.sampled_from("ab")), draw(st.sampled_from(["on", "near"])), draw(st.sampled_from("ab")))
        certainty = draw(st.sampled_from([0.25, 1.0]))
        found.append(episodic(f"f{number}", statement, start=start, finish=finish, certainty=certainty, source=SEEN))
    return found
