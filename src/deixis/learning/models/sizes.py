"""Sizes of the kinds of things, learned from all lessons, also of kinds that the ontology does not know.

The share of a lesson is its views: things of a known kind, each with its size. They are added to counts by kind, and
removed when the lesson is forgotten (:mod:`deixis.reasoning.grounding.fitting.size_statistics`). A box counts once,
however many lessons show it. The model of a kind is computed from its counts; its prior is the usual size of the kind,
or what all kinds have in common. So a lesson changes only the kinds that it shows, unless the common prior changes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from deixis.learning.lessons.recollection import Remembered
from deixis.ontology.lessons.write import scene_text_iri
from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.rdf.triples import content_key
from deixis.ontology.things.kinds import Kinds, plain_name
from deixis.ontology.things.sizes import Sizes
from deixis.reasoning.grounding.evidence.properties.labels import category_of, classes
from deixis.reasoning.grounding.evidence.properties.sizes import usual_size
from deixis.reasoning.grounding.evidence.properties.unary import log_sizes
from deixis.reasoning.grounding.fitting.size_statistics import BUCKET, SCALE, Distribution, steps
from deixis.reasoning.grounding.fitting.sizes import SizePrior, pool, size_of, usual_prior

FEWEST = 3
"""Minimum number of views that override a usual size. With fewer, one wrong view can move the median freely."""

SURE = 0.9
"""Minimum confidence of a label or match that counts; a median tolerates the tenth that is wrong."""

SETTLED = 64
"""Minimum number of views of all kinds together at which the common prior is rounded.

Without rounding, every lesson would change the model of every kind without a usual size by a negligible amount.
"""

GRAIN = 1 / 32
"""Step to which the common prior is rounded, in logarithms: 3 per cent of a length."""

AXES = ("length", "aspect")


@dataclass(frozen=True, slots=True, order=True)
class SizeView:
    """One thing of a kind in one scene, with its size.

    ``plain`` and ``relative`` are the logarithms of its length and aspect in steps: in metres, and relative to the
    scene. ``box`` identifies its box. Of several views of one box the smallest counts, in the order of these fields.
    """

    kind: str
    box: str
    scene: str
    metric: bool
    plain: tuple[int, int]
    relative: tuple[int, int]

    @property
    def place(self) -> str:
        """Key that views of the same box and kind share."""
        return content_key(f"{self.kind} {self.box}")

    def written(self) -> str:
        """Return the view as a text; :meth:`read` is the inverse.

        Returns
        -------
        str
            The text.
        """
        numbers = (int(self.metric), *self.plain, *self.relative)
        return " ".join((self.kind, self.box, self.scene, *map(str, numbers)))

    @classmethod
    def read(cls, text: str) -> SizeView:
        """Read a view from the text that :meth:`written` returns.

        Parameters
        ----------
        text
            The text.

        Returns
        -------
        SizeView
            The view.
        """
        kind, box, scene, *numbers = text.split(" ")
        metric, *sizes = map(int, numbers)
        return cls(kind, box, scene, bool(metric), (sizes[0], sizes[1]), (sizes[2], sizes[3]))


def size_views(lesson: Remembered, kinds: Kinds) -> list[SizeView]:
    """Return what a lesson adds to the statistics of sizes: a view of each thing whose kind is known.

    Parameters
    ----------
    lesson
        The lesson.
    kinds
        The known kinds.

    Returns
    -------
    list of SizeView
        The views.
    """
    boxes, scene = lesson.scene.boxes, scene_text_iri(lesson.texts[1])
    metric = lesson.scene.unit == "m"
    known = dict.fromkeys([*_matched(lesson), *_labelled(lesson, kinds)])
    if not known:
        return []
    plain, relative = (
        [(steps(length), steps(aspect)) for length, aspect in log_sizes(boxes, by_scene).tolist()]
        for by_scene in (False, True)
    )
    return [
        SizeView(kind, content_key(boxes[thing].tobytes().hex()), scene, metric, plain[thing], relative[thing])
        for kind, thing in known
    ]


def _matched(lesson: Remembered) -> Iterator[tuple[str, int]]:
    matched = lesson.matched
    for kind, thing, decided, sure in zip(
        classes(lesson.description), matched.things, matched.decided, matched.sureness, strict=True
    ):
        if thing is not None and decided and sure >= SURE:
            yield kind, thing


def _labelled(lesson: Remembered, kinds: Kinds) -> Iterator[tuple[str, int]]:
    for place, thing in enumerate(lesson.scene.objects):
        if thing.label and thing.confidence >= SURE:
            senses, _ = kinds.head_noun(plain_name(thing.label))
            yield senses[0].iri if senses else category_of(thing.label), place


# ---- the statistics

Row = dict[str, str]
"""Counts about one thing: values by key."""


class Counts:
    """Rows of counts, read when they are needed, and their changes since then.

    ``value`` reads one key of a row from the store, ``row`` reads all of them.
    """

    def __init__(
        self,
        value: Callable[[str, str], str | None] = lambda name, key: None,
        row: Callable[[str], Row] = lambda name: {},
    ) -> None:
        self._value, self._row = value, row
        self._read: dict[str, dict[str, str | None]] = defaultdict(dict)
        self._now: dict[str, dict[str, str | None]] = defaultdict(dict)
        self._whole: set[str] = set()

    def get(self, name: str, key: str) -> str | None:
        """Return one value, or None.

        Parameters
        ----------
        name
            Name of the row.
        key
            Key in the row.

        Returns
        -------
        str or None
            The value, or None.
        """
        if key not in self._now[name]:
            found = None if name in self._whole else self._value(name, key)
            self._read[name][key] = self._now[name][key] = found
        return self._now[name][key]

    def row(self, name: str) -> Row:
        """Return all values of a row.

        Parameters
        ----------
        name
            Name of the row.

        Returns
        -------
        Row
            Value by key.
        """
        if name not in self._whole:
            for key, value in self._row(name).items():
                self._read[name].setdefault(key, value)
                self._now[name].setdefault(key, value)
            self._whole.add(name)
        return {key: value for key, value in self._now[name].items() if value is not None}

    def set(self, name: str, key: str, value: str | None) -> None:
        """Set one value; None removes it.

        Parameters
        ----------
        name
            Name of the row.
        key
            Key in the row.
        value
            The value; None removes the entry.
        """
        self.get(name, key)
        self._now[name][key] = value

    def add(self, name: str, key: str, number: int) -> int:
        """Add to an integer, which is not stored if it becomes 0.

        Parameters
        ----------
        name
            Name of the row.
        key
            Key in the row.
        number
            Number to add.

        Returns
        -------
        int
            The sum.
        """
        total = int(self.get(name, key) or 0) + number
        self.set(name, key, str(total) if total else None)
        return total

    def changed(self, name: str) -> Iterator[tuple[str, str | None, str | None]]:
        """Yield the keys of a row whose values have changed, with the old value and the new one.

        Parameters
        ----------
        name
            Name of the row.

        Yields
        ------
        tuple
            Key, old value and new value; None stands for no value.
        """
        for key, new in self._now[name].items():
            old = self._read[name].get(key)
            if old != new:
                yield key, old, new

    def difference(self) -> tuple[list[tuple[str, str, str]], list[tuple[str, str, str]]]:
        """Return the removed and the added entries, each as row, key and value.

        Returns
        -------
        tuple
            Removed and added entries.
        """
        every = [
            (name, *entry) for name in sorted(self._now) for entry in sorted(self.changed(name), key=lambda e: e[0])
        ]
        gone = [(name, key, old) for name, key, old, _ in every if old is not None]
        return gone, [(name, key, new) for name, key, _, new in every if new is not None]


@dataclass(frozen=True, slots=True)
class _Used:
    """Summary of the views that a kind's model is computed from: those in metres if they suffice, else all."""

    mode: str | None  # 'm', 'r', or None for too few views
    views: int
    medians: tuple[float, float] = (0.0, 0.0)
    deviations: tuple[float, float] = (0.0, 0.0)


METRES, RELATIVE = "m", "r"


class SizeStatistics:
    """Counts of views by kind, and the models computed from them."""

    def __init__(self, counts: Counts, sizes: Sizes) -> None:
        self._counts, self._sizes = counts, sizes
        self._before: dict[str, _Used] = {}
        self._after: dict[str, _Used] = {}
        self._priors: dict[str, SizePrior | None] | None = None

    def add(self, view: SizeView) -> None:
        """Count a view, unless a smaller one of the same box counts already.

        Parameters
        ----------
        view
            The view.
        """
        counted = self._counts.get("views", view.place)
        if counted is None or view < SizeView.read(counted):
            self._exchange(None if counted is None else SizeView.read(counted), view)

    def remove(self, view: SizeView, others: Iterable[SizeView]) -> None:
        """Remove a view.

        Parameters
        ----------
        view
            The view.
        others
            Views of its box in other lessons, the smallest of which counts instead.
        """
        if self._counts.get("views", view.place) == view.written():
            left = min(others, default=None)
            if left != view:
                self._exchange(view, left)

    def _exchange(self, gone: SizeView | None, come: SizeView | None) -> None:
        some = gone or come
        assert some is not None
        self._touch(some.kind)
        for view, times in ((gone, -1), (come, 1)):
            if view is not None:
                self._count(view, times)
        self._counts.set("views", some.place, None if come is None else come.written())

    def _count(self, view: SizeView, times: int) -> None:
        for mode, values in ((METRES, view.plain), (RELATIVE, view.relative)):
            if mode == RELATIVE or view.metric:
                self._counts.add(f"number/{mode}", view.kind, times)
                self._counts.add(_row("scenes", mode, view.kind), view.scene, times)
                for axis, value in zip(AXES, values, strict=True):
                    self._bucket(_row(axis, mode, view.kind), str(value // BUCKET), times, times * value)

    def _bucket(self, row: str, key: str, count: int, total: int) -> None:
        """Add to the number of views in a bucket, and to the sum of their steps; negative numbers remove views."""
        old_count, old_total = _pair(self._counts.get(row, key))
        value = f"{old_count + count} {old_total + total}" if old_count + count else None
        self._counts.set(row, key, value)

    def _touch(self, kind: str) -> None:
        """Remove a kind from the common prior, before its views change."""
        if self._priors is None:
            self._priors = {mode: self._prior(mode) for mode in (METRES, RELATIVE)}
        if kind not in self._before:
            self._before[kind] = self._used(kind)
            self._pool(kind, self._before[kind], -1)

    def _used(self, kind: str) -> _Used:
        metric, number = (int(self._counts.get(f"number/{mode}", kind) or 0) for mode in (METRES, RELATIVE))
        if not number or (number < FEWEST and usual_size(kind, self._sizes) is not None):
            return _Used(None, number)
        mode = METRES if metric >= FEWEST or metric == number else RELATIVE
        along = [self._distribution(_row(axis, mode, kind)) for axis in AXES]
        medians = tuple(axis.median() for axis in along)
        deviations = tuple(axis.median_deviation(median) for axis, median in zip(along, medians, strict=True))
        return _Used(mode, along[0].size, (medians[0], medians[1]), (deviations[0], deviations[1]))

    def _distribution(self, row: str) -> Distribution:
        return Distribution({int(key): _pair(value) for key, value in self._counts.row(row).items()})

    def _pool(self, kind: str, used: _Used, times: int) -> None:
        """Add the views of a kind to the common prior, or remove them with ``times=-1``."""
        if used.mode is None:
            return
        self._counts.set(f"kinds/{used.mode}", kind, "" if times > 0 else None)
        self._counts.add("pool", f"kinds/{used.mode}", times)
        for axis, median in zip(AXES, used.medians, strict=True):
            own, common = _row(axis, used.mode, kind), _row(axis, used.mode)
            apart = round(self._distribution(own).deviations(median) * SCALE)
            self._counts.add("pool", f"apart/{axis}/{used.mode}", times * apart)
            for key, value in self._counts.row(own).items():
                count, total = _pair(value)
                self._bucket(common, key, times * count, times * total)

    def _prior(self, mode: str) -> SizePrior | None:
        """Return the prior that all kinds have in common, or None without any kind."""
        kinds = int(self._counts.get("pool", f"kinds/{mode}") or 0)
        if not kinds:
            return None
        along = [self._distribution(_row(axis, mode)) for axis in AXES]
        centre = np.array([axis.median() for axis in along])
        off = np.array([axis.deviations(middle) for axis, middle in zip(along, centre.tolist(), strict=True)])
        apart = [int(self._counts.get("pool", f"apart/{axis}/{mode}") or 0) / SCALE for axis in AXES]
        found = pool(centre, off, np.array(apart), along[0].size, kinds)
        if along[0].size < SETTLED:
            return found
        centre, between, within = (
            np.round(part / GRAIN) * GRAIN for part in (found.centre, found.between, found.within)
        )
        return SizePrior(centre, np.maximum(between, GRAIN), np.maximum(within, GRAIN))

    def settle(self) -> None:
        """Add the changed kinds to the common prior; call it once, after all views are in."""
        self._after = {kind: self._used(kind) for kind in self._before}
        for kind, used in self._after.items():
            self._pool(kind, used, 1)

    def models(self) -> dict[str, tuple[SizeModel | None, set[str], set[str]]]:
        """Return the changed models by kind; call this after :meth:`settle`.

        Returns
        -------
        dict
            The model or None, the scenes that are gone, and the new ones, by class IRI.
        """
        if self._priors is None:
            return {}
        priors = {mode: self._prior(mode) for mode in (METRES, RELATIVE)}
        found = {kind: self._model(kind, priors, *self._scenes(kind)) for kind in self._before}
        for mode, prior in priors.items():
            if not _same(prior, self._priors[mode]):
                for kind in self._counts.row(f"kinds/{mode}"):
                    if kind not in found and (mode == RELATIVE or usual_size(kind, self._sizes) is None):
                        found[kind] = self._model(kind, priors, set(), set())
        return found

    def _model(
        self, kind: str, priors: Mapping[str, SizePrior | None], gone: set[str], come: set[str]
    ) -> tuple[SizeModel | None, set[str], set[str]]:
        used = self._after.get(kind) or self._used(kind)
        if used.mode is None:
            return None, gone, come
        usual = usual_size(kind, self._sizes) if used.mode == METRES else None
        prior = usual_prior(usual) if usual is not None else priors[used.mode]
        assert prior is not None
        medians, deviations = np.array(used.medians), np.array(used.deviations)
        return size_of(used.views, medians, deviations, prior, used.mode == RELATIVE), gone, come

    def _scenes(self, kind: str) -> tuple[set[str], set[str]]:
        """Return the scenes that a kind's model is no longer derived from, and those that it is newly derived from."""
        old, new = self._before[kind].mode, self._after[kind].mode
        rows = {mode: _row("scenes", mode, kind) for mode in (old, new) if mode is not None}
        changed = {mode: list(self._counts.changed(row)) for mode, row in rows.items()}
        if old == new:
            entries = changed.get(new, []) if new is not None else []
            return {key for key, _, now in entries if now is None}, {key for key, was, _ in entries if was is None}
        whole = {mode: set(self._counts.row(row)) for mode, row in rows.items()}
        come = whole[new] if new is not None else set()
        gone = set[str]()
        if old is not None:
            new_ones = {key for key, was, _ in changed[old] if was is None}
            gone = whole[old] - new_ones | {key for key, _, now in changed[old] if now is None}
        return gone - come, come - gone


def _row(what: str, mode: str, kind: str = "") -> str:
    return f"{what}/{mode}/{kind}" if kind else f"{what}/{mode}"


def _pair(value: str | None) -> tuple[int, int]:
    count, _, total = (value or "0 0").partition(" ")
    return int(count), int(total)


def _same(one: SizePrior | None, other: SizePrior | None) -> bool:
    if one is None or other is None:
        return one is other
    pairs = ((one.centre, other.centre), (one.between, other.between), (one.within, other.within))
    return all(np.array_equal(a, b) for a, b in pairs)
