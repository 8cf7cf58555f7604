"""Settings of all tests."""

from __future__ import annotations

import gc

from hypothesis import settings

# How long one example takes depends on the load of the machine, and on kernels that are compiled at their first call.
settings.register_profile("deixis", deadline=None, max_examples=40)  # the suite has eight minutes on two cores
settings.load_profile("deixis")

pytest_plugins = ["pytester"]


def pytest_collection_finish() -> None:
    """Collect garbage rarely, and never in modules and collected tests: it takes a tenth of the time otherwise."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)
