"""Find noun phrases: determiner, number, adjectives, nouns, owner."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.modifiers import ModifierFinder
from deixis.grammar.english.chunking.noun_positions import GENERIC_NOUNS
from deixis.grammar.english.tagging.word_classes import NOUN_OR_PREPOSITION
from deixis.grammar.english.tree import Adjective, Degree, NounPhrase
from deixis.grammar.english.vocabulary.adjectives import QUALITIES, is_adjective, is_material_noun
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    APPROXIMATE,
    COLLECTIVES,
    DETERMINERS,
    HEDGES,
    IS_FORMS,
    MODALS,
    ORDINALS,
    PLURAL_PRONOUNS,
    POSSESSIVES,
    PRONOUNS,
    UNITS,
)
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS, places_alone, prepositions


class NounChunker(ModifierFinder):
    """Finder of noun phrases among the words of one sentence."""

    def phrase(self, at: int, previous: str) -> tuple[int, NounPhrase | None, tuple[Adjective, ...]] | None:
        """Return the end of the phrase and the noun phrase, or None and the adjectives of an adjective phrase.

        Parameters
        ----------
        at
            Index of the first word.
        previous
            Type of the chunk before the phrase; empty at the beginning of a sentence.

        Returns
        -------
        tuple or None
            Index after the last word, the noun phrase or None, and the adjectives; None if no phrase begins here.
        """
        end, found, modifiers = self._one(at, previous, None)
        if end == at:
            return None
        depth = 0
        while found is not None and self.is_genitive(end) and depth < 20:
            following, owned, modifiers = self._one(end + 1, "GENITIVE", found)
            if owned is None or following == end + 1:
                break
            end, found, depth = following, owned, depth + 1
        if found is not None and self.norms[end] == "'s" and self.is_genitive(end):
            end += 1
        return end, found, modifiers

    def _one(
        self, at: int, previous: str, owner: NounPhrase | None
    ) -> tuple[int, NounPhrase | None, tuple[Adjective, ...]]:
        i, norms = at, self.norms
        determiner: str | None = None
        count: int | None = None
        start = at
        negated = False
        if norms[i] == "not" and self.starts(i + 1):
            negated, i = True, i + 1
        doubted = not previous and norms[i] in HEDGES - APPROXIMATE and self.number(i + 1) is None
        if doubted and norms[i + 1] != "any":
            return at, None, ()  # 'perhaps the fork …' doubts the clause
        while norms[i] in ("only", "just", "exactly") or (norms[i] in HEDGES and norms[i] != "about"):
            if not self.starts(i + 1) or i - at > 2:
                return at, None, ()
            determiner = (
                "only" if norms[i] == "only" else "no" if norms[i] in ("hardly", "scarcely", "barely") else None
            )
            i += 1
        owned = norms[i + 2] == "'s"  # 'neither Anna's radio nor …'
        if norms[i] in ("neither", "either", "both") and (norms[i + 1] in DETERMINERS | POSSESSIVES.keys() or owned):
            determiner = norms[i] if norms[i] != "either" else None
            i += 1
        letter = self._letter(i)
        if letter is not None and owner is None:
            return i + 1, NounPhrase(self._span(start, i + 1), head=letter, negated=negated), ()
        if norms[i] == "no" and norms[i + 1] == "one" and not self._counts_one(i + 2):
            return i + 2, NounPhrase(self._span(start, i + 2), pronoun="nothing"), ()
        if norms[i : i + 2] == ["one", "another"]:
            span = self._span(start, i + 2)
            return i + 2, NounPhrase(span, determiner="each", plural=True, pronoun="other"), ()
        pronoun = self._pronoun(i, previous)
        if pronoun is not None and owner is None:
            plural = norms[i] in PLURAL_PRONOUNS
            if pronoun == "nothing" and self._describes(i + 1):  # 'nothing flammable may lie on it'
                span = self._span(i + 1, i + 2)
                adjective = Adjective(norms[i + 1], "other", Degree.PLAIN, span)
                return i + 2, NounPhrase(self._span(start, i + 2), pronoun=pronoun, adjectives=(adjective,)), ()
            return i + 1, NounPhrase(self._span(start, i + 1), pronoun=pronoun, plural=plural, negated=negated), ()
        while norms[i] in DETERMINERS and not (norms[i] == "another" and norms[i + 1] in self._closed):
            if (
                norms[i] == "other"
                and determiner == "the"
                and norms[i + 1] in ("left", "right")
                and norms[i + 2] == "of"
            ):
                other = NounPhrase(self._span(start, i + 1), "", "the", pronoun="other", negated=negated)
                return i + 1, other, ()  # 'one left of the cross, the other right of it'
            if norms[i] == "single" or (
                norms[i] == "other" and determiner and not self._continues(i + 1) and self.number(i + 1) is None
            ):
                break
            if determiner in ("neither", "no"):
                i += 1
                continue
            if determiner is None or norms[i] not in ("the", "a", "an", "these", "those"):
                determiner = norms[i]
            elif determiner in ("all", "both", "half", "only"):
                pass
            else:
                determiner = norms[i]
            i += 1
        if norms[i] in POSSESSIVES and owner is None:
            word = POSSESSIVES[norms[i]]
            owner = NounPhrase(self._span(i, i + 1), pronoun=word, plural=word in PLURAL_PRONOUNS)
            determiner, i = determiner, i + 1
            if norms[i] == "own":
                i += 1
        number = None if self._is_pair(i) else self.number(i)
        if number is not None and number == int(number) and not (norms[i] == "one" and not self._counts_one(i + 1)):
            count, i = int(number), i + 1
            if norms[i] == "o'clock":
                return self._clock(start, i + 1, count, owner)
        elif norms[i][:1].isdigit() and norms[i].endswith(":00"):
            return self._clock(start, i + 1, int(norms[i][:-3]), owner)
        i, found = self._modifiers(i, determiner is not None or owner is not None or count is not None)
        if count is None:
            number = self.number(i)
            unit = norms[i + 1].removesuffix("s") in UNITS
            if number is not None and number == int(number) and norms[i] != "one" and self._nounish(i + 1) and not unit:
                count, i = int(number), i + 1
                i, more = self._modifiers(i, True)
                found += more
        end, phrase, modifiers = self._head(start, i, determiner, count, found, owner, negated)
        whole = determiner in ("a", "an") or (owner is not None and (count or 0) >= 10)  # 'my $300 computer'
        measured = phrase is not None and whole and (count or 0) > 1 and bool(phrase.head)
        if phrase is not None and measured and not self._nouns.singular(norms[end - 1])[1]:
            phrase = replace(phrase, count=None, plural=False)  # 'a five piece drum set', but 'a dozen eggs'
        return end, phrase, modifiers

    def _is_pair(self, at: int) -> bool:
        """Return True for *couple*, *pair* and *dozen* as nouns: *behind the couple hangs a curtain*."""
        return at < len(self.words) and self.classes[at] == "noun" and self.norms[at + 1] != "of"

    def _counts_one(self, at: int) -> bool:
        """Return True if *one* is a number here: *one saucer*, and not *the one near the door*."""
        if (
            self.norms[at] in prepositions()
            or self._is_relation(at)
            or self.norms[at] in ("next", "close", "left", "right")
        ):
            return (
                self.adjective_before_noun(at)
                and not self._is_relation(at)
                and self.norms[at] not in ("on", "in", "near", "next")
            )
        if self.norms[at] in ORDINALS:
            return False
        return self._continues(at) and (
            self._nounish(at) or self.adjective_before_noun(at) or self.norms[at] in ("more", "other")
        )

    def _clock(
        self, start: int, end: int, hour: int, owner: NounPhrase | None
    ) -> tuple[int, NounPhrase | None, tuple[Adjective, ...]]:
        """Return the place at an hour of a clock face: *at its 3 o'clock position*."""
        if self.norms[end] == "o'clock":
            end += 1
        if self.norms[end] in ("position", "direction", "angle"):
            end += 1
        return end, NounPhrase(self._span(start, end), head="o'clock", count=hour, owner=owner), ()

    def _describes(self, at: int) -> bool:
        """Return True for a word between *nothing* and a verb that is a quality, known or not."""
        norm = self.norms[at]
        plain = norm.isalpha() and norm not in self._closed and norm not in self._verbs and norm not in ADVERBS
        return plain and self.norms[at + 1] in MODALS.keys() | IS_FORMS

    def _pronoun(self, at: int, previous: str) -> str | None:
        norm = self.norms[at]
        if norm in ("her", "hers") and not self._continues(at + 1):
            return "she"  # 'a lamb lies behind her'
        if norm not in PRONOUNS or at >= len(self.words):
            return None
        if norm == "which" and previous == "PREP":
            return PRONOUNS[norm]  # 'a till in which three saws hang'
        fronted = norm in ("this", "that", "these") and previous == "PREP" and self.is_determiner(at + 2)
        if fronted and self.norms[at + 1] in ("place", "put", "lay"):
            return PRONOUNS[norm]  # 'on top of this place the jug'
        if norm == "that" and previous in ("BE", "VERB", "TVERB") and not self._nounish(at + 1):
            return None
        if norm in DETERMINERS or norm == "one":
            after = self.norms[at + 1]
            if norm in ("one", "all", "both", "each", "another", "other"):
                later = at + 1
                if (
                    self._continues(later)
                    or after in ("the", "these", "those")
                    or (after in POSSESSIVES and norm != "one")
                    or (self.number(at + 1) is not None and norm != "one")
                ):
                    form = self._verbs.get(after)
                    goes_on = form is None or self.is_noun(later) or form.form in ("participle", "past")
                    noun = not is_adjective(after) or self.adjective_before_noun(later) or is_material_noun(after)
                    noun = noun or after == "square"
                    if goes_on and noun:
                        return None
            elif (
                self.is_noun(at + 1)
                or self._nouns.knows(f"{after} {self.norms[at + 2]}")
                or self.number(at + 1) is not None
                or after in ORDINALS
                or after == "very"
                or self.adjective_before_noun(at + 1)
                or (norm in ("this", "these", "those") and self._is_done(at + 1) and self.is_noun(at + 2))
            ):
                if not (after in self._verbs and self._verbs[after].form in ("s",)):
                    return None
            elif is_adjective(after) and norm in ("which", "what"):
                return None
        return PRONOUNS[norm]

    def _head(
        self,
        start: int,
        at: int,
        determiner: str | None,
        count: int | None,
        modifiers: tuple[Adjective, ...],
        owner: NounPhrase | None,
        negated: bool,
    ) -> tuple[int, NounPhrase | None, tuple[Adjective, ...]]:
        def lettered(name: str, end: int) -> tuple[int, NounPhrase, tuple[Adjective, ...]]:
            span = self._span(start, end)
            phrase = NounPhrase(span, name, determiner, count, False, None, modifiers, owner=owner, negated=negated)
            return end, phrase, ()

        i, norms = at, self.norms
        nouns: list[str] = []
        while i < len(self.words):
            compound = None if nouns else self._nouns.compound(norms, i)
            if compound is not None:
                nouns += norms[i:compound]
                i = compound
                continue
            norm = norms[i]
            favourite = len(nouns) == 1 and not self._nouns.knows(nouns[0]) and norms[i - 1] == nouns[0]
            quality = favourite and nouns[0] in QUALITIES
            if norm in ("one", "ones") and (not nouns or favourite) and (modifiers or determiner or owner or quality):
                if quality:
                    modifiers += (Adjective(nouns[0], "state", Degree.PLAIN, self._span(i - 1, i)),)
                phrase = NounPhrase(
                    self._span(start, i + 1), "", determiner, count, norm == "ones", "one", modifiers, owner=owner,
                    negated=negated,
                )  # fmt: skip
                return i + 1, phrase, ()
            if norm in ("other", "others", "former", "latter") and not nouns and determiner is not None:
                pronoun = PRONOUNS[norm]
                phrase = NounPhrase(
                    self._span(start, i + 1), "", determiner, count, norm == "others" or (count or 1) > 1, pronoun,
                    modifiers, owner=owner, negated=negated,
                )  # fmt: skip
                return i + 1, phrase, ()
            if norm in PLACE_NOUNS:
                if (
                    (
                        norm in NOUN_OR_PREPOSITION
                        and not nouns
                        and determiner is None
                        and owner is None
                        and not modifiers
                    )
                    and norm in ("left", "right", "next")
                    and norms[i + 1] in ("of", "to")
                ):
                    break
                if nouns and (
                    f"{norm} {norms[i + 1]}" in places_alone()
                    or f"{norm} {norms[i + 1]} {norms[i + 2]}" in places_alone()
                ):
                    break
                if nouns and norm == "top" and norms[i + 1] != "of" and determiner is not None:
                    pass
                elif nouns and (
                    norm in ("left", "right", "inside", "outside")
                    or (is_adjective(norm) and norms[i + 1] not in ("of",))
                ):
                    break
            if nouns and f"{norm} {norms[i + 1]} {norms[i + 2]}" in prepositions() and norm in ("half", "full"):
                break  # 'a pan half full of water'
            if nouns and norm.endswith(("-quarters", "-thirds")):
                break  # 'a jug three-quarters full'
            if nouns and norm in ("face", "bottom") and norms[i + 1] in ("up", "down"):
                break  # 'the card face down'
            letter = self._letter(i)
            if letter is None and norm not in PLACE_NOUNS and (norm in self._closed or not self._noun_here(i, nouns)):
                break
            if letter is not None and nouns and nouns[-1] in PLACE_NOUNS:
                break
            if letter is not None and ((nouns and nouns[-1] in GENERIC_NOUNS) or not nouns):
                return lettered(letter, i + 1)
            nouns.append(norm)
            i += 1
            if letter is not None:
                break  # 'mannequin A wears …'
            if nouns[-1] in GENERIC_NOUNS and norms[i] in ("labeled", "labelled", "called", "named", "marked"):
                named = self._letter(i + 1)
                if named is not None:
                    return lettered(named, i + 2)
        shaped = bool(modifiers) and modifiers[-1].dimension == "shape" and self._nouns.knows(norms[i - 1])
        noun_here = (determiner == "the" and len(modifiers) == 1) or norms[i - 1] == "square"
        if not nouns and shaped and noun_here and (determiner is not None or owner is not None or count is not None):
            nouns, modifiers = [norms[i - 1]], modifiers[:-1]  # 'facing the square', 'on a white square'
        if not nouns:
            if determiner is None and owner is None and count is None:
                if len(modifiers) and any(a.dimension != "rank" for a in modifiers):
                    return at, None, modifiers
                if not modifiers:
                    return start, None, ()
            if not modifiers and count is None and determiner in ("a", "an", "the", None) and owner is None:
                return start, None, ()
            alone = determiner in ("this", "that", "these", "those", "each", "every", "all", "both") and not modifiers
            if alone and count is None:  # but 'between these two'
                return start, None, ()
            phrase = NounPhrase(
                self._span(start, i),
                "",
                determiner,
                count,
                (count or 1) > 1,
                None,
                modifiers,
                owner=owner,
                negated=negated,
            )
            return i, phrase, ()
        one, plural = self._nouns.singular(nouns[-1])
        if determiner in ("a", "an", "one", "this", "that", "each", "every") or count == 1:
            plural = False if one == nouns[-1] else plural
        if self.words[i - 1].text[:1].isupper() and len(nouns[-1]) <= 2 and nouns[-1] == one:
            pass
        head = " ".join([*nouns[:-1], one])
        if (count or 0) > 1 and not plural and nouns[-1] in COLLECTIVES:
            plural = True
        phrase = NounPhrase(
            self._span(start, i), head, determiner, count, plural or (count or 1) > 1, None, modifiers, owner=owner,
            negated=negated, known=plural or self._nouns.knows(nouns[-1]) or not nouns[-1].isalpha(),
        )  # fmt: skip
        return i, phrase, ()
