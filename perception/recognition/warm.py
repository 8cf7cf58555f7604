"""Compiles the kernels of this package once; the compiled code is kept on disk."""

from __future__ import annotations


def warm() -> None:
    """Recognises a tiny view; views mapped from a file have a signature of their own."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from deixis.perception.recognition.distances import Target
    from deixis.perception.recognition.index import ViewIndex
    from deixis.perception.recognition.instances import InstanceCategory
    from deixis.perception.recognition.inverted import Effort
    from deixis.perception.recognition.view_file import open_views, write_views

    views = [(str(i), np.full((2, 3), i, np.float32)) for i in range(3)]
    category, target = InstanceCategory.of("warm", views), Target.of(views[0][1])
    with tempfile.TemporaryDirectory() as folder:
        write_views(Path(folder) / "views", views)
        for pack in (category.views, open_views(Path(folder) / "views")):
            index = ViewIndex.of(pack)
            reduced = index.reduction(target.descriptors)
            for effort in (None, Effort()):
                index.nearest(target, reduced, effort)
