"""Compiles every kernel once, so that no command waits for it: ``python -m deixis.kernels`` after an installation."""

from __future__ import annotations


def compile_kernels() -> None:
    """Runs one tiny job of each kind; the compiled code is kept on disk, and so are the reasoners' classes."""
    from deixis.reasoning.kernel import load_compiled
    from deixis.workflows.ground import ready_to_ground
    from deixis.workflows.imagine import ready_to_imagine
    from deixis.workflows.infer import ready_to_infer
    from deixis.workflows.solve import ready_to_solve

    load_compiled()
    for engine in ("exact", "scalable"):
        ready_to_ground(engine)
    ready_to_infer()
    ready_to_solve()
    _tell_time()
    ready_to_imagine()
    _reason()
    _read_clouds()
    compile_detection()
    compile_features()
    compile_recognition()


def _tell_time() -> None:
    from deixis.grammar.formats.fluents import parse_fluents
    from deixis.reasoning.temporal.timeline import Timeline

    fluents = ",".join(f'{{"id": "{id}", "statement": ["cup", "on", "table"]}}' for id in "ab")
    relations = '{"a": "a", "allen": ["before", "after"], "b": "b"}'
    content = parse_fluents(f'{{"origin": "now", "fluents": [{fluents}], "relations": [{relations}]}}', "warm")
    timeline = Timeline()
    for item in (*content.fluents, *content.relations):
        timeline.add(item)
    timeline.chronology()
    timeline.explain_bound("a.start", "a.finish")


def _reason() -> None:
    import pyoxigraph as ox

    from deixis.ontology.tbox import tbox_turtle
    from deixis.reasoning.description_logic.reasoners import Reasoner, prepare

    triples = (quad.triple for quad in ox.parse(tbox_turtle(), format=ox.RdfFormat.TURTLE))
    text = (ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode("utf-8")
    for reasoner in Reasoner:
        prepare(reasoner, text)


def _read_clouds() -> None:
    import tempfile
    from pathlib import Path

    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.clouds.cloud_file import read_cloud, write_cloud

    cloud = PointCloud(np.array([[0, 0, 1], [0, 1, 1]], np.float32))
    with tempfile.TemporaryDirectory() as folder:
        for encoding in ("ascii", "binary_compressed"):
            write_cloud(Path(folder) / "cloud.pcd", cloud, encoding)
            read_cloud(Path(folder) / "cloud.pcd")
        write_cloud(Path(folder) / "cloud.ply", cloud)
        read_cloud(Path(folder) / "cloud.ply")


def compile_detection() -> None:
    """Detects a block on a table, as an image and as bare points."""
    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.detection.detect import detect

    x_and_y = np.mgrid[-0.3:0.3:0.01, 0.5:1.1:0.01]
    x, y = x_and_y.reshape(2, -1)
    block = (abs(x) < 0.05) & (abs(y - 0.8) < 0.05)
    points = np.stack([x, y, np.where(block, -0.64, -0.7)], axis=1)
    detect(PointCloud(points.astype(np.float32)))
    detect(PointCloud(points.astype(np.float32), organised=x_and_y.shape[1:]))


def compile_features() -> None:
    """Describes a tiny view in every way that has a kernel."""
    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.features.keypoints import voxel_keypoints
    from deixis.perception.features.normals import estimate_normals
    from deixis.perception.features.spin_images import SpinImageDescriber, spin_images

    side = np.linspace(0.0, 0.05, 6)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    cloud = PointCloud(np.stack([x, y, 1.0 + x * y], axis=1).astype(np.float32))
    SpinImageDescriber().describe(cloud)
    normals, keypoints = estimate_normals(cloud.points, neighbours=5), voxel_keypoints(cloud.points, 0.05)
    spin_images(cloud.points, normals, keypoints, support=0.05, min_points=1, angular=True, threads=1)


def compile_recognition() -> None:
    """Recognises a tiny view; views mapped from a file have a signature of their own."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from deixis.perception.recognition.distances import Target
    from deixis.perception.recognition.index import Effort, ViewIndex
    from deixis.perception.recognition.instances import InstanceCategory
    from deixis.perception.recognition.views import open_views, write_views

    views = [(str(i), np.full((2, 3), i, np.float32)) for i in range(3)]
    category, target = InstanceCategory.of("warm", views), Target.of(views[0][1])
    with tempfile.TemporaryDirectory() as folder:
        write_views(Path(folder) / "views", views)
        for pack in (category.views, open_views(Path(folder) / "views")):
            index = ViewIndex.of(pack)
            reduced = index.reduction(target.descriptors)
            for effort in (None, Effort()):
                index.nearest(target, reduced, effort)


if __name__ == "__main__":
    compile_kernels()
