"""Clouds as files: one way to read them, whatever their format, and one to write them."""

from __future__ import annotations

from pathlib import Path

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import content_of
from deixis.perception.clouds.depth import PNG, Intrinsics, read_depth, read_intrinsics
from deixis.perception.clouds.npy import MAGIC, read_npz_cloud
from deixis.perception.clouds.pcd import read_pcd
from deixis.perception.clouds.ply import read_ply
from deixis.perception.clouds.writing import pcd_bytes, ply_bytes
from deixis.perception.clouds.xyz import read_xyz
from deixis.perception.errors import CloudError

TEXT = frozenset({".xyz", ".xyzn", ".xyzrgb", ".txt", ".csv", ".asc", ".pts"})
"""Suffixes of plain tables of points; all other formats are told by how a file begins."""
_ZIP = b"PK\x03\x04"


def read_cloud(path: str | Path, intrinsics: str | Path | Intrinsics | None = None) -> PointCloud:
    """Read a PCD, PLY, XYZ or NPZ file, or a depth image together with its camera's ``intrinsics``.

    A point without depth stays in its place with a coordinate that is not finite. Memory is bounded by what the file's
    size can justify. Raises CloudError, with the file and the place in it, where it is no cloud or is damaged.
    """
    content = content_of(path)
    head = content.data[:8].tobytes()
    if intrinsics is not None:
        if not head.startswith((PNG, MAGIC, _ZIP)):
            raise CloudError(f"{content.name}: this is no depth image (PNG, .npy, .npz); leave its intrinsics out")
        camera = intrinsics if isinstance(intrinsics, Intrinsics) else read_intrinsics(intrinsics)
        return read_depth(content, camera)
    if head.startswith((PNG, MAGIC)):
        raise CloudError(f"{content.name}: a depth image becomes a cloud by its camera's intrinsics; give them too")
    suffix = Path(path).suffix.lower()
    if head.startswith((b"ply\n", b"ply\r")) or suffix == ".ply":
        return read_ply(content)
    if head.startswith(_ZIP) or suffix == ".npz":
        return read_npz_cloud(content)
    if head.startswith((b"# .PCD", b"VERSION", b"FIELDS")) or suffix == ".pcd":
        return read_pcd(content)
    if suffix in TEXT:
        return read_xyz(content)
    raise CloudError(f"{content.name}: this is no format that is read; PCD, PLY, XYZ, NPZ and depth images are")


def write_cloud(path: str | Path, cloud: PointCloud, encoding: str = "binary") -> None:
    """Write PCD (``ascii``, ``binary`` or ``binary_compressed``) or PLY (``ascii`` or ``binary``), by the suffix.

    Raises CloudError where the suffix or the encoding is another, or the file cannot be written.
    """
    pieces = {".pcd": pcd_bytes, ".ply": ply_bytes}.get(Path(path).suffix.lower())
    if pieces is None:
        raise CloudError(f"{path}: clouds are written as .pcd or .ply; give the file such a suffix")
    try:
        whole = list(pieces(cloud, encoding))
    except CloudError as error:
        raise CloudError(f"{path}: {error}") from None
    try:
        with open(path, "wb") as file:
            file.writelines(whole)
    except OSError as error:
        raise CloudError(f"{path}: cannot be written: {error.strerror}") from error
