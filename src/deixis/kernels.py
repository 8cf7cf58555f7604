"""Compile every kernel once, so that no command waits for it: ``python -m deixis.kernels`` after an installation.

Python's own bytecode is written too: pip writes it for installed packages, but not for a checkout.
"""

from __future__ import annotations


def compile_kernels() -> None:
    """Run one tiny job of each kind, so that compiled code and the reasoners' classes are kept on disk."""
    from deixis.reasoning.kernel import keeping_machine_code

    with keeping_machine_code():  # of commands that a person waits for in a loop
        for engine in ("exact", "scalable"):
            compile_grounding(engine)
    compile_inference()
    compile_solving()
    _tell_time()
    compile_imagining()
    _reason()
    _read_clouds()
    compile_detection()
    compile_features()
    compile_recognition()
    _write_bytecode()


def _write_bytecode() -> None:
    """Write the bytecode of Deixis, whose folder may hold links to packages, where the folder can be written."""
    import compileall
    import sys

    packages = [
        module for name, module in sys.modules.items() if name == "deixis" or name.rpartition(".")[0] == "deixis"
    ]
    for folder in {folder for package in packages for folder in getattr(package, "__path__", ())}:
        compileall.compile_dir(folder, quiet=2)


def compile_grounding(engine: str) -> None:
    """Compile, or load compiled, the kernels of grounding with one engine, including chains for many objects.

    Parameters
    ----------
    engine
        Name of the engine.

    Raises
    ------
    UnknownTermError
        If no engine has that name.
    """
    from deixis.deadline import Deadline
    from deixis.grammar.layout.parser import parse_script
    from deixis.reasoning.entailment.conflict import find_conflict
    from deixis.reasoning.entailment.implications import Implications
    from deixis.reasoning.geometry.pairs import Surroundings
    from deixis.reasoning.grounding.engines.registry import engine_named
    from deixis.reasoning.grounding.evidence.evidence import evidence_from
    from deixis.reasoning.grounding.ground import ground
    from deixis.reasoning.grounding.matching.posterior import ladders
    from deixis.reasoning.grounding.matching.search import exact
    from deixis.reasoning.kernel import load_compiled
    from deixis.workflows.layouts.read import as_scene

    load_compiled()
    chosen = engine_named(engine)
    boxes = [{"id": f"o{i}", "min": [0.2 * i, 0], "max": [0.2 * i + 0.1, 0.1]} for i in range(3)]
    script = parse_script("fork left of plate\nknife right of plate\n")
    find_conflict(Implications(script.graph()))
    scene = as_scene({"frame": "table", "viewpoint": "chair", "unit": "m", "objects": boxes})
    known, seen = script.ontology, scene.relations(script.ontology.relations)
    evidence = evidence_from(script.graph(), seen, [None] * len(boxes), known.kinds, known.sizes)
    ground(evidence, chosen, Deadline.after(3600.0))
    exact.warm()
    ladders.warm()
    Surroundings.of(scene.boxes, scene.boxes).block(slice(0, 1), slice(1, 3))


def compile_inference() -> None:
    """Compile, or load compiled, the search over facts with more than one reading."""
    from deixis.grammar.layout.parser import parse_script
    from deixis.reasoning.constraints.difference import ORDERS, ZERO, Difference, DifferenceNetwork
    from deixis.reasoning.entailment.why_not import why_not
    from deixis.reasoning.kernel import load_compiled
    from deixis.workflows.layouts.infer import inference_of

    load_compiled()
    inference = inference_of(parse_script("a left of b\nb left or above c\nc is not right of d\n"))
    inference.inferred()
    inference.implications.unstated()
    inference.implications.ntriples()
    relations = inference.implications.vocabulary
    why_not(inference.implications, parse_script("a left of c").facts[0])
    inference.implications.derive(relations["left"], "a", "b")
    orders = DifferenceNetwork(points=2, dtype=ORDERS)
    orders.add(Difference(0, 0, 1, ZERO))
    orders.path(0, 0, 1)  # needed by a search that backtracks
    inference_of(parse_script("a left of b\nb left of a\n"))


def compile_solving(wide: bool = True) -> None:
    """Compile, or load compiled, closure and search, over plain calculi and over products.

    Parameters
    ----------
    wide
        True to include the loops for calculi of more than 16 atoms.
    """
    from deixis.grammar.formats.networks import parse_networks
    from deixis.reasoning.kernel import load_compiled
    from deixis.reasoning.qualitative.calculi.registry import calculus
    from deixis.reasoning.qualitative.networks.network import Constraint, Network
    from deixis.reasoning.qualitative.networks.search.wide_search import WideSearch
    from deixis.workflows.reasoning.solve import SolveRequest, solve_text

    load_compiled()
    requests = (SolveRequest(scenario=True), SolveRequest(closure=True, explain=(0, 1)))
    against = "2 #\n0 1 ( < )\n1 2 ( < )\n0 2 ( > )\n.\n"
    texts = [("allen", "1 #\n0 1 ( < > )\n.\n"), ("ra", "2 #\n0 1 ( <,m >,< )\n1 2 ( <,< )\n.\n"), ("allen", against)]
    if wide:
        texts.append(("direction-distance", "1 #\n0 1 ( N,near S,near )\n.\n"))
        joint = calculus("direction-distance")
        WideSearch(Network(joint, 2, (Constraint(0, 1, joint.universal),))).run()
    for name, text in texts:
        for parsed in parse_networks(text, [calculus(name)], "warm"):
            for request in requests:
                solve_text(parsed, request)


def compile_imagining() -> None:
    """Compile, or load compiled, the kernels that place the objects of an imagined table."""
    from deixis.grammar.layout.parser import parse_script
    from deixis.reasoning.kernel import load_compiled
    from deixis.workflows.layouts.imagine import imagine

    load_compiled()
    imagine(parse_script("fork left of plate\nnapkin on plate\n"))


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
    """Detect a printed block on a table, in an image and in bare points."""
    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.detection.detect import detect

    x_and_y = np.mgrid[-0.3:0.3:0.01, 0.5:1.1:0.01]
    x, y = x_and_y.reshape(2, -1)
    block = (abs(x) < 0.05) & (abs(y - 0.8) < 0.05)
    points = np.stack([x, y, np.where(block, -0.64, -0.7)], axis=1).astype(np.float32)
    print_on_it = (abs(x) < 0.03) & (abs(y - 0.8) < 0.04)
    colours = np.where(print_on_it[:, None], (200, 30, 30), (200, 200, 200)).astype(np.uint8)
    detect(PointCloud(points))
    detect(PointCloud(points, colours, organised=x_and_y.shape[1:]))


def compile_features() -> None:
    """Describe a tiny view with every descriptor that has a kernel."""
    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.features.descriptors.spin_images import SpinImageDescriber, spin_images
    from deixis.perception.features.points.keypoints import voxel_keypoints
    from deixis.perception.features.points.normals import estimate_normals

    side = np.linspace(0.0, 0.05, 6)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    cloud = PointCloud(np.stack([x, y, 1.0 + x * y], axis=1).astype(np.float32))
    SpinImageDescriber().describe(cloud)
    normals, keypoints = estimate_normals(cloud.points, neighbours=5), voxel_keypoints(cloud.points, 0.05)
    spin_images(cloud.points, normals, keypoints, support=0.05, min_points=1, angular=True, threads=1)


def compile_recognition() -> None:
    """Recognise a tiny view, in memory and mapped from a file: mapped arrays have a numba signature of their own."""
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
