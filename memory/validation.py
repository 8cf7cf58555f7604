from __future__ import annotations
import pyoxigraph as ox
from deixis.memory.change import Change


def check_change(store: ox.Store, change: Change) -> None:
    return None


def check_store(store: ox.Store) -> None:
    return None
