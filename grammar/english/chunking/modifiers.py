"""Find the adjectives and nouns that stand before the head of a noun phrase."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.noun_positions import NounFinder
from deixis.grammar.english.tagging.word_classes import ED_NOUNS, NOUN_OR_PREPOSITION
from deixis.grammar.english.tree import Adjective, Degree
from deixis.grammar.english.vocabulary.adjectives import COLOUR_SHADES, degree_of, is_adjective, is_material_noun
from deixis.grammar.english.vocabulary.function_words import ADVERBS, HEDGES, NUMBERS, ORDINALS
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, prepositions
from deixis.grammar.english.vocabulary.tables import word_set


class ModifierFinder(NounFinder):
    """Finder of the modifiers of nouns."""

    def _modifiers(self, at: int, determined: bool) -> tuple[int, tuple[Adjective, ...]]:
        i, found, choice = at, [], False
        norms = self.norms
        while i < len(self.words) and self._nouns.compound(norms, i) is None:
            norm = norms[i]
            if norm == "still" and norms[i - 1] in ("of", "with") and self.is_noun(i + 1):
                i += 1  # 'a bottle of still water'
                continue
            if norm in ("later", "earlier") and determined and self._nounish(i + 1):
                i += 1  # 'a later addition'
                continue
            if self.is_participle_of_one(i):
                found.append(Adjective(norm, "state", Degree.PLAIN, self._span(i, i + 1)))
                i += 1
                continue
            rank = ORDINALS.get(norm)
            if norm in ("second", "third", "quarter") and not determined and not self._nounish(i + 1) and i > at:
                break
            if rank is not None:
                found.append(Adjective(norm, "rank", Degree.PLAIN, self._span(i, i + 1), rank=rank))
                i += 1
                continue
            if (norm == "very" and self._nounish(i + 1)) or (
                norm == "away" and found and found[-1].word in ("far", "near") and (self._continues(i + 1))
            ):
                i += 1
                continue
            relating = norms[i + 1] in NOUN_OR_PREPOSITION and not self.adjective_before_noun(i + 1)
            described = not relating and (
                is_adjective(norms[i + 1])
                or (determined and norm not in ADVERBS and norm not in HEDGES and self._nounish(i + 1))
            )  # 'an oily rag'
            described = described or (norms[i + 1].endswith("ed") and i == at and norms[i - 1] in prepositions())
            if norm.endswith("ly") and norm not in self._adjectives and described and not self._nouns.knows(norm):
                i += 1
                continue
            if norms[i + 1] in (
                "shaped",
                "colored",
                "coloured",
                "sized",
                "looking",
                "style",
                "styled",
                "topped",
                "framed",
                "mounted",
            ) and (self._continues(i + 2) and norm not in self._closed and norms[i + 2] not in prepositions()):
                dimension = {"shaped": "shape", "colored": "colour", "coloured": "colour", "sized": "size"}.get(
                    norms[i + 1], "other"
                )
                found.append(Adjective(degree_of(norm)[0], dimension, Degree.PLAIN, self._span(i, i + 2)))
                i += 2
                continue
            if norm in _BEFORE_ADJECTIVE or norm in HEDGES or norm in ADVERBS:
                following = norms[i + 1]
                if norm == "very" and following in ORDINALS:
                    i += 1
                    continue
                if (
                    is_adjective(following)
                    and (norm not in self._adjectives or norm in COLOUR_SHADES)
                    and following
                    not in (
                        "next",
                        "close",
                        "opposite",
                        "level",
                        "parallel",
                        "adjacent",
                    )
                ):
                    if self._is_relation(i + 1):
                        break
                    degree = {"more": Degree.COMPARATIVE, "most": Degree.SUPERLATIVE}.get(norm)
                    if degree is not None:
                        found.append(self._adjective(i + 1, degree, i))
                        i += 2
                        continue
                    if norm not in self._adjectives:
                        i += 1
                        continue
                elif norm not in self._adjectives:
                    break
            if norm in ("other", "same", "another", "different") and (determined or found or self._continues(i + 1)):
                if not self._continues(i + 1) and norms[i + 1] not in NUMBERS:
                    break
                found.append(Adjective(norm, "other", Degree.PLAIN, self._span(i, i + 1)))
                i += 1
                continue
            if norm == "non" or norm in ("-",):
                i += 1
                continue
            if found and norm in ("and", ",", "/", "or", "but") and self._joins_adjectives(i):
                choice = choice or norm in ("/", "or")
                i += 1
                continue
            if not self._modifies(i, determined or bool(found)):
                break
            found.append(self._adjective(i, None, i))
            i += 1
            if norms[i] == "most" and found[-1].dimension == "position":
                found[-1] = replace(found[-1], degree=Degree.SUPERLATIVE, span=self._span(i - 1, i + 1))
                i += 1
            elif norms[i] in ("hand", "side") and found[-1].dimension == "position" and self._nounish(i + 1):
                i += 1
        if choice:  # 'a plastic or rubber foot' need not be of plastic
            several = [a.dimension for a in found]
            found = [a for a in found if several.count(a.dimension) == 1 or a.dimension in ("position", "rank")]
        return i, tuple(found)

    def _adjective(self, at: int, degree: Degree | None, start: int) -> Adjective:
        norm = self.norms[at]
        lemma, own = degree_of(norm)
        if norm == "lower" and (self._nounish(at + 1) or self.norms[at + 1] in ("one", "ones")):
            return Adjective("bottom", "position", Degree.PLAIN, self._span(start, at + 1))
        dimension = self._adjectives.get(norm) or self._adjectives.get(lemma)
        if dimension is None:
            if norm.endswith(("colored", "coloured")):
                dimension, lemma = "colour", norm.rpartition("-")[0] or lemma
            elif norm.endswith("shaped"):
                dimension = "shape"
            else:
                dimension = "state" if norm.endswith("ed") else "other"
        return Adjective(lemma, dimension, degree or own, self._span(start, at + 1))

    def _is_relation(self, at: int) -> bool:
        """Return True if a relation phrase of several words begins here: *close to*, *next to*, *level with*."""
        return f"{self.norms[at]} {self.norms[at + 1]}" in prepositions()

    def _modifies(self, at: int, determined: bool) -> bool:
        norm, after = self.norms[at], self.norms[at + 1]
        if norm in _TOOL_ADJECTIVES and not self._nounish(at + 1) and after not in ("one", "ones", "than", "of"):
            return False
        if norm[:1].isdigit() and "-" in norm:
            return self._nounish(at + 1)
        if not norm or not norm[0].isalpha() or norm in ("there", "here"):
            return False
        if is_adjective(norm):
            if (
                norm in PLACE_NOUNS
                or is_material_noun(norm)
                or norm
                in (
                    "light",
                    "orange",
                    "cream",
                    "flat",
                    "rectangle",
                    "glass",
                    "double",
                    "square",
                    "chocolate",
                    "peach",
                    "lime",
                    "main",
                    "twin",
                    "gold",
                    "silver",
                    "charcoal",
                    "olive",
                    "lavender",
                    "level",
                )
            ):
                telegraphic = after in ("upper", "lower", "top", "bottom", "far", "near") and (
                    self.norms[at + 2] in ("left", "right") and not determined
                )
                beside = after in ("next", "close", "near") and self.norms[at + 2] == "to"  # 'the tin next to it'
                placed = after in ("left", "right") or telegraphic or beside
                if (is_material_noun(norm) and placed) or self._letter(at + 1) is not None:
                    return False
                if norm in ("left", "right") and after in ("of", "to", "from"):
                    return False
                if self._nounish(at + 1) or after in ("one", "ones", "hand", "most"):
                    return True
                if (
                    after in ("and", "or")
                    and is_material_noun(norm)
                    and is_adjective(self.norms[at + 2])
                    and self._nounish(at + 3)
                ):
                    return True
                if is_adjective(after) and (self._nounish(at + 2) or after in PLACE_NOUNS):
                    return True
                return norm in (
                    "gold",
                    "silver",
                    "square",
                    "flat",
                    "orange",
                    "cream",
                    "charcoal",
                    "lavender",
                ) and not self._noun_by_position(at)
            if self._is_relation(at) and not (
                after == "away" and (self._nounish(at + 2) or self.adjective_before_noun(at + 2))
            ):
                return False
            if (
                norm in self.relating_words
                and degree_of(norm)[1] is Degree.PLAIN
                and norm
                not in (
                    "round",
                    "opposite",
                    "near",
                    "far",
                    "inside",
                    "outside",
                    "close",
                    "next",
                    "nearby",
                    "adjacent",
                    "second",
                    "same",
                    "most",
                    "single",
                    "only",
                )
            ):
                return False
            if norm in ("near", "far", "opposite", "close", "next", "inside", "outside"):
                return (self.adjective_before_noun(at) and (determined or at == 0 or after in PLACE_NOUNS)) or (
                    norm == "far" and after in DIRECTION_WORDS
                )
            return True
        form = self._verbs.get(norm)
        if (
            form is not None
            and form.form == "ing"
            and form.kind == "posture"
            and determined
            and self.adjective_before_noun(at + 1)
        ):
            return True
        if not self._nounish(at + 1) and after not in ("one", "ones"):
            return False
        if (
            at > 1
            and norm.endswith("ed")
            and self.norms[at - 1].endswith("ly")
            and self.norms[at - 2] in prepositions()
        ):
            return True  # 'in loosely tied bags'
        if form is not None and form.form in ("past", "participle"):
            return (determined and norm not in ("set",)) or (
                form.form == "past" and norm.endswith("ed") and self._free(at)
            )
        return (
            norm.endswith("ed")
            and len(norm) > 4
            and norm not in ED_NOUNS
            and (determined or self._free(at))
            and (norm not in self._closed)
        ) or (norm.endswith(("-ed", "ish")) and norm not in ("fish", "dish", "radish"))

    def _free(self, at: int) -> bool:
        """Return True if no noun stands before this word."""
        before = self.norms[at - 1] if at else ""
        return not before or before in self._closed or not before[0].isalpha() or self.follows_command(at)

    def _noun_by_position(self, at: int) -> bool:
        before = self.norms[at - 1] if at else ""
        if self.norms[at + 1] == "," and self.norms[at] != "orange" and self._nounish(at + 3):
            return False  # 'on a flat, stable surface'
        return (before in ("a", "an") and self.norms[at] in ("orange", "square", "cream", "flat")) or (
            before in ("the", "some", "and", "with", "of", ",")
            and self.norms[at] in ("orange", "cream", "charcoal", "lavender")
        )

    def _joins_adjectives(self, at: int) -> bool:
        """Return True for *and* or a comma between adjectives of one noun: *blue and white bowl*, *small, red cup*."""
        i = at + 1
        if self.norms[at] == "," and self.norms[i] in ("and", "but"):
            i += 1
        if self.norms[i] in _BEFORE_ADJECTIVE and not is_adjective(self.norms[i]):
            i += 1
        if self.norms[i].endswith("ed") and self._nounish(i + 1) and not is_adjective(self.norms[i]):
            return self.norms[i] not in ED_NOUNS and self.norms[at] != "or"
        if (
            not is_adjective(self.norms[i])
            or (self.norms[i] in self._closed and self.norms[i] != "round")
            or self._is_relation(i)
        ):
            return False
        if self.norms[at] == "or" and self.norms[i] in PLACE_NOUNS:
            return False
        j = i + 1
        while self.norms[j] in ("and", ",") or (
            is_adjective(self.norms[j])
            and (self._nounish(j + 1) or is_adjective(self.norms[j + 1]) or self.norms[j + 1] in ("one", "ones"))
        ):
            j += 1
        noun_after = self._nounish(j) or self.norms[j] in ("one", "ones")
        return noun_after if self.norms[i] not in PLACE_NOUNS else noun_after and j == i + 1

    def predicative(self, at: int) -> tuple[Adjective, ...]:
        """Return a word after *is* as an adjective: *light*, *wood*; nothing for another word.

        Parameters
        ----------
        at
            Index of the word after *is*.

        Returns
        -------
        tuple of Adjective
            One adjective, or none.
        """
        if not is_adjective(self.norms[at]) or self.norms[at] in PLACE_NOUNS:
            return ()
        return (self._adjective(at, None, at),)


_BEFORE_ADJECTIVE = word_set(
    "very slightly quite rather really more most less least so too fairly pretty somewhat light dark much far extremely"
    " partially partly fully completely mostly almost super bit even second third half"
)

_TOOL_ADJECTIVES = frozenset({"lighter", "cooler", "warmer", "shorter", "individual"})
"""Adjectives that are things or persons where no noun follows: *a lighter*."""
