"""Time equations 5 to 9 for all 455 sub-graphs of script2's 15 objects against 12 perceived ones, beside networkx.

The peer is the closest method of networkx, SimRank (`simrank_similarity`), run once for each of 15 of the sub-graphs'
disjoint unions with the scene and scaled: an iterative node similarity of the same kind, without labels. This compares
speed, not answers.
"""

from __future__ import annotations

from itertools import combinations

import networkx as nx
import numpy as np
from common import medians
from records import command_line, ratio, recorded

from deixis.examples_data import example
from deixis.perception.formats.scene_json import read_scene
from deixis.reasoning.grounding.engines.similarity import node_similarity
from deixis.reasoning.grounding.engines.similarity_engine import described
from deixis.workflows.layouts.read import read_script


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        script, scene = read_script(example("script2.layout")), read_scene(example("place_setting.scene.json"))
        first = described(script.graph())
        second = scene.graph(script.ontology.relations)
        chosen = list(combinations(range(15), 12))
        members = np.array([[i in kept for i in range(15)] for kept in chosen])
        paper = second.paper_view()
        unions = []
        for kept in chosen[:15]:
            names = {first.vertices[i] for i in kept}
            graph = nx.DiGraph(second.to_networkx())
            edges = ((first.vertices[s], first.vertices[o]) for s, o in first.edges)
            graph.add_edges_from((s, o) for s, o in edges if s in names and o in names)
            unions.append(graph)
        ours, theirs = medians(
            lambda: node_similarity(first, paper, members),
            lambda: [nx.simrank_similarity(graph, tolerance=1e-8, max_iterations=2000) for graph in unions],
            runs=5,
        )
        scaled = theirs * 455 / 15
        ratio("455 sub-graphs, SimRank scaled from 15", scaled, ours, "networkx")
        print(f"deixis, 455 sub-graphs in one batch: {ours:.3f} s")
        print(f"networkx SimRank, scaled from 15:    {scaled:.3f} s ({scaled / ours:.0f} times)")


if __name__ == "__main__":
    main()
