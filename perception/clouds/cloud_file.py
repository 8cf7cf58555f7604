"""Read point clouds from files of any supported format, and write them."""

from __future__ import annotations

from pathlib import Path

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import content_of
from deixis.perception.clouds.depth import PNG, Intrinsics, read_depth, read_intrinsics
from deixis.perception.clouds.formats.npy import MAGIC, read_npz_cloud
from deixis.perception.clouds.formats.pcd import read_pcd
from deixis.perception.clouds.formats.ply import read_ply
from deixis.perception.clouds.formats.writing import pcd_bytes, ply_bytes
from deixis.perception.clouds.formats.xyz import read_xyz
from deixis.perception.errors import CloudError

TEXT = frozenset({".xyz", ".xyzn", ".xyzrgb", ".txt", ".csv", ".asc", ".pts"})
"""Suffixes of plain tables of points; the first bytes of a file identify all other formats."""
_ZIP = b"PK\x03\x04"


def read_cloud(path: str | Path, intrinsics: str | Path | Intrinsics | None = None) -> PointCloud:
    """Read a PCD, PLY, XYZ or NPZ file, or a depth image together with the intrinsics of its camera.

    The size of the file bounds the memory that is used, whatever its header declares.

    Parameters
    ----------
    path
        File of a point cloud, or a depth image (PNG, .npy or .npz).
    intrinsics
        Camera of a depth image, or the JSON file that describes it; None for all other files.

    Returns
    -------
    The points in metres, in the order of the file. A point without depth keeps its row, with coordinates that are not
    finite.

    Raises
    ------
    CloudError
        If the file is not a point cloud or is damaged; the message names the file and the place in it.
    """
    content = content_of(path)
    head = content.data[:8].tobytes()
    if intrinsics is not None:
        if not head.startswith((PNG, MAGIC, _ZIP)):
            raise CloudError(f"{content.name}: not a depth image (PNG, .npy, .npz); leave the intrinsics out")
        camera = intrinsics if isinstance(intrinsics, Intrinsics) else read_intrinsics(intrinsics)
        return read_depth(content, camera)
    if head.startswith((PNG, MAGIC)):
        raise CloudError(f"{content.name}: a depth image needs the intrinsics of its camera; give them too")
    suffix = Path(path).suffix.lower()
    if head.startswith((b"ply\n", b"ply\r")) or suffix == ".ply":
        return read_ply(content)
    if head.startswith(_ZIP) or suffix == ".npz":
        return read_npz_cloud(content)
    if head.startswith((b"# .PCD", b"VERSION", b"FIELDS")) or suffix == ".pcd":
        return read_pcd(content)
    if suffix in TEXT:
        return read_xyz(content)
    raise CloudError(f"{content.name}: unknown format; give a PCD, PLY, XYZ or NPZ file, or a depth image")


def write_cloud(path: str | Path, cloud: PointCloud, encoding: str = "binary") -> None:
    """Write a cloud as PCD or PLY, depending on the suffix of the file.

    Parameters
    ----------
    path
        File to write, ending in ``.pcd`` or ``.ply``.
    cloud
        Points, with their colours, labels and normals.
    encoding
        ``ascii``, ``binary``, or for PCD also ``binary_compressed``.

    Raises
    ------
    CloudError
        If the suffix or the encoding is unknown, or the file cannot be written.
    """
    pieces = {".pcd": pcd_bytes, ".ply": ply_bytes}.get(Path(path).suffix.lower())
    if pieces is None:
        raise CloudError(f"{path}: the suffix must be .pcd or .ply, got '{Path(path).suffix}'; rename the file")
    try:
        whole = list(pieces(cloud, encoding))
    except CloudError as error:
        raise CloudError(f"{path}: {error}") from None
    try:
        with Path(path).open("wb") as file:
            file.writelines(whole)
    except OSError as error:
        raise CloudError(f"{path}: cannot be written: {error.strerror}") from error
