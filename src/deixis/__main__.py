"""Entry point of the program ``deixis`` and of ``python -m deixis``: the command line."""

import sys

INTERRUPTED = 130
"""Exit code of an interrupted program."""


def main() -> None:
    """Load and run the command line; Ctrl-C ends the program quietly also while it is loaded and while it ends."""
    try:
        from deixis.cli.app import run

        run()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)


if __name__ == "__main__":
    main()
