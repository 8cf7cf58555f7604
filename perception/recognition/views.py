"""Views as sets of descriptors, many of them in one piece of memory.

>>> views = PackedViews.of([("a", np.zeros((2, 3), np.float32)), ("b", np.ones((1, 3), np.float32))])
>>> len(views), views.size, views[1].tolist()
(2, 3, [[1.0, 1.0, 1.0]])
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError

LARGEST = 1e15
"""Numbers in a descriptor are below this, so that no square overflows in single precision."""


@dataclass(frozen=True, eq=False)
class PackedViews:
    """m views; view i has the descriptors from ``starts[i]`` to ``starts[i + 1]``, one at least.

    ``descriptors`` may be mapped from a file (:mod:`deixis.perception.recognition.view_file`).
    """

    ids: tuple[str, ...]
    descriptors: NDArray[np.float32]  # (n, d)
    starts: NDArray[np.int64]  # (m + 1,)

    @classmethod
    def of(cls, views: Iterable[tuple[str, NDArray[np.float32]]]) -> PackedViews:
        """Views by id, each with its descriptors (k, d); raises RecognitionError for what :func:`checked` refuses."""
        named = list(views)
        ids = tuple(name for name, _ in named)
        if not named:
            return cls((), np.empty((0, 0), np.float32), np.zeros(1, np.int64))
        _require_distinct(ids)
        size = named[0][1].shape[-1]
        arrays = [checked(f"view '{name}'", array, size) for name, array in named]
        if not all(map(len, arrays)):
            empty = next(name for name, array in named if not len(array))
            raise RecognitionError(f"view '{empty}' has no descriptor: there is nothing to compare")
        return cls(ids, np.concatenate(arrays), _starts([len(array) for array in arrays]))

    def __len__(self) -> int:
        return len(self.ids)

    def __getitem__(self, place: int) -> NDArray[np.float32]:
        """The descriptors (k, d) of the view in that place."""
        return self.descriptors[self.starts[place] : self.starts[place + 1]]

    @property
    def size(self) -> int:
        """Numbers in a descriptor; 0 where there is no view."""
        return int(self.descriptors.shape[1])

    @cached_property
    def squares(self) -> NDArray[np.float32]:
        """Squared lengths (n,) of the descriptors."""
        return squared_lengths(self.descriptors).astype(np.float32)

    def joined(self, others: PackedViews) -> PackedViews:
        """These views and then the others."""
        if not len(self) or not len(others):
            return self if len(self) else others
        _require_distinct((*self.ids, *others.ids))
        if self.size != others.size:
            raise RecognitionError(f"descriptors of {others.size} numbers do not fit those of {self.size}")
        starts = np.concatenate([self.starts, others.starts[1:] + self.starts[-1]])
        return PackedViews((*self.ids, *others.ids), np.concatenate([self.descriptors, others.descriptors]), starts)

    def without(self, place: int) -> PackedViews:
        """All views but the one in that place."""
        rest = [(name, self[i]) for i, name in enumerate(self.ids) if i != place]
        return PackedViews.of(rest)


def checked(what: str, descriptors: NDArray[np.float32], size: int) -> NDArray[np.float32]:
    """Descriptors (k, size) as they are compared: float32, in one piece, and finite; k may be 0."""
    if not isinstance(descriptors, np.ndarray) or descriptors.ndim != 2 or descriptors.shape[1] != size:
        found = getattr(descriptors, "shape", type(descriptors).__name__)
        raise RecognitionError(f"{what}: descriptors of shape (k, {size}) are wanted, not {found}")
    if size < 1 or descriptors.dtype.kind not in "fiu":
        raise RecognitionError(f"{what}: descriptors are rows of one number or more, not {descriptors.dtype} ({size})")
    if not (np.abs(descriptors) < LARGEST).all():
        raise RecognitionError(f"{what}: a descriptor holds a number that is not finite, or above {LARGEST:g}")
    return np.ascontiguousarray(descriptors, np.float32)


def squared_lengths(descriptors: NDArray[np.float32]) -> NDArray[np.float64]:
    """Squared lengths (n,), summed in double precision."""
    result: NDArray[np.float64] = np.einsum("ij,ij->i", descriptors, descriptors, dtype=np.float64)
    return result


def _starts(lengths: Sequence[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)


def _require_distinct(ids: Sequence[str]) -> None:
    if len(set(ids)) < len(ids):
        twice = next(name for name in ids if list(ids).count(name) > 1)
        raise RecognitionError(f"the view '{twice}' comes twice")
