"""The pytest plugin: fixtures for scripts, scenes and sessions, and ``.layout`` files that are tests.

It imports nothing of Deixis until a fixture or a collected file needs it, so that other suites do not wait for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.perception.scene import Scene
    from deixis.session import Session
    from deixis.testing.expectations import Expectation


@pytest.fixture
def deixis_script(request: pytest.FixtureRequest) -> Callable[[str | Path], Script]:
    """Reader of scripts: of a file beside the test (a name that ends in ``.layout``), or of a text."""
    from deixis.testing.assertions import script_of

    def read(script: str | Path) -> Script:
        __tracebackhide__ = True
        return script_of(script, request.path.parent)

    return read


@pytest.fixture
def deixis_scene(request: pytest.FixtureRequest) -> Callable[[str | Path | Mapping[str, Any]], Scene]:
    """Reader of scenes: of a file beside the test, or of parsed JSON."""
    from deixis.testing.assertions import scene_of

    def read(scene: str | Path | Mapping[str, Any]) -> Scene:
        __tracebackhide__ = True
        return scene_of(scene, request.path.parent)

    return read


@pytest.fixture
def deixis_session(tmp_path: Path) -> Iterator[Session]:
    """Session with a memory of its own, which is gone after the test."""
    from deixis.session import Session

    with Session(tmp_path / "memory") as session:
        yield session


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> LayoutFile | None:
    """Collect a ``.layout`` file that has an expectation block.

    Parameters
    ----------
    file_path
        A file that pytest found.
    parent
        The collector of its folder.

    Returns
    -------
    LayoutFile or None
        The collector of the file, or None for all other files.
    """
    if file_path.suffix != ".layout" or "expect:" not in file_path.read_text(encoding="utf-8", errors="replace"):
        return None
    return LayoutFile.from_parent(parent, path=file_path)


class LayoutFile(pytest.File):
    """Layout script with an expectation block."""

    def collect(self) -> Iterator[LayoutItem]:
        """Yield a test for each expectation.

        Yields
        ------
        LayoutItem
            A test.
        """
        from deixis.testing.expectations import expectations_in

        for expectation in expectations_in(self.path.read_text(encoding="utf-8"), str(self.path)):
            item = LayoutItem.from_parent(self, name=expectation.text)
            item.expectation = expectation
            yield item

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the message of a malformed expectation without a traceback through Deixis.

        Parameters
        ----------
        excinfo
            The exception of the collection.
        style
            Style of a traceback; a file that is collected has that of the command line.

        Returns
        -------
        str or TerminalRepr
            The message, or pytest's own report of another exception.
        """
        from deixis.testing.expectations import ExpectationError

        return str(excinfo.value) if isinstance(excinfo.value, ExpectationError) else super().repr_failure(excinfo)


class LayoutItem(pytest.Item):
    """One expectation of a layout script."""

    expectation: Expectation

    def runtest(self) -> None:
        """Check the expectation."""
        from deixis.testing.expectations import run
        from deixis.workflows.layouts.read import read_script

        run(self.expectation, read_script(self.path), self.path.parent)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> str:
        """Return the message of a failed expectation without a traceback through Deixis.

        Parameters
        ----------
        excinfo
            The exception of the test.
        style
            Style of pytest's tracebacks, which is not used.

        Returns
        -------
        str
            The message.
        """
        from deixis.errors import DeixisError

        if isinstance(excinfo.value, AssertionError | DeixisError):
            return f"{self.path}:{self.expectation.line}: expected: {self.expectation.text}\n{excinfo.value}"
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the place of the expectation, for pytest.

        Returns
        -------
        tuple
            File, line from 0, and name of the test.
        """
        return self.path, self.expectation.line - 1, f"{self.path.name}: {self.expectation.text}"
