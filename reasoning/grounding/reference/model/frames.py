"""Tell in which frame of reference the directions of a description were taken.

The frames are those of S. C. Levinson, *Space in Language and Cognition*, 2003: *left of the chair* is relative (as a
viewer sees it) or intrinsic (by the front of the chair).
"""

from __future__ import annotations

import numpy as np

from deixis.reasoning.grounding.reference.answer import Frame
from deixis.reasoning.grounding.reference.features.properties import SIDES
from deixis.reasoning.grounding.reference.features.relations import RELATIONS
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.model.model import Model
from deixis.reasoning.grounding.reference.query import Query

PLACES = frozenset({"corner", "wall", "edge", "middle", "centre", "center"})


def frame_of(query: Query, room: Room, model: Model) -> Frame | None:
    """Return the frame of the first direction of a query, None if it has none.

    *Left* and *right* are the viewer's. *In front of* and *behind* are those of the landmark if the most probable one
    has a front, and the viewer's otherwise. Places (*in the corner*) are those of the table or the room.

    Parameters
    ----------
    query
        The query.
    room
        The scene.
    model
        The model, for the most probable landmark.

    Returns
    -------
    Frame or None
        The frame, or None.
    """
    if query.viewer is not None:
        return Frame.OBJECT if query.viewer.stance == "own" else Frame.VIEWER
    for part in query.target.parts():
        for relation in part.relations:
            family = RELATIONS.get(relation.name, ("", 0.0))[0]
            if family == "sideways":
                return Frame.VIEWER
            if family == "ahead":
                fit = model.lexis.similarity(relation.arguments[0].noun, room)
                likely = int(np.argmax(fit)) if len(fit) else 0
                fronted = fit[likely] > 0 and not np.isnan(room.fronts[likely]).any()
                return Frame.OBJECT if fronted else Frame.VIEWER
        if any(one.word in SIDES for one in part.properties):
            return Frame.VIEWER
        if any(one.word in PLACES for one in part.properties):
            return Frame.TABLE
    return None
