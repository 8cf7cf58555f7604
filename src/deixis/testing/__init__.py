"""Assertions for test suites about layouts and tables, and a pytest plugin.

The plugin (:mod:`deixis.testing.plugin`) is registered when Deixis is installed. It brings the fixtures
``deixis_script``, ``deixis_scene`` and ``deixis_session``, and collects ``.layout`` files with an expectation block.

Examples
--------
>>> from deixis.testing import assert_follows
>>> inference = assert_follows("fork left of plate; plate left of knife", "left(fork, knife)")
>>> assert_follows("fork left of plate", "left(plate, fork)")
Traceback (most recent call last):
    ...
AssertionError: left(plate, fork) cannot hold, since this does:
    right(plate, fork)   by inverse
        left(fork, plate)   stated   [<text>:1:1]
"""

from __future__ import annotations

from deixis.testing.assertions import (
    assert_checks,
    assert_consistent,
    assert_contradictory,
    assert_follows,
    assert_grounds,
    assert_not_follows,
)

__all__ = [
    "assert_checks",
    "assert_consistent",
    "assert_contradictory",
    "assert_follows",
    "assert_grounds",
    "assert_not_follows",
]
