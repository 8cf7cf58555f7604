"""Find verb groups: a verb with its auxiliaries, its denial and its adverbs."""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import COMMANDS, FINITE, JOINT_TYPES, Chunk, VerbGroup
from deixis.grammar.english.chunking.relators import CLAUSE_ENDS, NOUNS_TOO, RelatorChunker
from deixis.grammar.english.tagging.word_classes import is_known
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.function_words import ADVERBS, HEDGES, IS_FORMS, MODALS, NEGATIONS, PRONOUNS
from deixis.grammar.english.vocabulary.nouns import PEOPLE, last_word
from deixis.grammar.english.vocabulary.relation_words import places_alone, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import (
    FACE_VERBS,
    FIND_VERBS,
    LINKING_VERBS,
    NAMED_LIKE_THINGS,
    PLACING_VERBS,
    PUT_VERBS,
    REPORTS,
    SAYING,
    TRANSITIVE_RELATIONS,
)

PAST_ONLY = word_set(
    "stood lay sat went came began ran wore saw was were did had took gave knew fell rose"
    " wrote ate drank spoke broke drew threw flew grew sang swore"
)

PUT_ONLY = word_set(
    "put place keep leave set lay use see find position have cover stack fold roll store fill top flank screw bolt"
)


_NAMED_OR_PASSIVE = frozenset({"set", "laid", "hang", "leave", "stack", "mount", "fix"})
"""Words that begin a note or a participle as well: *set on the hill, …*, *stack on the left*."""

_FALLING_OVER = frozenset({"fall", "topple", "tip", "knock", "keel"})
"""Verbs of which *over* is a part."""


def _with(group: VerbGroup, lemma: str, kind: str, form: str, past: bool | None = None) -> VerbGroup:
    return VerbGroup(
        lemma, kind, form, group.modal, group.positive, group.past if past is None else past, group.adverbs
    )


class VerbChunker(RelatorChunker):
    """Finder of verb groups."""

    def _verb_group(self, at: int) -> Chunk | None:
        if self._denied is not None and self._previous() in ("NP", "ADVERB"):
            return self._denied_verb(at)
        if self.norms[at] == "not" and self._previous() in ("AND", "BUT"):
            form = self._verbs.get(self.norms[at + 1])
            spatial = form is not None and form.form == "base" and form.kind in ("posture", "lean", "face", "point")
            last = next((c.value for c in reversed(self.chunks) if c.type in FINITE), None)
            if form is not None and spatial and last is not None and last.modal:
                group = VerbGroup(form.lemma, form.kind, "base", last.modal, positive=False)
                return self._finite(at, at + 2, group)  # 'it must hang on the rail and not lie on the table'
        if self._previous() in ("AND", "OR") and (shared := self._second_verb(at)) is not None:
            return shared
        begins = self._previous() in JOINT_TYPES | {"", "ADVERB"}
        if self.norms[at] == "only" and begins and self.norms[at + 1] in PUT_VERBS and self._is_base(at + 1):
            return Chunk("ADVERB", at, at + 1, "only")  # 'only keep jars on the door'
        if self._leaves_object_out(at):
            form, self._object_left_out = self._verbs[self.norms[at]], True
            return Chunk("PUT", at, at + 1, VerbGroup(form.lemma, form.kind, "base"))
        i, adverbs, modal, positive, past = at, [], None, True, False
        while (self.norms[i] in ADVERBS | HEDGES and self.norms[i] != "about") or self.norms[i] == "never":
            if begins and self.norms[i] == "there" and self.norms[i + 1] in IS_FORMS | MODALS.keys():
                return None  # 'perhaps there is a spoon'
            if self.norms[i] == "never":
                positive = False
            else:
                adverbs.append(self.norms[i])
            i += 1
            if i - at > 3:
                return None
        if self.norms[i] == "used" and self.norms[i + 1] == "to" and self._infinitive(i + 2):
            past, i = True, i + 2
        if (
            i > at
            and not past
            and not self._auxiliary(i)
            and self.norms[i] not in ("seems", "appears")
            and (self.norms[i] not in self._verbs or (self.nouns.is_noun(i) and not self._orders(i)))
        ):
            return None
        if self.norms[at] in ("both", "all", "each", "either") and self._previous() != "NP":
            return None
        first = i
        verb = None
        while True:
            norm = self.norms[i]
            if norm == "may" and self.norms[i + 1 : i + 4] == ["or", "may", "not"]:
                modal, i = "may", i + 3
            elif norm in MODALS and (i == first or modal is None) and self._modal(i):
                modal = MODALS[norm]
                if norm == "need" or norm == "needs" or norm == "ought":
                    i += self.norms[i + 1] == "to"
            elif norm in ("do", "does", "did") and self._auxiliary(i):
                past = past or norm == "did"
            elif (norm == "no" and self.norms[i + 1] in ("longer", "more") and i > first) or (
                tuple(self.norms[i : i + 3]) in (("by", "no", "means"), ("in", "no", "way")) and i > first
            ):
                positive, i = False, i + (1 if norm == "no" else 2)
            elif norm == "under" and tuple(self.norms[i + 1 : i + 3]) == ("no", "circumstances"):
                positive, i = False, i + 2
            elif norm in NEGATIONS and i > first:
                positive = not positive if norm != "nor" else positive
            elif i > first and (
                ((norm in ADVERBS or norm in HEDGES or norm.endswith("ly")) and self._goes_on(i + 1))
                or (verb == "be" and norm in HEDGES and norm not in _HEDGES_OF_PLACES)
            ):
                adverbs.append(norm)
            elif norm in ("has", "have", "had", "having", "'ve") and self._perfect(i):
                past = past or norm == "had" or modal in _UNREAL
            elif norm in ("seems", "seem", "appears", "appear", "seemed", "appeared") and self.norms[i + 1 : i + 3] == [
                "to",
                "be",
            ]:
                adverbs.append("apparently")
                i += 1
            elif norm == "to" and i > first and self.norms[i + 1] in ("be", "stand", "go", "have"):
                modal = "should" if verb == "be" and modal is None else modal
            elif norm == "to" and i > first and verb == "be" and self._is_base(i + 1):
                modal, verb = "should", None  # 'it is to stand on the box'
            elif norm == "used" and self.norms[i + 1] == "to":
                past = True
                i += 1
            elif norm in ("has", "have", "had") and self.norms[i + 1] == "to" and self._is_base(i + 2):
                modal, i = "have to", i + 1
            elif norm in _TENDING and self.norms[i + 1] == "to" and self._is_base(i + 2):
                spared = norm == "required" and not positive  # 'it is not required to stand on the mat'
                modal = "need" if spared else _TENDING[norm]
                verb, i = None if self.norms[i + 2] != "be" else verb, i + 1
            elif norm in IS_FORMS and not (norm == "'s" and self.nouns.is_genitive(i)):
                adverbs += ["being"] * (norm == "being" and verb == "be")  # 'it is being cleaned'
                verb, past = "be", past or norm in ("was", "were")
            elif norm in _GETTING and self._is_participle(i + 1):  # 'the pieces get lined up beside it'
                verb, past = "be", past or norm == "got"
            else:
                break
            i += 1
        if verb == "be" and self.norms[i] == "got" and self.nouns.starts(i + 1):
            return Chunk(
                "TVERB", at, i + 1, VerbGroup("have", "transitive", "s", modal, positive, past, tuple(adverbs))
            )
        if verb == "be":
            return Chunk("BE", at, i, VerbGroup("be", "be", "finite", modal, positive, past, tuple(adverbs)))
        return self._lexical(at, first, i, VerbGroup("", "", "", modal, positive, past, tuple(adverbs)))

    def _second_verb(self, at: int) -> Chunk | None:
        """Return the verb after *and* that shares the modal verb before: *should be chilled and stand next to it*."""
        form = self._verbs.get(self.norms[at])
        last = next((c for c in reversed(self.chunks) if c.type in FINITE | {"PUT", "CUT"}), None)
        placed = self._predicate_after(at) or self._match(at + 1) is not None
        if form is None or last is None or last.type not in FINITE or not placed:
            return None
        if last.value.lemma == "be" and self.norms[at] in ("put", "set", "laid", "stood", "hung"):
            be = next(i for i in range(len(self.chunks) - 1, -1, -1) if self.chunks[i] is last)
            types = [chunk.type for chunk in self.chunks[be + 1 :] if chunk.type != "ADVERB"]
            coordinated = types[:1] in (["PART"], ["TPART"]) and set(types[1:-1]).isdisjoint(JOINT_TYPES)
            return Chunk("PART", at, at + 1, VerbGroup(form.lemma, form.kind, "participle")) if coordinated else None
        spatial = form.form == "base" and form.kind in ("posture", "lean", "face", "point")
        placed = last.value.lemma == "be" and self.chunks[-2].type == "NP"  # 'it should be on the tray and rest'
        if last.value.modal is None or not spatial or placed:
            return None
        return Chunk(
            "VERB", at, at + 1, VerbGroup(form.lemma, form.kind, "base", last.value.modal, last.value.positive)
        )

    def _leaves_object_out(self, at: int) -> bool:
        """Return True for a command before a place, whose object is named before: *cut it and place in the box*."""
        before = next((chunk.type for chunk in reversed(self.chunks) if chunk.type != "ADVERB"), "")
        norm, begins = self.norms[at], before in JOINT_TYPES | {""}
        if norm not in PLACING_VERBS or not begins or self.norms[at + 1] in ("of", "to", "for", "with", "from", "by"):
            return False
        placed = self._predicate_after(at) and self._match(at + 1) is not None
        if not placed and self._measure(at + 1) is None:
            return False
        if before not in ("", "CUT"):
            last = next((c for c in reversed(self.chunks) if c.type in FINITE | COMMANDS | {"CUT"}), None)
            return last is not None and last.type in COMMANDS
        return norm not in _NAMED_OR_PASSIVE and not IS_FORMS.intersection(self.norms[at:])

    def _is_base(self, at: int) -> bool:
        form = self._verbs.get(self.norms[at])
        return self.norms[at] == "be" or (form is not None and form.form == "base")

    def _is_participle(self, at: int) -> bool:
        """Return True for the participle of a passive with a place after it: *placed on*, *lined up beside*."""
        form = self._verbs.get(self.norms[at])
        after = at + 1 + (self.norms[at + 1] in PARTICLES)
        placed = self.norms[after] in prepositions() or self.norms[after] in places_alone()
        return form is not None and form.form in ("past", "participle") and placed

    def _denied_verb(self, at: int) -> Chunk | None:
        """Return the verb of a clause whose denial and modal verb stand before its subject."""
        i = at + (self.norms[at] == "be")
        form = self._verbs.get(self.norms[i])
        command = self._previous() == "ADVERB"
        if command and form is not None and self.norms[at] in _GOING and self._goes(at + 1):
            self._denied = None
            return Chunk("GO", at, at + 1, VerbGroup(form.lemma, form.kind, form.form, None, False))
        if self.norms[at] == "be" and (form is None or self.norms[i] in prepositions()):
            modal, self._denied = self._denied, None
            return Chunk("BE", at, i, VerbGroup("be", "be", "finite", modal, False))
        if form is None or (i == at and form.form not in ("base", "ing") and self._previous() != "NP"):
            return None
        if not command and form.form == "base" and self.nouns.is_noun(i) and not self._predicate_after(i):
            return None
        modal, self._denied = self._denied, None
        if self.norms[at] == "be":
            return Chunk("BE", at, i, VerbGroup("be", "be", "finite", modal, False))
        group = VerbGroup(form.lemma, form.kind, form.form, None if command else modal, False)
        return Chunk("PUT", at, i + 1, group) if command else self._finite(at, i + 1, group)

    def _predicate_after(self, at: int) -> bool:
        return self.norms[at + 1] in prepositions() or self.norms[at + 1] in places_alone()

    def _lexical(self, at: int, first: int, i: int, group: VerbGroup) -> Chunk | None:
        norm = self.norms[i]
        form = self._verbs.get(norm)
        helped = i > first
        if i in self._tried_verbs and (tried := self._tried(at, i, group)) is not None:
            return tried
        reporting = self.norms[i + 1] == "that" or (norm in SAYING and self.norms[i + 1] in _TOLD)
        if norm in REPORTS | SAYING and reporting and self._previous() == "NP":
            return Chunk(
                "COMPLEMENT",
                at,
                i + 1 + (self.norms[i + 1] == "that"),
                replace(_with(group, norm, "other", "s"), modal="might"),
            )
        if helped and (form is None or form.form not in ("base",)) and group.modal is None and not group.past:
            form = form if form is not None and form.form in ("base", "past", "participle") else None
            if form is None and self.norms[first] in ("has", "have", "had", "'ve", "having") and norm.endswith("ed"):
                return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "past"))
            if form is None:
                if self.norms[first] == "do" and not self._previous() and self.nouns.is_determiner(i + 1):
                    return Chunk("DO", at, i + 1, _with(group, norm, "unknown", "base"))  # 'do not tighten the screws'
                return (
                    Chunk("VERB", at, i, _with(group, "do", "other", "s"))
                    if self.norms[first] in ("do", "does")
                    else None
                )
        if (
            form is None
            and not helped
            and norm.endswith("s")
            and self.nouns.is_determiner(i + 1)
            and self._only_places()
        ):
            return Chunk("VERB", at, i + 1, _with(group, norm, "posture", "s"))  # 'behind it rises a goblet'
        if form is None:
            if helped and group.modal in _ACTING and self._is_unknown_verb(i):
                found = _with(group, norm, "unknown", "base")  # 'crumbs will spoil the dye'
                return Chunk("TVERB" if self._takes_object("unknown", i + 1) else "VERB", at, i + 1, found)
            if helped and group.modal is not None:  # 'the cup can', 'you should blarp'
                return Chunk("BE", at, i, _with(group, "be", "be", "finite"))
            if (
                self._previous() == "REL"
                and norm.endswith("s")
                and len(norm) > 3
                and (self.nouns.is_determiner(i + 1) or self.norms[i + 1] in prepositions())
            ):
                return Chunk(
                    "TVERB" if self.nouns.starts(i + 1) else "VERB", at, i + 1, _with(group, norm, "unknown", "s")
                )
            alone = self._previous() == "NP" and (
                self.norms[self.chunks[-1].start : at] in _THIRD_PERSONS
                or self.chunks[-1].value.pronoun in ("nothing", "everyone")
            )
            if alone and i == at and norm.endswith("s") and len(norm) > 3 and norm.isalpha() and norm not in PRONOUNS:
                return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "s"))
            if i == at and self._goes_on_with(at):
                return Chunk("TVERB", at, i + 1, _with(group, norm, "unknown", "s"))
            if self._previous() == "NP" and i == at and self.nouns.is_verb(at):
                return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "s"))
            return self._unknown_participle(at, i, group)
        lays = norm == "lay" and group.modal is not None  # 'you may lay it there'
        found = _with(group, "lay", form.kind, "base") if lays else _with(group, form.lemma, form.kind, form.form)
        end = i + 1
        apart = self.norms[end] in PARTICLES and (self.norms[end] != "over" or form.lemma in _TURNING_OVER)
        if form.kind == "posture" and apart and self.nouns.is_determiner(end + 1):
            end += group.past or self.norms[i - 1] in ("have", "has", "had", "'ve")
        if form.lemma in _FALLING_OVER and self.norms[end] == "over" and not self.nouns.starts(end + 1):
            end += 1  # 'it has fallen over'
        phrasal = _PHRASAL.get((form.lemma, self.norms[end]))
        if phrasal is not None:
            found, end = _with(group, *phrasal, form.form), end + 1
            return Chunk("TVERB" if self.nouns.starts(end) else "VERB", at, end, found)
        if not helped and self._inverts(form.form, i):
            return Chunk("ADVERB", at, end, norm)
        if helped:
            if self.norms[first] == "do" and self._previous() in JOINT_TYPES | {"", "ADVERB"}:
                kind = "FIND" if norm in FIND_VERBS else "PUT" if norm in PUT_VERBS or form.kind == "posture" else "DO"
                return Chunk(kind, at, end, found)
            return self._finite(at, end, found)
        if norm == "left" and helped and self.nouns.is_determiner(end + (self.norms[end] in _RECEIVERS)):
            return Chunk("TVERB", at, end, _with(group, "leave", "posture", "past"))
        if norm == "left" and self._is_left_behind(i):
            return Chunk("PART", at, end, found)
        if norm == "left" and not self._leaves(i):
            return None
        if norm == "left":
            return Chunk("TVERB", at, end, _with(group, "leave", "posture", "past", past=True))
        taken = end + (self.norms[end] in ("up", "out", "off", "open"))
        if (
            norm in ("cut", "shut", "split")
            and self._previous() in JOINT_TYPES | {""}
            and self.nouns.is_determiner(taken)
        ):
            return Chunk("DO", at, taken, _with(group, norm, "other", "base"))
        after_be = [chunk.type for chunk in self.chunks if chunk.type != "ADVERB"][-1:] == ["BE"]
        if norm in ("put", "set", "spread") and after_be and self._predicate_after(i):
            return Chunk("PART", at, end, _with(group, norm, "posture", "participle"))  # 'are commonly put on it'
        if (
            norm in ("lay", "put", "set")
            and self._previous() in ("", "AND", "COMMA", "THEN", "CUT")
            and (
                self.nouns.is_determiner(end)
                or self.nouns.number(end) is not None
                or self.norms[end] in ("it", "them", "out", "down", "up")
                or (not self._previous() and self.nouns.is_noun(end))
            )
        ):
            end += self.norms[end] in ("out", "down", "up")
            return Chunk("PUT", at, end, _with(group, norm, "posture", "base"))
        if (
            norm in _BEGINNING
            and self.norms[end] in ("with", "by")
            and self._previous() in JOINT_TYPES | {"", "ADVERB"}
        ):
            return Chunk("DO", at, end + 1, found)
        if norm == "lay" and self.norms[end] == "out" and self._only_places() and self.nouns.starts(end + 1):
            return Chunk("PUT", at, end + 1, _with(group, "lay", "posture", "base"))  # 'right of it lay out the probes'
        if norm == "lay" and self._previous() == "NP" and self.norms[at - 1] in ("you", "we"):
            return self._finite(at, end, _with(group, "lay", "posture", "base"))  # 'then you lay the spoon beside it'
        if norm in PAST_ONLY and not (norm == "saw" and self.nouns.is_noun(i)):
            return self._finite(at, end, _with(group, form.lemma, form.kind, "past", past=True))
        if norm == "chose" and self._previous() in ("", "COMMA", "AND", "CUT") and self.nouns.is_determiner(end):
            return Chunk("FIND", at, end, found)
        if form.form == "past" and form.kind in ("posture", "lean") and self._previous() == "NP" and not helped:
            subject = self.chunks[-1].value
            if subject.pronoun in ("me", "we", "he", "she") and not subject.head and self.nouns.starts(end):
                return self._finite(at, end, found)  # 'I hung the mirror on the pole'
        if form.form == "past" and self._in_relative_clause():
            return self._finite(at, end, found)  # 'a bench on which the cat slept'
        subject = self.chunks[-1].value if self._previous() == "NP" else None
        person = subject is not None and last_word(subject.head) in PEOPLE and self.nouns.is_determiner(end)
        handled = person or self.norms[end] in ("it", "them", "him", "us")
        owned = handled and form.form == "past" and subject is not None
        if owned or (
            form.form == "past" and self._previous() == "NP" and self.norms[self.chunks[-1].start] in _SUBJECTS
        ):
            return self._finite(at, end, found)  # 'the cups you asked about'
        if (
            form.form == "past"
            and form.kind == "transitive"
            and self._previous() == "NP"
            and self.norms[at - 1] == "it"
        ):
            return self._finite(at, end, replace(found, past=True))  # 'it contained a tin'
        placed = self.norms[end] in ("on", "in", "into", "against", "between")
        if norm == "set" and self._previous() == "COMMA" and placed:
            return Chunk("PART", at, end, _with(group, "set", "posture", "participle"))  # 'the jug, set on its tile'
        ones = self.norms[end] in ("one", "ones") and form.form in ("past", "participle")
        if ones and self._previous() in JOINT_TYPES | {"", "PREP"}:
            return None  # 'and used ones go into the box'
        if form.form in ("past", "participle", "ing"):
            if self._previous() in ("PREP", "OF", "WITH", "THAN", "TVERB", "FIND", "PUT") and self.nouns.is_noun(end):
                return None
            named = self.nouns.is_noun(end) and self.norms[end + 1] in IS_FORMS | MODALS.keys()
            if (
                self._previous() in ("", "COMMA")
                and form.form == "past"
                and named
                and not self.nouns.is_determiner(end)
            ):
                return None  # 'finished pieces are on it'
            goes = self._verbs.get(self.norms[end + 1])
            begins = not self._previous() and form.form == "past" and self.nouns.is_noun(end)
            if begins and (is_adjective(norm) or (goes is not None and goes.form in ("s", "base") and not helped)):
                return None  # 'used tea bags'
            if norm in ("lay", "put", "set") and self._previous() in ("", "AND", "COMMA", "THEN", "ADVERB", "CUT"):
                return Chunk("PUT", at, end, found)
            if self.nouns.is_noun(i) and self._previous() != "NP":
                return None
            active = form.form in ("past", "participle") and form.lemma in TRANSITIVE_RELATIONS
            if active and self._previous() == "NP" and self._takes_object(form.kind, end):
                return self._finite(at, end, replace(found, past=True))  # 'the jars beside it held ink'
            end += self.norms[end] in ("back", "out", "up", "down") and self._measure(end + 1) is not None
            return Chunk("TPART" if self._takes_object(form.kind, end) else "PART", at, end, found)
        if norm == "open" and self._previous() == "VERB":
            return None  # 'stands open on the sideboard'
        if norm in ("set", "put", "spread") and self._previous() == "BE":
            return Chunk("PART", at, end, found)
        if form.form == "base":
            adverb = self.chunks[-1].value if self._previous() == "ADVERB" else None
            subject = (
                "NP" if adverb == "such as" else self._previous()
            )  # 'items such as soap and sponges go in the tin'
            subject_is_you = subject == "NP" and self.norms[self.chunks[-1].start] == "you"
            if subject_is_you and not _RARELY.isdisjoint(group.adverbs):
                return self._finite(at, end, found)  # 'you rarely find the stapler there'
            if (
                norm in FIND_VERBS
                and norm in ("choose", "select", "pick", "find", "click", "locate", "hit")
                and subject == "NP"
                and (self.nouns.is_determiner(end) and not self.chunks[-1].value.plural)
            ):
                return Chunk("FIND", at, end, found)
            if subject_is_you and norm in PUT_VERBS and len(self.chunks) > 1 and self.chunks[-2].type == "SUB":
                return self._finite(at, end, found)  # 'before you put the cup on it'
            imperative = subject in ("", "AND", "COMMA", "THEN", "ADVERB", "CUT", "COLON", "SUB", "BUT") or (
                subject_is_you
            )
            imperative = imperative or (norm in PUT_VERBS and self.nouns.is_determiner(end) and self._only_places())
            imperative = imperative or (subject == "OR" and norm in PUT_VERBS and self.norms[end] in ("it", "them"))
            if imperative and norm in FIND_VERBS and self.norms[end] == "and" and self.norms[end + 1] in FIND_VERBS:
                return Chunk("ADVERB", at, end + 1, norm)
            owns = norm == "have" and self.norms[end] == "no"
            if subject == "COMMA" and self._awaits_verb() and (owns or self._predicate_after(i)):
                return self._finite(at, end, found)  # 'the tweezers, points to the left, lie along the edge'
            crosses = (
                self.norms[end] in ("over", "across", "round", "around", "on", "along") and self.norms[end + 1] == "to"
            )
            if imperative and norm in _CROSSING and (crosses or self.norms[end] == "to"):
                return Chunk("GO", at, end, found)  # 'move over to the other side'
            starts = norm in ("start", "begin") and self.norms[end] in ("at", "in", "on") and not self._previous()
            if starts:
                return Chunk("GO", at, end, found)  # 'start at the back'
            if imperative and not subject_is_you and norm in _GOING and self._goes(end):
                end += self.norms[end] in ("back", "away", "aside", "here")
                return Chunk("GO", at, end, found)
            if imperative and not subject_is_you and norm in NAMED_LIKE_THINGS and self.nouns.is_noun(i):
                return None
            if imperative and self._inverted_in_statement(i, end):
                return Chunk("VERB", at, end, found)  # 'it is on the left, and behind it stand the lilies'
            if imperative and (norm in PUT_VERBS or norm in FIND_VERBS) and self._imperative_object(end):
                kind = "FIND" if norm in FIND_VERBS else "PUT"
                if norm in ("pick", "point", "look", "single", "search") and self.norms[end] in (
                    "out",
                    "for",
                    "to",
                    "up",
                ):
                    end += 1
                if norm == "turn" and self.norms[end] in ("on", "off"):
                    return Chunk("DO", at, end + 1, found)
                if (
                    kind == "PUT"
                    and self.norms[end] in ("out", "up", "down", "back", "away")
                    and self.nouns.starts(end + 1)
                ):
                    end += 1
                return Chunk(kind, at, end, found)
            if imperative and norm in ("look", "search") and self.norms[end] == "for":
                return Chunk("FIND", at, end + 1, found)
            if imperative and norm == "face" and self.nouns.turns(i):
                return Chunk("PUT", at, end, _with(group, "turn", "posture", "base"))
            if imperative and norm in FACE_VERBS and not subject_is_you:
                if norm in ("look", "turn") and self.norms[end] in ("at", "to", "toward", "towards"):
                    end += 1
                return Chunk("TPART", at, end, found)
            if imperative and norm in _INTRANSITIVE and self.nouns.is_determiner(end):
                return Chunk("VERB", at, end, found)  # 'on the table, whose top is oak, lie a loaf and a knife'
            ordered = self.nouns.is_determiner(end) or self._acts_on(i, end, form.kind)
            if imperative and not subject_is_you and ordered:
                return Chunk("DO", at, end, found)
            if subject == "REL":
                return self._finite(at, end, found)
            if subject not in ("NP", "AND") or self.nouns.is_noun(i):
                return None
            return self._finite(at, end, found)
        if self.nouns.is_noun(i) and self._previous() not in ("NP", "REL"):  # third person
            return None
        return self._finite(at, end, found)

    def _inverted_in_statement(self, at: int, end: int) -> bool:
        """Return True for *stand* after a place and before a plural, in a sentence of statements about things."""
        last = next((c for c in reversed(self.chunks) if c.type in FINITE | {"PUT", "CUT", "DO"}), None)
        resting = (
            last is not None and last.type in FINITE and self.norms[at] in ("stand", "hang", "rest", "lean", "sit")
        )
        found = self.nouns.phrase(end, "VERB") if resting and self._only_places() and self.nouns.starts(end) else None
        return found is not None and found[1] is not None and found[1].plural and bool(found[1].head)

    def _goes_on_with(self, at: int) -> bool:
        """Return True for an unknown verb after *and* with its object: *each sets a boat on it and takes a crate*."""
        norm, last = self.norms[at], next((c for c in reversed(self.chunks) if c.type in FINITE | {"CUT"}), None)
        if self._previous() != "AND" or last is None or last.type == "CUT" or last.value.form != "s":
            return False
        known = self.nouns.is_known_noun(norm) or self.nouns.is_determiner(at) or norm in PRONOUNS
        known = known or not norm.endswith("s") or norm.endswith("ss") or not norm.isalpha()
        return not known and (self.nouns.is_determiner(at + 1) or self.nouns.number(at + 1) is not None)

    def _tried(self, at: int, i: int, group: VerbGroup) -> Chunk | None:
        """Return the verb of a word that is tried as one: a command where a clause begins, and finite elsewhere."""
        form = self._verbs.get(self.norms[i])
        lemma, kind = (self.norms[i], "unknown") if form is None else (form.lemma, form.kind)
        plain = form is None or form.form == "base"
        end = i + 1
        if i == at and plain and self._previous() in JOINT_TYPES | {"", "ADVERB"}:
            end += self.norms[end] in PARTICLES and self.nouns.starts(end + 1)
            if self.nouns.starts(end):
                return Chunk("PUT", at, end, _with(group, lemma, "posture", "base"))
            return Chunk("GO", at, end, _with(group, lemma, kind, "base")) if self._predicate_after(i) else None
        if self._previous() not in FINITE | {"NP", "REL", "ADVERB"}:
            return None
        found = _with(group, lemma, kind, "s" if form is None else form.form)
        return Chunk("TVERB" if self._takes_object(kind, end) else "VERB", at, end, found)

    def _inverts(self, form: str, at: int) -> bool:
        """Return True for the participle of *at its left end is bolted the vice*, before its subject."""
        if form not in ("past", "participle", "ing") or self._previous() != "BE" or len(self.chunks) < 2:
            return False
        if not (self.nouns.is_determiner(at + 1) or self.nouns.number(at + 1) is not None):
            return False
        first = len(self.chunks) - 1
        while first > 0 and self.chunks[first - 1].type not in JOINT_TYPES:
            first -= 1
        before = [chunk.type for chunk in self.chunks[first:-1]]
        return (
            bool(before)
            and before[0] in ("PREP", "ADV")
            and before.count("NP") <= before.count("PREP") + (before.count("OF"))
        )

    def _finite(self, at: int, end: int, group: VerbGroup) -> Chunk:
        if (
            group.lemma in FACE_VERBS | {"come", "walk", "go", "step", "get"}
            and self.norms[end] == "in"
            and (not self.nouns.starts(end + 1) or self.norms[end + 1] == "there")
        ):
            return Chunk("VERB", at, end + 1, _with(group, "enter", "other", group.form))
        if group.lemma == "look" and self.norms[end] in ("at", "toward", "towards"):
            return Chunk("TVERB", at, end + 1, group)
        if group.lemma in LINKING_VERBS and self._is_quality(end):  # 'the vase looks lovely on the shelf'
            past = group.past or group.form == "past"
            return Chunk("BE", at, end, _with(group, "be", "be", "finite", past=past))
        stands = (
            group.kind in ("posture", "lean")
            and group.lemma not in PUT_ONLY
            and group.form in ("s", "past", "base")
            and group.lemma not in TRANSITIVE_RELATIONS
        )
        subject = self.norms[self.chunks[-1].start] if self.chunks else ""
        if stands and subject not in ("i", "you", "we", "they"):
            return Chunk("VERB", at, end, group)
        return Chunk("TVERB" if self._takes_object(group.kind, end) else "VERB", at, end, group)

    def _is_quality(self, at: int) -> bool:
        """Return True for an adjective after a verb such as *looks*, and False for *directly at the door*."""
        norm, after = self.norms[at], self.norms[at + 1]
        manner = norm.endswith("ly") and after in ("at", "to", "toward", "towards", "into", "over", "out", "down", "up")
        if self.norms[at : at + 3] == ["out", "of", "place"]:
            return True
        places = norm in prepositions() or norm in places_alone()
        form = self._verbs.get(norm)
        participle = form is not None and form.form in ("past", "participle")  # 'it looks lost on the shelf'
        return not places and not manner and (is_adjective(norm) or norm.endswith("ly") or participle)

    def _takes_object(self, kind: str, at: int) -> bool:
        if not self.nouns.starts(at) or self._alone.longest(self.norms, at) is not None or self._match(at) is not None:
            return False
        if self.norms[at] in ("later", "earlier") and self.norms[at + 1] in prepositions():
            return False
        if self.norms[at] == "one" and self.norms[at + 2] in ("each", "either"):
            return False
        if self._relator(at) is not None or self._measure(at) is not None:
            return False
        if self.norms[at] in ("left", "right", "up", "down", "back", "forward", "forwards") and not self.nouns.starts(
            at + 1
        ):
            return False
        if self.nouns.number(at) is not None and self.norms[at + 1] in LAYERS:
            return False
        if (self.norms[at], self.norms[at + 1]) in (("face", "up"), ("face", "down")):
            return False  # 'the card is turned face up'
        found = self.nouns.phrase(at, "TVERB")
        return found is not None and found[1] is not None

    def _unknown_participle(self, at: int, i: int, group: VerbGroup) -> Chunk | None:
        """Return the participle of a verb that no table holds: *the window shrouded in fog*."""
        norm = self.norms[i]
        previous = self._previous()
        modifies = norm.endswith("ed") and self.nouns.is_noun(i + 1) and not is_adjective(self.norms[i + 1])
        if self.nouns.is_participle_of_one(i) or modifies:
            return None  # 'berries and fresh-squeezed juice'
        if previous == "ADVERB" and len(self.chunks) > 1 and self.chunks[-2].type in ("COMMA", "BE"):
            previous = self.chunks[-2].type  # 'a loaf, perfectly preserved'
        if (
            len(norm) < 5
            or not norm.endswith(("ed", "ing"))
            or norm.endswith("eed")
            or previous not in ("NP", "BE", "COMMA", "AND", "REL", "NOT")
            or norm in PRONOUNS
        ):
            return None
        if previous == "NP" and len(self.chunks) > 1 and self.chunks[-2].type == "REL" and norm.endswith("ed"):
            return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "past"))
        if previous == "NP" and self.norms[self.chunks[-1].start] in _SUBJECTS and norm.endswith("ed"):
            kind = "TVERB" if self.nouns.starts(i + 1) else "VERB"
            return Chunk(kind, at, i + 1, _with(group, norm, "unknown", "past", past=True))
        ends = self.norms[i + 1] in CLAUSE_ENDS and norm.endswith("ed")
        if ends and [chunk.type for chunk in self.chunks[-2:]] in (["BUT", "NP"], ["SUB", "NP"]):
            return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "past", past=True))  # 'but my neck ached'
        if self.nouns.is_noun(i) or (previous != "BE" and self.nouns.is_noun(i)):
            return None
        return Chunk("PART", at, i + 1, _with(group, norm, "unknown", "ing" if norm.endswith("ing") else "past"))

    def _in_relative_clause(self) -> bool:
        """Return True after a relative pronoun and a noun phrase, which are followed by a finite verb."""
        before = [chunk.type for chunk in self.chunks[-3:]]
        which = before == ["PREP", "NP", "NP"] and self.chunks[-2].value.pronoun == "which"
        return which or before[1:] == ["REL", "NP"]

    def _orders(self, at: int) -> bool:
        """Return True for the verb of a command after an adverb: *now lower the lid*."""
        return (
            self._previous() in JOINT_TYPES | {""}
            and self.norms[at] in NAMED_LIKE_THINGS
            and self.nouns.is_determiner(at + 1)
        )

    def _awaits_verb(self) -> bool:
        """Return True if the clause has a plural subject, something between commas and no verb yet."""
        first = max((k + 1 for k, c in enumerate(self.chunks) if c.type in JOINT_TYPES - {"COMMA"}), default=0)
        types = [chunk.type for chunk in self.chunks[first:]]
        subject = types[:2] == ["NP", "COMMA"] and self.chunks[first].value.plural
        return subject and len(types) > 3 and not (FINITE | {"PUT", "FIND", "DO"}) & set(types)

    def _goes(self, at: int) -> bool:
        """Return True if a place and not an object follows a command such as *stand* or *sit*."""
        if self._previous() in ("AND", "COMMA") and not any(c.type in ("PUT", "DO", "GO") for c in self.chunks):
            return False
        after = self.norms[at]
        return after in ("back", "away", "aside", "here") or (
            after not in ("for", "at", "to") and not self.nouns.is_determiner(at) and self._relator(at) is not None
        )

    def _acts_on(self, at: int, end: int, kind: str) -> bool:
        """Return True for a verb of action before its object without an article: *rinse cups in the sink*."""
        acts = kind == "other" and not self.nouns.is_noun(at) and not self.nouns.is_known_noun(self.norms[at])
        return acts and self.nouns.starts(end)

    def _imperative_object(self, at: int) -> bool:
        bound = self.norms[at : at + 2] in (["at", "least"], ["at", "most"]) and self._measure(at) is None
        bound = bound and self.nouns.number(at + 2) is not None
        return bound or self.nouns.starts(at) or self.norms[at] in ("out", "for", "on", "to", "up", "both", "all")

    def _auxiliary(self, at: int) -> bool:
        norm = self.norms[at]
        if norm in ("do", "does", "did"):
            return self.norms[at + 1] in NEGATIONS or self._verbs.get(self.norms[at + 1]) is not None or at == 0
        return norm in IS_FORMS or (norm in MODALS and self._modal(at)) or norm in ("has", "have", "had")

    def _modal(self, at: int) -> bool:
        """Return True for a modal verb; *can*, *will* and *need* are other words too."""
        after = self.norms[at + 1]
        if self.norms[at] == "need" or self.norms[at] == "needs":
            return after in ("to", "not")
        if self.norms[at] not in ("can", "may", "will", "might"):
            return True
        form = self._verbs.get(after)
        if self.norms[at] != "can" and self._previous() == "NP" and self._is_unknown_verb(at + 1):
            return True
        if (
            self._previous() in ("NP", "REL")
            and self.chunks
            and self.norms[self.chunks[-1].start] in ("you", "we", "i", "it")
        ):
            return True
        return (
            after in ("be", "not", "have", "well", "also", "only", "you", "usually", "never", "ever", "the", "i", "it")
            or (form is not None and form.form == "base" and not (self.norms[at] == "can" and self._is_can(at + 1)))
            or after in HEDGES
            or (after in ADVERBS and self.norms[at + 2] == "be")
        ) and not (self.norms[at] == "can" and after in ("the", "it", "i") and self._previous() == "NP")

    def _is_unknown_verb(self, at: int) -> bool:
        """Return True for a word after a modal verb that no table holds, and that can only be a verb there."""
        norm = self.norms[at]
        return norm.isalpha() and not norm.endswith(("s", "ed", "ing", "ly")) and not is_known(norm)

    def _is_can(self, at: int) -> bool:
        """Return True for a word after *can* that may be a noun: *the can rest*; False for *can stand on it*."""
        return self.norms[at] in NOUNS_TOO and not self._predicate_after(at + (self.norms[at + 1] in ADVERBS))

    def _perfect(self, at: int) -> bool:
        i = at + 1
        while self.norms[i] in ADVERBS or self.norms[i] in NEGATIONS:
            i += 1
        if self.norms[i] == "been":
            return True
        form = self._verbs.get(self.norms[i])
        if form is None:
            return self.norms[i].endswith("ed") and not self.nouns.is_noun(i)
        if self.norms[i] in ("put", "set", "cut", "hit", "let") and self.norms[at] != "having":
            i += self.norms[i + 1] in PARTICLES
            return self.nouns.starts(i + 1) or self.norms[i + 1] in prepositions()
        if self.norms[i] == "left":
            return self.nouns.is_determiner(i + 1 + (self.norms[i + 1] in _RECEIVERS))  # 'have left you a cake'
        return form.form in ("past", "participle") and self.norms[i] != "set"

    def _goes_on(self, at: int) -> bool:
        norm = self.norms[at]
        return (
            norm in IS_FORMS or norm in self._verbs or norm in NEGATIONS or (norm in ADVERBS and self._goes_on(at + 1))
        )


_RARELY = word_set("rarely seldom hardly scarcely")

_GETTING = word_set("get gets got getting")
"""Verbs that make a passive, as *be* does."""

_RECEIVERS = word_set("you me him her us them")
"""Pronouns between a verb and its object: *left you a cake*."""

_TOLD = word_set("it they he she there")

LAYERS = frozenset({"high", "deep", "abreast"})

_THIRD_PERSONS = (["it"], ["he"], ["she"])

_SUBJECTS = word_set("i you we he she they")
"""Pronouns before which no participle stands: the verb after them is finite."""

_HEDGES_OF_PLACES = word_set("about around roughly approximately approx almost nearly")
"""Hedges that belong to the place or the measure after them, and not to the verb."""

_ACTING = frozenset({"will", "would", "could", "may", "might"})
"""Modal verbs after which a word that no table holds is a verb."""

_UNREAL = frozenset({"must", "may", "ought", "should", "could", "would", "might"})
"""Modal verbs that, before *have*, say what was not."""

_TENDING = {
    "supposed": "should", "meant": "should", "intended": "should", "allowed": "can", "permitted": "can",
    "about": "would", "going": "will", "likely": "might", "required": "must",
    **dict.fromkeys(
        ("said", "believed", "thought", "rumoured", "rumored", "reported", "alleged", "reputed", "presumed", "assumed",
         "claimed", "understood", "expected", "unlikely", "hoped", "feared", "suspected"), "might",
    ),
}  # fmt: skip
"""Modal verb that a word between *is* and *to* amounts to: *is allowed to stand*."""

_GOING = word_set("stand sit step walk go kneel stay wait look")
"""Verbs of commands that take no object."""

_INTRANSITIVE = word_set("lie sit kneel come go rise live dwell")
"""Verbs of a state or a motion without an object; before a noun phrase they come before their subject."""

_CROSSING = word_set("move go walk come head step turn")
"""Verbs of commands that send the reader somewhere."""

_TURNING_OVER = word_set("turn tip roll fold flip fall push pull")
"""Verbs of which *over* is a part."""

_BEGINNING = word_set("start begin finish continue proceed end")

_PHRASAL = {("make", "out"): ("see", "posture"), ("take", "up"): ("occupy", "transitive")}
"""Verbs with a particle: the verb and the kind that they amount to."""

PARTICLES = word_set("off up down out away over")
