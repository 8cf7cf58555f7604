"""The file of nouns: what it may say, what it says, and when it is read."""

from __future__ import annotations

import re

import pytest

from deixis.errors import OntologyError
from deixis.ontology.lexicon.nouns import listed_words, read_nouns
from deixis.ontology.tbox import default_ontology, load_ontology
from deixis.ontology.things.kinds import spaced

KINDS = default_ontology().kinds
NOUNS = read_nouns(KINDS.words)
BOWL = KINDS.words["bowl"]


def test_a_line_gives_kinds_with_synonyms_parents_and_a_size() -> None:
    nouns = read_nouns(KINDS.words, "bowl, dish\n  vat, sump: d20x10 *2\n    pot; pyx\n")
    assert [kind.name for kind in nouns.kinds.values()] == ["Vat", "Pot_Vat", "Pyx"]
    vat, _, pyx = nouns.kinds.values()
    assert vat.words == ("vat", "sump") and BOWL.iri in vat.broader
    assert nouns.parents[pyx.iri] == (vat.iri,) and pyx.broader == vat.broader | {vat.iri}
    length = nouns.sizes[vat.iri].length
    assert (length.least, length.typical, length.greatest) == pytest.approx((0.1, 0.2, 0.4))
    assert nouns.words["dish"] == (BOWL,)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("zorgle\n", "nouns.txt:1: 'zorgle' must be a kind"),
        ("bowl : d10x10\n", "nouns.txt:1: 'bowl' must be a kind"),
        ("bowl\n   tub\n", "nouns.txt:2: indent by two spaces"),
        ("bowl\n    tub\n", "nouns.txt:2: a line is at most one step deeper"),
        ("bowl\n  tub; vat\n    keg\n", "nouns.txt:3: a line is at most one step deeper"),
        ("bowl\n  tub,\n", "nouns.txt:2: indent by two spaces a step, and separate"),
        ("bowl\n  tub\n  tub\n", "nouns.txt:3: 'tub' is below 'bowl' twice"),
        ("bowl\n  tub : 10x20x5\n", "nouns.txt:2: lengths must be above 0"),
        ("bowl\n  tub : d10\n", "nouns.txt:2: a size must be"),
        ("bowl\n  tub : 10x20\n", "nouns.txt:2: a size must be"),
    ],
)
def test_a_line_that_cannot_be_read_is_an_error_with_its_number(text: str, message: str) -> None:
    with pytest.raises(OntologyError, match=re.escape(message)):
        read_nouns(KINDS.words, text)


def test_every_noun_has_a_size_and_is_found_by_each_of_its_words() -> None:
    sizes = default_ontology().sizes
    for kind in NOUNS.kinds.values():
        size = sizes.of(kind.iri)
        assert 0 < size.width.least <= size.length.greatest
        assert all(kind in KINDS.senses(word) for word in kind.words)


def test_no_noun_repeats_a_word_that_inflection_gives() -> None:
    for kind in NOUNS.kinds.values():
        assert len(set(kind.words)) == len(kind.words)


def test_the_file_is_read_at_the_first_word_that_the_tbox_lacks() -> None:
    kinds = load_ontology().kinds
    assert kinds.of_word("dinner plate") is not None
    assert "every_word" not in vars(kinds)
    assert kinds.of_word("ottoman") is not None
    assert "every_word" in vars(kinds)


def test_senses_are_the_same_before_and_after_the_file_is_read() -> None:
    known = {spaced(word) for word in KINDS.every_word}
    words = {*known, *(word.replace(" ", "") for word in known), "no such word", "dinner plates"}
    fresh = load_ontology().kinds
    listed = listed_words(fresh.words)
    early = {word: fresh.senses(word) for word in words if listed.isdisjoint((word, word.replace(" ", "")))}
    assert "every_word" not in vars(fresh)
    assert len(early) > 100
    assert all(
        [kind.iri for kind in found] == [kind.iri for kind in KINDS.senses(word)] for word, found in early.items()
    )


def test_words_of_the_tbox_keep_their_usual_meaning() -> None:
    for word, kind in KINDS.words.items():
        assert KINDS.senses(word)[0] is kind
