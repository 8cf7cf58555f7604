"""Ctrl-C exits quietly, even where a library turns it into another error."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator

import pytest
from commands import deixis

from deixis.__main__ import main
from deixis.cli.interrupts import noting_interrupts


@pytest.fixture(autouse=True)
def pythons_own_handler() -> Iterator[None]:
    """Whoever runs the tests in the background has the signal ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("error", [ImportError("generic_type: cannot initialize type"), OSError("no such library")])
def test_a_library_error_after_an_interrupt_exits_quietly(monkeypatch: pytest.MonkeyPatch, error: Exception) -> None:
    def imports_a_native_library(**_: object) -> None:
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt:
            raise error from None

    monkeypatch.setattr("deixis.cli.app.app", imports_a_native_library)
    assert deixis("simulate") == (130, "", "")


def test_the_same_error_without_an_interrupt_is_a_defect(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(**_: object) -> None:
        raise ImportError("generic_type: cannot initialize type")

    monkeypatch.setattr("deixis.cli.app.app", fails)
    code, _, told = deixis("simulate")
    assert code == 2 and "a defect in Deixis" in told


def test_an_interrupt_is_recorded_and_the_handler_is_restored() -> None:
    with noting_interrupts() as interrupted:
        assert not interrupted.is_set()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        assert interrupted.is_set()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_where_the_signal_is_ignored_it_stays_so() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with noting_interrupts() as interrupted:
        signal.raise_signal(signal.SIGINT)
        assert not interrupted.is_set()
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_an_interrupt_while_the_program_loads_is_quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    class Interrupted:
        def __getattr__(self, name: str) -> object:
            raise KeyboardInterrupt

    monkeypatch.setitem(sys.modules, "deixis.cli.app", Interrupted())
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 130
