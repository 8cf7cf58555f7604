"""Measure grounding of people's words for dots: find one of seven dots, described by its relation to a labelled dot.

OneCommon (Udagawa and Aizawa 2019), ``$DEIXIS_DATA/onecommon/direction_pairs.json``: ``target left of landmark`` with
the landmark's dot labelled ``landmark`` for certain. Prints the share of targets and of landmarks that are found, and
the probability of the landmark.
"""

from __future__ import annotations

import json

import numpy as np
from common import data_folder
from records import command_line, mean, recorded, share

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.evidence.properties.labels import Label
from deixis.reasoning.grounding.ground import ground


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        folder = data_folder("onecommon")
        if folder is None:
            return
        ontology, engine = default_ontology(), engine_named("exact")
        found, probable = [], []
        for one in json.loads((folder / "direction_pairs.json").read_text(encoding="utf-8")):
            fact = Fact("target", (ontology.relations[one["word"]],), "landmark")
            description = RelationGraph.from_facts(ontology.relations, ["target", "landmark"], [fact])
            dots = np.array([(dot["x"], dot["y"], dot["radius"]) for dot in one["dots"]])
            boxes = np.stack([dots[:, :2] - dots[:, 2:], dots[:, :2] + dots[:, 2:]], axis=1)
            labels = [Label("landmark") if p == one["landmark"] else None for p in range(len(boxes))]
            scene = scene_relations([f"o{p}" for p in range(len(boxes))], boxes, ontology.relations)
            evidence = evidence_from(description, scene, labels, ontology.kinds, ontology.sizes, metric=False)
            matches = ground(evidence, engine, Deadline.after(5.0)).matches
            found.append(
                [name in matches and matches[name].perceived == f"o{one[name]}" for name in ("target", "landmark")]
            )
            probable.append((matches["landmark"].probability or 0.0) if "landmark" in matches else 0.0)
        share("targets found", sum(bool(one[0]) for one in found), len(found))
        share("landmarks found", sum(bool(one[1]) for one in found), len(found))
        mean("probability of the landmark", probable)
        target, landmark = np.mean(found, axis=0)
        print(f"{len(found)} descriptions: target found {target:.2f}, landmark {landmark:.2f}")
        print(f"probability of the landmark {np.mean(probable):.4f} in the mean, {min(probable):.4f} at the least")


if __name__ == "__main__":
    main()
