"""Write tests/long_tests.txt, the tests that ``make test`` leaves out because they take long.

``python tools/long_tests.py`` runs all tests except those that kill processes, and lists those that take
:data:`LONG` seconds of processor time or more, with the processes that they start. Fixtures do not count, because
other tests share them. ``tests/conftest.py`` marks the listed tests ``long``.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

LONG = 1.5
"""Processor time in seconds from which a test is long."""

ROOT = Path(__file__).parents[1]
LIST = ROOT / "tests" / "long_tests.txt"
_MEASURED = "processor seconds"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Measure the processor time of a test; with xdist this runs in the processes that run tests."""
    started = sum(os.times()[:4])
    yield
    item.user_properties.append((_MEASURED, sum(os.times()[:4]) - started))


class Durations:
    """Plugin that collects the measured times of all tests, in the process that reports them.

    Attributes
    ----------
    of
        Processor time in seconds by the id of the test.
    """

    def __init__(self) -> None:
        self.of: dict[str, float] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note the time of a test that ran."""
        if report.when == "call":
            self.of[report.nodeid] = float(str(dict(report.user_properties).get(_MEASURED, 0.0)))


def main() -> int:
    """Run the tests and write the list, unless a test failed."""
    durations = Durations()
    options = ["-n", "auto", "--dist", "loadfile", "-m", "not kills", "-p", "long_tests"]
    code = int(pytest.main([*options, *sys.argv[1:]], plugins=[durations]))
    if code == 0:
        long = sorted(test for test, seconds in durations.of.items() if seconds >= LONG)
        LIST.write_text("".join(f"{test}\n" for test in long), encoding="utf-8")
        rest = sum(seconds for seconds in durations.of.values() if seconds < LONG)
        print(f"{len(long)} of {len(durations.of)} tests are long; the others take {rest:.0f} s of processor time")
    return code


if __name__ == "__main__":
    sys.exit(main())
