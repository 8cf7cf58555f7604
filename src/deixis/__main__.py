"""Entry point of ``python -m deixis``: the command line."""

from deixis.cli.app import run

if __name__ == "__main__":
    run()
