"""Settings of all tests."""

from __future__ import annotations

import gc
from pathlib import Path

import pytest
from hypothesis import settings

# How long one example takes depends on the load of the machine, and on kernels that are compiled at their first call.
settings.register_profile("deixis", deadline=None, max_examples=40)  # the suite has eight minutes on two cores
settings.load_profile("deixis")

pytest_plugins = ["pytester"]

LONG = frozenset(Path(__file__).with_name("long_tests.txt").read_text(encoding="utf-8").splitlines())
"""Tests that take long, as ``tools/long_tests.py`` measured."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the long tests, before pytest selects tests by their marks."""
    for item in items:
        if item.nodeid in LONG:
            item.add_marker("long")


def pytest_collection_finish() -> None:
    """Collect garbage rarely, and never in modules and collected tests: it takes a tenth of the time otherwise."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)


@pytest.fixture(autouse=True)
def _no_memory_of_the_user(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Let sessions without a folder use one that does not exist, and not what the user has learned."""
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path_factory.getbasetemp() / "no-memory"))
