"""Test the commands that learn and recognise activities from the experiences of a memory."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import deixis

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import put_episode, start_recording
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic

ORDERS = {"monday": ("saucer", "cup", "spoon"), "tuesday": ("saucer", "spoon", "cup")}


@pytest.fixture
def memory(tmp_path: Path) -> Path:
    """Return a memory with two experiences in which three things came, and one that has not finished."""
    folder = tmp_path / "memory"
    seen = Source(Origin.SEEN, "tracker")
    with Blackboard.open(folder, create=True) as board:
        for day, (name, kinds) in enumerate(ORDERS.items()):
            fluents = []
            for place, kind in enumerate(kinds):
                id, at = f"t{day}_{place}", 100.0 * day + 10 * place + 1
                box = f"[{0.1 * place}, 0.0, {0.1 * place + 0.05}, 0.1]"
                fluents += [
                    episodic(board.new_id("f"), (id, "at", box), start=at, finish=100.0 * day + 40, source=seen),
                    episodic(board.new_id("f"), (id, "isA", kind), start=at, finish=100.0 * day + 40, source=seen),
                ]
            put_episode(board, name, fluents, 100.0 * day, 100.0 * day + 50, by="tracker")
        put_episode(board, "nothing", (), 300.0, 310.0, by="tracker")
        start_recording(board, "today", 400.0, by="tracker")
    return folder


def test_activity_is_learned_from_named_experiences(memory: Path, tmp_path: Path) -> None:
    known = tmp_path / "known.json"
    names = [option for name in ORDERS for option in ("--experience", name)]
    code, out, _ = deixis("activity", "learn", "tea", "--memory", memory, "--known", known, *names)
    assert code == 0 and "from 2 examples: 3 steps" in out
    options = ("--known", known, "--memory", memory, "--experience", "monday")
    assert deixis("activity", "recognise", *options)[:2][1].startswith("tea: probability")
    code, out, _ = deixis("activity", "ground", "first the saucer, then the cup", "--memory", memory, *options[-2:])
    assert code == 0


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("nothing", "nothing came to the table in the experience 'nothing'"),
        ("friday", "there is no experience 'friday'; the blackboard has monday, tuesday, nothing, today"),
    ],
)
def test_experience_without_steps_is_refused(memory: Path, tmp_path: Path, name: str, reason: str) -> None:
    known = tmp_path / "known.json"
    code, out, err = deixis("activity", "learn", "tea", "--memory", memory, "--known", known, "--experience", name)
    assert (code, out) == (2, "") and reason in err and err.count("\n") == 1 and not known.exists()


def test_memory_without_episodes_cannot_teach_an_activity(tmp_path: Path) -> None:
    code, out, err = deixis("activity", "learn", "tea", "--memory", tmp_path)
    assert (code, out) == (2, "") and "has no episodes" in err
