"""Read XYZ: plain text, one point per line, columns separated by blanks, commas or semicolons; # and // begin comments.

Three columns are x, y and z. A fourth, an intensity, is skipped. Columns 4 to 6 of six are red, green and blue, from 0
to 1 if none is above 1, else from 0 to 255; in a file with the suffix ``.xyzn`` they are a normal.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from deixis.perception.checks import shown
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.tables.columns import as_bytes, single
from deixis.perception.clouds.tables.number_table import read_table
from deixis.perception.errors import CloudError

WIDTHS = (3, 4, 6)
_SEPARATORS = b",;"


def read_xyz(content: Content) -> PointCloud:
    """Return the cloud of a text file.

    Parameters
    ----------
    content
        The file.

    Returns
    -------
    PointCloud
        The cloud.

    Raises
    ------
    CloudError
        If the file is malformed or has no point; the message has the line.
    """
    from deixis.perception.clouds.tables.table_kernels import row_start

    blank = content.data.copy()
    for separator in _SEPARATORS:
        blank[blank == separator] = ord(" ")
    plain = Content(content.name, blank)
    start = row_start(blank, 0)
    line = content.data[start : start + 1024].tobytes().split(b"\n")[0]
    words = re.split(r"[\s,;]+", line.decode("latin-1").strip())
    where = f"{content.name}:{content.line_of(start)}"
    if words == [""]:
        raise CloudError(f"{where}: there is no point in this file; write one point per line: x y z")
    if len(words) not in WIDTHS:
        raise CloudError(
            f"{where}: a line must have x y z, x y z intensity, or x y z red green blue, got {len(words)} columns"
            f" beginning '{shown(words[0])}'; correct it"
        )
    width = len(words)
    chosen = [0, 1, 2, 3, 4, 5] if width == 6 else [0, 1, 2]
    table = read_table(plain, start, None, width, chosen).columns
    points, more = single(table[:, :3]), table[:, 3:]
    if width != 6:
        return PointCloud(points)
    if Path(content.name).suffix.lower() == ".xyzn":
        return PointCloud(points, normals=single(more))
    whole = bool((more > 1).any() and (more == np.floor(more)).all())
    return PointCloud(points, as_bytes(more, content.name, whole))
