"""Check the list of long tests, and how it is measured."""

from __future__ import annotations

import pytest
from long_tests import LIST, ROOT, Durations

LISTED = LIST.read_text(encoding="utf-8").splitlines()


def test_every_listed_test_exists() -> None:
    for test in LISTED:
        file, _, name = test.partition("::")
        assert f"def {name.partition('[')[0]}(" in (ROOT / file).read_text(encoding="utf-8"), test


def test_the_list_is_sorted_and_has_no_test_twice() -> None:
    assert sorted(set(LISTED)) == LISTED


def test_fixtures_do_not_count(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("""
        import time

        import pytest

        def work(seconds):
            end = time.process_time() + seconds
            while time.process_time() < end:
                pass

        @pytest.fixture
        def slow():
            work(0.5)

        def test_quick(slow):
            pass

        def test_long():
            work(0.2)
    """)
    durations = Durations()
    pytester.inline_run("-p", "long_tests", plugins=[durations])
    quick, long = (durations.of[f"test_fixtures_do_not_count.py::{name}"] for name in ("test_quick", "test_long"))
    assert quick < 0.2 <= long + 0.02
