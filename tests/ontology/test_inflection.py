"""Singular and plural."""

from __future__ import annotations

import pytest

from deixis.ontology.inflection import plural, singular, singulars
from deixis.ontology.tbox import default_ontology


@pytest.mark.parametrize(
    ("one", "many"),
    [
        ("fork", "forks"),
        ("glass", "glasses"),
        ("box", "boxes"),
        ("prize", "prizes"),
        ("brush", "brushes"),
        ("bench", "benches"),
        ("knife", "knives"),
        ("bookshelf", "bookshelves"),
        ("fireman", "firemen"),
        ("child", "children"),
        ("person", "people"),
        ("tray", "trays"),
        ("berry", "berries"),
        ("potato", "potatoes"),
        ("bus", "buses"),
        ("scissors", "scissors"),
        ("water_bottle", "water_bottles"),
        ("coffee table", "coffee tables"),
    ],
)
def test_plural_and_singular_are_each_others_inverse(one: str, many: str) -> None:
    assert plural(one) == many
    assert singular(many) == one
    assert singular(one) == one


def test_every_noun_of_the_lexicon_comes_back_from_its_plural() -> None:
    words = [word for word in default_ontology().kinds.every_word if " of " not in word and not word.endswith("s")]
    assert len(words) > 5000
    lost = [word for word in words if word not in singulars(plural(word))]
    assert lost == []


def test_open_spellings_are_decided_by_the_lexicon() -> None:
    pairs = {"pies": "pie", "cherries": "cherry", "shoes": "shoe", "menus": "menu", "bus": "bus", "jeans": "jeans"}
    assert {many: default_ontology().lexicon.singular(many) for many in pairs} == pairs
