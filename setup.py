"""Find the packages of the wheel; ``pyproject.toml`` holds everything else.

The top-level folders of the repository are mapped into ``deixis``. Each build finds their packages again, so that a new
folder with an ``__init__.py`` needs no entry here. No symbolic link is followed: a ZIP, a checkout without links and
the source distribution build the same wheel as a clone.
"""

from setuptools import find_packages, setup

ROOMS = ("ontology", "reasoning", "grammar", "perception", "memory")

links = [pattern for room in ROOMS for pattern in (room, f"{room}.*")]
"""Packages that ``find_packages`` sees through the links under ``src/deixis``, which serve type checkers only."""

packages = ["deixis", *(f"deixis.{found}" for found in find_packages("src/deixis", exclude=links)), "deixis.examples"]
for room in ROOMS:
    packages += [f"deixis.{room}", *(f"deixis.{room}.{found}" for found in find_packages(room))]

setup(
    package_dir={"": "src", "deixis.examples": "examples", **{f"deixis.{room}": room for room in ROOMS}},
    packages=packages,
)
