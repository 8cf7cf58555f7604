"""Settings of all tests."""

from __future__ import annotations

from hypothesis import settings

# How long one example takes depends on the load of the machine, and on kernels that are compiled at their first call.
settings.register_profile("deixis", deadline=None, max_examples=40)  # the suite has eight minutes on two cores
settings.load_profile("deixis")

pytest_plugins = ["pytester"]
