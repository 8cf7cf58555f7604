"""Build a cloud from the named columns of a PCD or PLY file."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError

POINT = ("x", "y", "z")
NORMALS = (("normal_x", "normal_y", "normal_z"), ("nx", "ny", "nz"))
COLOURS = (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"))
PACKED = ("rgb", "rgba")
"""Names of columns with a colour in 32 bits, 0xAARRGGBB, of any declared type."""
LABEL = "label"

KNOWN = frozenset((*POINT, *sum(NORMALS, ()), *sum(COLOURS, ()), *PACKED, LABEL))
"""Names of all columns that are read; other columns are skipped."""

Columns = Mapping[str, NDArray[np.generic]]


def cloud_of_columns(
    columns: Columns,
    file: str,
    organised: tuple[int, int] | None = None,
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> PointCloud:
    """Return the cloud of columns in their declared types.

    Parameters
    ----------
    columns
        Arrays of shape (n,) by name: x, y, z and others.
    file
        Name of the file, for messages.
    organised
        Rows and columns of an organised cloud, or None.
    origin
        Position of the sensor, in metres.

    Returns
    -------
    PointCloud
        A cloud of n points.

    Raises
    ------
    CloudError
        If a coordinate is missing.

    Examples
    --------
    >>> one, four = np.ones(1), np.array([0x0000FF80], np.uint32)
    >>> cloud_of_columns({"x": one, "y": one, "z": one, "rgb": four}, "a.pcd").colours.tolist()
    [[0, 255, 128]]
    """
    missing = [name for name in POINT if name not in columns]
    if missing:
        raise CloudError(f"{file}: there is no column '{missing[0]}'; add the columns x, y and z, with one value each")
    normals = next((names for names in NORMALS if all(name in columns for name in names)), None)
    return PointCloud(
        side_by_side(columns, POINT),
        _colours(columns, file),
        None if LABEL not in columns else labels_of(columns[LABEL], file),
        None if normals is None else side_by_side(columns, normals),
        organised,
        origin,
    )


def side_by_side(columns: Columns, names: tuple[str, ...]) -> NDArray[np.float32]:
    """Return the named columns as one array of shape (n, columns), in single precision.

    Parameters
    ----------
    columns
        Arrays of shape (n,) by name.
    names
        Names of the wanted columns, in order.

    Returns
    -------
    ndarray
        Array of shape (n, columns).
    """
    out = np.empty((len(columns[names[0]]), len(names)), np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        for place, name in enumerate(names):
            out[:, place] = columns[name]
    return out


def single(values: NDArray[np.generic]) -> NDArray[np.float32]:
    """Return numbers in single precision; numbers too large for it become infinite.

    Parameters
    ----------
    values
        Numbers of any type.

    Returns
    -------
    ndarray
        Numbers of the same shape.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return values.astype(np.float32)


def declared(values: NDArray[np.float64], kind: np.dtype[np.generic], name: str, file: str) -> NDArray[np.generic]:
    """Return numbers that were read as text in their declared type.

    Parameters
    ----------
    values
        The numbers.
    kind
        Their declared type.
    name
        Name of the column, for messages.
    file
        Name of the file, for messages.

    Returns
    -------
    ndarray
        The numbers, of the same shape.

    Raises
    ------
    CloudError
        If a number does not fit the type.
    """
    if kind.kind == "f":
        with np.errstate(over="ignore"):
            return values.astype(kind)
    limits = np.iinfo(kind.str)
    with np.errstate(invalid="ignore"):
        whole = values.astype(kind)
    # As a double, the largest 64-bit integer rounds up to a power of two that no longer fits.
    inside = not len(values) or (values.min() >= float(limits.min) and values.max() < float(limits.max) + 1)
    if not (inside and (whole == values).all()):
        fits = (values >= float(limits.min)) & (values < float(limits.max) + 1) & (values == np.floor(values))
        row = int(np.argmin(fits))
        raise CloudError(
            f"{file}: point {row}: '{name}' must be a whole number from {limits.min} to {limits.max}, got"
            f" {values[row]:g}; correct it, or the type of the column"
        )
    return whole


def _colours(columns: Columns, file: str) -> NDArray[np.uint8] | None:
    for name in PACKED:
        if name in columns and columns[name].dtype.itemsize == 4:
            bits = np.ascontiguousarray(columns[name]).astype(columns[name].dtype.newbyteorder("<")).view("<u4")
            return np.ascontiguousarray(bits.view(np.uint8).reshape(-1, 4)[:, 2::-1])
    names = next((names for names in COLOURS if all(name in columns for name in names)), None)
    return None if names is None else as_bytes(np.stack([columns[name] for name in names], axis=1), file)


def as_bytes(colours: NDArray[np.generic], file: str, whole: bool = False) -> NDArray[np.uint8]:
    """Return colours as bytes.

    Parameters
    ----------
    colours
        Colours of shape (n, 3): integers from 0 to 255, or floats from 0 to 1.
    file
        Name of the file, for messages.
    whole
        True if floats range from 0 to 255, too.

    Returns
    -------
    ndarray
        Colours of shape (n, 3).

    Raises
    ------
    CloudError
        If a colour is out of range.
    """
    if colours.dtype == np.uint8:
        return colours.astype(np.uint8, copy=False)
    whole = whole or colours.dtype.kind in "iu"
    values = colours.astype(np.float64)
    wrong = ~((values >= 0) & (values <= (255 if whole else 1))).all(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        shown = ", ".join(f"{value:g}" for value in values[row])
        allowed = "from 0 to 255" if whole else "from 0 to 1, because they are not whole numbers"
        raise CloudError(f"{file}: point {row}: red, green and blue must be {allowed}, got {shown}; correct them")
    return np.rint(values if whole else values * 255).astype(np.uint8)


def labels_of(column: NDArray[np.generic], file: str) -> NDArray[np.int32]:
    """Return labels in 32 bits; an unsigned 4294967295, which means "no label" in some files, becomes -1.

    Parameters
    ----------
    column
        Labels of shape (n,).
    file
        Name of the file, for messages.

    Returns
    -------
    ndarray
        Labels of shape (n,).

    Raises
    ------
    CloudError
        If a label does not fit 32 bits.
    """
    if column.dtype.kind in "iu" and column.dtype.itemsize <= 4:
        return column.astype(np.int32)
    values = column.astype(np.float64)
    fits = (values >= -(2**31)) & (values < 2**32) & (values == np.floor(values))
    if not fits.all():
        row = int(np.argmin(fits))
        raise CloudError(
            f"{file}: point {row}: label must be a whole number of 32 bits, got {values[row]:g}; renumber it"
        )
    return values.astype(np.int64).astype(np.uint32).view(np.int32)
