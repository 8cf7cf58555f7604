"""Taking views back where what they were kept for could not be kept too."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence

from deixis.errors import DeixisError
from deixis.memory.errors import MemoryWriteError
from deixis.memory.perceptual.protocol import PerceptualMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View


@contextlib.contextmanager
def restored_on_failure(memory: PerceptualMemory, views: Sequence[View]) -> Iterator[None]:
    """Puts views that are kept within, and their categories, back as they were where something within fails.

    Other threads cannot write meanwhile. A view that was damaged before is gone then. Raises MemoryWriteError, with
    what had failed, where the memory cannot be put back.
    """
    with memory.exclusive():
        there = set(memory.categories())
        before = [view for view in (_view(memory, view.id) for view in views) if view is not None]
        names = {view.category for view in (*views, *before)} & there
        records = [record for record in (_record(memory, name) for name in sorted(names)) if record is not None]
        try:
            yield
        except BaseException as failure:
            old = {view.id for view in before}
            new = [view.id for view in views if view.id not in old and _view(memory, view.id) is not None]
            try:
                memory.write(Batch(before, records, new))
                for name in {view.category for view in views} & set(memory.categories()) - there:
                    memory.forget(name)
            except DeixisError as error:
                told = f"{failure}; what the things look like stays kept all the same: {error}"
                raise MemoryWriteError(told) from failure
            raise


def _view(memory: PerceptualMemory, id: str) -> View | None:
    with contextlib.suppress(DeixisError):
        return memory.view(id)
    return None


def _record(memory: PerceptualMemory, name: str) -> CategoryRecord | None:
    with contextlib.suppress(DeixisError):
        return memory.category(name)
    return None
