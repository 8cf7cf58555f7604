"""Relations as choices of pieces."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact
from deixis.ontology.relations.allen import Allen, members
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.realisation.pieces import Piece, X, Y, choice, region
from deixis.reasoning.geometry.allen import EndOrder
from deixis.reasoning.geometry.allen import admitted as admitted_atoms

R = default_ontology().relations


def admitted_by(piece: Piece) -> NDArray[np.bool_]:
    """Return the atoms that inequalities admit together, shape (13, 13): the inverse of :func:`choice`."""
    masks = [admitted_atoms(tuple(EndOrder(*i[1:]) for i in piece if i.axis == axis)) for axis in (X, Y)]
    found = np.zeros((13, 13), dtype=bool)
    found[np.ix_(members(masks[X]), members(masks[Y]))] = True
    return found


@settings(max_examples=100, deadline=None)
@given(st.lists(st.integers(0, 168), max_size=40))
def test_the_pieces_of_a_set_of_atoms_admit_exactly_that_set(cells: list[int]) -> None:
    wanted = np.zeros(169, dtype=np.bool_)
    wanted[cells] = True
    found = choice(wanted.reshape(13, 13))
    admitted = np.zeros((13, 13), dtype=np.bool_)
    for piece in found.pieces:
        admitted |= admitted_by(found.always + piece)
    assert (admitted == wanted.reshape(13, 13)).all()


def test_wide_relations_of_one_axis_are_one_inequality() -> None:
    for word in ("left", "right", "top", "bottom"):
        found = choice(region(Fact("a", (R[word],), "b")))
        assert (len(found.always), found.pieces) == (1, ((),))


def test_the_atom_shared_by_on_and_under_pictures_neither() -> None:
    for word in ("on", "under"):
        for positive in (True, False):
            assert not region(Fact("a", (R[word],), "b", positive))[Allen.EQUALS, Allen.EQUALS]
    assert not region(Fact("a", (R["left"],), "b"))[Allen.EQUALS, Allen.EQUALS]
