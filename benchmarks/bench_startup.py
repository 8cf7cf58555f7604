"""How long the command line takes to start, beside `python -c pass`. Whole processes, medians of 15 runs in turn."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from common import medians

SCRIPT = "\n".join(f"thing_{i} left of thing_{i + 1}" for i in range(20)) + "\n"


def command(*arguments: str) -> Callable[[], object]:
    return lambda: subprocess.run([sys.executable, *arguments], check=True, capture_output=True)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "twenty.layout"
        script.write_text(SCRIPT, encoding="utf-8")
        jobs = {
            "python -c pass": command("-c", "pass"),
            "deixis --help": command("-m", "deixis.cli.app", "--help"),
            "deixis parse, 20 lines": command("-m", "deixis.cli.app", "parse", str(script)),
        }
        for name, seconds in zip(jobs, medians(*jobs.values(), runs=15), strict=True):
            print(f"{name:<24} {seconds * 1000:7.0f} ms")


if __name__ == "__main__":
    main()
