"""Experiences: recorded stretches of time, and what held in them."""

from __future__ import annotations

import pytest
from episodic_fluents import on

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import (
    episode,
    experiences,
    finish_recording,
    put_episode,
    start_recording,
)
from deixis.memory.errors import EpisodeError


def test_episode_has_what_held_while_it_was_recorded() -> None:
    with Blackboard.transient() as board:
        board.add(on("before", 0.0, 1.0), by="test")
        start_recording(board, "first", 2.0, by="test")
        board.add(on("during", 3.0), by="test")
        finish_recording(board, "first", 5.0, by="test")
        board.add(on("after", 6.0), by="test")
        assert [each.id for each in episode(board, "first")] == ["during"]
        assert [str(each) for each in experiences(board)] == ["first: from 2 to 5 s"]


def test_episode_is_put_as_a_whole_or_not_at_all() -> None:
    with Blackboard.transient() as board:
        put_episode(board, "one", [on("f1", 1.0, 2.0)], 1.0, 2.0, by="test")
        with pytest.raises(EpisodeError, match="'f1' is on the blackboard already"):
            put_episode(board, "two", [on("f2", 1.0), on("f1", 1.0)], 1.0, 2.0, by="test")
        with pytest.raises(EpisodeError, match="an experience 'one' already"):
            start_recording(board, "one", 3.0, by="test")
        with pytest.raises(EpisodeError, match="no experience 'two'; the blackboard has one"):
            episode(board, "two")
        assert [each.id for each in episode(board, "one")] == ["f1"]
