"""Find commas, conjunctions and relative pronouns, which join clauses and noun phrases."""

from __future__ import annotations

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator
from deixis.grammar.english.chunking.relators import CLAUSE_ENDS
from deixis.grammar.english.chunking.verb_groups import VerbChunker
from deixis.grammar.english.tagging.word_classes import is_known
from deixis.grammar.english.tree import NounPhrase
from deixis.grammar.english.vocabulary.adjectives import EMPTY, is_adjective
from deixis.grammar.english.vocabulary.function_words import ADVERBS, IS_FORMS, MODALS, NEGATIONS, PRONOUNS
from deixis.grammar.english.vocabulary.nouns import EVENTS, PEOPLE, last_word
from deixis.grammar.english.vocabulary.relation_words import Preposition, prepositions
from deixis.grammar.english.vocabulary.tables import word_set

SUBORDINATORS = word_set(
    "wherever if when while because since unless although though once so where whereas until whether whenever"
)


class JointChunker(VerbChunker):
    """Finder of joints."""

    def _joint(self, at: int) -> Chunk | None:
        norm, after = self.norms[at], self.norms[at + 1]
        previous = self._previous()
        before = self.chunks[-2].type if len(self.chunks) > 1 else ""
        after_verb = previous in FINITE or previous == "DO" or (previous in ("PART", "ADJP") and before == "BE")
        after_verb = after_verb or (previous in ("ADV", "ADVERB") and before in ("VERB", "TVERB"))
        if norm == "that" and after_verb and (after in PRONOUNS or self.nouns.starts(at + 1)):
            return Chunk("COMPLEMENT", at, at + 1)
        if norm == "that" and previous == "AND" and self._clause_follows(at + 1):
            if any(chunk.type == "COMPLEMENT" for chunk in self.chunks):
                return Chunk("COMPLEMENT", at, at + 1)  # 'he says that A and that B'
            if any(chunk.type == "ADVERB" and chunk.value in _ENSURING for chunk in self.chunks):
                return Chunk("ADVERB", at, at + 1, norm)  # 'make sure that A and that B'
        if norm == "that" and previous in ("NP", "COMMA", "ADV", "AND") and not self._demonstrative(at):
            return Chunk("REL", at, at + 1)
        follows_noun = previous == "NP" or (previous in ("COMMA", "ADV") and norm != "where")
        if norm in ("which", "who", "whom", "where") and follows_noun and at > 0:
            return Chunk("REL", at, at + 1, norm)
        if (norm == "unlike" and not previous) or (
            not previous and (norm, after) in (("instead", "of"), ("rather", "than"))
        ):
            return Chunk("SUB", at, at + (1 if norm == "unlike" else 2), "instead")
        stands = norm == "that" and self._verbs.get(after) is not None and self._verbs[after].kind == "posture"
        ends = self.nouns.is_determiner(at + 1) or after in ("", ",", ".", ";") or stands
        ends = ends or after in IS_FORMS or after in ("you", "we", "i", "there")
        if norm == "that" and previous == "PREP" and ends:
            return Chunk("NP", at, at + 1, NounPhrase((self.words[at].start, self.words[at].end), pronoun="this"))
        if (
            norm == "from" and previous == "NP" and after in ("getting", "being", "coming", "going")
            and any(c.type == "PUT" and c.value.lemma == "keep" for c in self.chunks)
        ):  # fmt: skip
            return Chunk("NOT", at, at + 2)  # 'keep the bleach from getting near the food'
        if norm in ("before", "after") and self._is_event(at + 1):
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "-")))  # 'before your first shift'
        if (norm, after) in _EXCEPTING and (
            (previous in ("", "COMMA", "CUT") and norm in ("apart", "aside"))
            or (previous == "ADJP" and self.chunks[-1].value[-1].word in EMPTY)
        ):  # 'apart from the lid, …', 'the tray is empty apart from a spoon'
            return Chunk("PREP", at, at + 2, Relator(Preposition("except for", "-")))
        agent = after in ("a", "an") and self.norms[at + 2] in PEOPLE and previous == "NP"
        if norm == "by" and (agent or self._is_name(at + 1)):
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "-")))  # 'a seascape by Turner'
        form = self._verbs.get(self.norms[at + 2])
        if (norm, after) == ("far", "from") and form is not None and form.form == "ing":
            return Chunk("NOT", at, at + 2)  # 'far from lying on the saucer'
        if norm == "yet" and self.norms[at - 1] in NEGATIONS:
            return Chunk("ADVERB", at, at + 1, norm)  # 'the neck, not yet glued, …'
        if norm == "whose":
            return Chunk("WHOSE", at, at + 1)
        if norm == "once" and previous == "REL":
            return Chunk("ADVERB", at, at + 1, norm)  # 'the seal that once hung from it'
        if norm in ("where", "how", "why") or (norm == "when" and after in IS_FORMS):
            return Chunk(
                "WHERE" if norm == "where" and (after in IS_FORMS or after in MODALS) else "SUB", at, at + 1, norm
            )
        if norm == "there" and (
            after in IS_FORMS
            or (after == "used" and self.norms[at + 2] == "to")
            or after in ("'ll", "should", "must", "will", "can", "could", "may", "might", "shall", "would")
            or (previous in FINITE and at == 1)
            or (after in _THERE_STANDS and self._previous() in JOINT_TYPES | {"", "ADVERB"})
        ):
            return Chunk("THERE", at, at + 1)
        if norm == "out" and after == "of" and previous in ("", "COMMA", "ADVERB", "CUT"):
            return Chunk("PREP", at, at + 2, Relator(Preposition("out of", "among")))
        if (
            norm in ("to", "against", "toward", "towards")
            and previous == "BE"
            and len(self.chunks) > 1
            and self._is_back(self.chunks[-2])
        ):
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "back_to")))
        directed = bool({self.norms[at + 1], self.norms[at + 2], self.norms[at + 3]} & _LATERAL)
        if norm in ("from", "to") and previous == "MEASURE" and self.nouns.starts(at + 1) and not directed:
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "measured_from")))
        if norm == "to" and previous == "THAN":
            return Chunk("ADVERB", at, at + 1, norm)
        if (
            norm in ("neither", "either", "both")
            and not (norm == "both" and previous == "PUT")
            and (after in prepositions() or self._match(at + 1) or (previous == "BE" and is_adjective(after)))
        ):
            return Chunk("NOT" if norm == "neither" else "ADVERB", at, at + 1, norm)
        if norm == "of":
            if previous == "MEASURE":
                return Chunk("PREP", at, at + 1, Relator(Preposition("of", "measured_from")))
            if previous in ("", "COMMA", "CUT") or (previous == "ADVERB" and len(self.chunks) == 1):
                return Chunk("PREP", at, at + 1, Relator(Preposition("of", "among")))
            return Chunk("OF", at, at + 1)
        if norm == "in" and self.nouns.is_colour_alone(at + 1):
            return Chunk("ADVERB", at, at + 1, "in")
        if (
            norm == "as"
            and previous == "NP"
            and (
                self.chunks[-1].value.determiner == "same"
                or any(a.word == "same" for a in self.chunks[-1].value.adjectives)
            )
        ):
            return Chunk("PREP", at, at + 1, Relator(Preposition("as", "as")))
        if norm == "than" and after in ("i", "you", "we", "he", "she", "usual", "expected", "necessary", "one"):
            stops = (k for k in range(at + 2, len(self.words)) if self.norms[k] in CLAUSE_ENDS | {"and", "but"})
            end = next(stops, len(self.words))
            if after in ("usual", "expected", "necessary") or any(norm in MODALS for norm in self.norms[at + 2 : end]):
                return Chunk("ADVERB", at, end, "than")  # 'closer to it than I'd like'
        if norm == "than":
            return Chunk("THAN", at, at + 1)
        form = self._verbs.get(after)
        participial = form is not None and form.form in ("past", "participle") and previous in ("COMMA", "")
        if norm == "as" and participial and self.norms[at + 2] not in IS_FORMS:
            return Chunk("ADVERB", at, at + 2, "as told")  # 'as left on Friday'
        reason = norm == "as" and after not in PRONOUNS and self._clause_follows(at + 1)
        if reason and (previous == "COMMA" or (not previous and self._is_state(at + 1))):
            return Chunk("SUB", at, at + 1, "because")  # 'behind the jar, as guests should not see it'
        if norm == "as" and after in ("you", "if", "seen", "viewed", "one", "i", "we"):
            return Chunk("SUB", at, at + 1, "as")
        excepting = previous == "NP" and self.chunks[-1].value.pronoun in _ALL
        about = (
            norm == "about"
            and previous in ("BE", "NP")
            and self.nouns.starts(at + 1)
            and self.nouns.number(at + 1) is None
        )
        if norm == "about" and previous == "PART" and self.nouns.starts(at + 1):
            return Chunk("PREP", at, at + 1, Relator(Preposition("about", "around")))  # 'scattered about it'
        if (norm == "but" and excepting) or about:
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "-")))
        if norm == "then" and self._goes_on_after(at):
            return Chunk("ADVERB", at, at + 1, norm)
        if norm in _CONJUNCTIONS:
            return Chunk(_CONJUNCTIONS[norm], at, at + 1, norm)
        if tuple(self.norms[at : at + 3]) in _SUBORDINATING:
            return Chunk("SUB", at, at + 3, "when")
        if (norm, after) == ("so", "that"):
            return Chunk("SUB", at, at + 2, "so")
        if (norm, after) == ("except", "that"):
            return Chunk("CUT", at, at + 2)
        if (norm, after) == ("in", "case"):
            return Chunk("SUB", at, at + 2, "in case")
        if tuple(self.norms[at : at + 2]) in _SUBORDINATING:
            return Chunk("SUB", at, at + 2, "if")
        if at == 0 and norm in ("suppose", "assume", "imagine") and any(word in IS_FORMS for word in self.norms):
            return Chunk("SUB", at, at + 1 + (after == "that"), "if")
        if at == 0 and norm == "let" and "be" in self.norms:
            return Chunk("ADVERB", at, at + 1, norm)
        if norm == "cause" and (after in PRONOUNS or after in ("there", "theres")):
            return Chunk("SUB", at, at + 1, "because")
        if norm == "so" and previous in FINITE and (is_adjective(after) or self._match(at + 1) is not None):
            return None  # 'stood so close to it'
        if norm == "otherwise" and previous == "SUB":
            return Chunk("ADVERB", at, at + 1, norm)  # 'because otherwise it falls'
        if norm in ("whoever", "whomever") and previous == "PREP" and after in self._verbs:
            span = self.words[at].start, self.words[at + 1].end
            return Chunk("NP", at, at + 2, NounPhrase(span, pronoun="someone"))  # 'in front of whoever leads'
        if norm in ("whatever", "whichever") and not previous and "," in self.norms[at + 2 : at + 8]:
            return Chunk("SUB", at, at + 1, norm)  # 'whatever she says, the box is under the chair'
        if norm in ("whatever", "whichever") and (last := self._end_of_free_relative(at + 1)) is not None:
            span = self.words[at].start, self.words[last - 1].end
            return Chunk("NP", at, last, NounPhrase(span, pronoun=norm))  # 'whatever I have used goes into it'
        if norm == "without" and (form := self._verbs.get(after)) is not None and form.form == "ing":
            return Chunk("NOT", at, at + 1, norm)  # 'without touching the plate'
        if norm in _WHOEVER:
            return Chunk("SUB", at, at + 1, "if")
        if norm in SUBORDINATORS:
            return Chunk("SUB", at, at + 1, norm)
        if norm == "before" and after in ("me", "us") and previous in JOINT_TYPES | {"", "ADVERB"}:
            return None  # 'before me lies the book'
        if norm in ("before", "after") and previous in FINITE and self.chunks[-1].value.lemma == "come":
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "-")))  # 'the salad fork comes before it'
        if norm in ("before", "after") and (
            after in ("you", "we", "i")
            or after.endswith("ing")
            or (self._clause_follows(at + 1) and not (norm == "before" and self._inverted_to_the_end(at + 1)))
        ):
            return Chunk("SUB", at, at + 1, norm)
        return None

    def _inverted_to_the_end(self, at: int) -> bool:
        """Return True for a place at the beginning and its subject at the end: *before the jug lies the cup*."""
        rest = self.norms[at : next((k for k in range(at, len(self.norms)) if self.norms[k] == "."), len(self.norms))]
        verbs = [k for k, word in enumerate(rest) if word in _LYING]
        return not self.chunks and "," not in rest and bool(verbs) and self.nouns.is_determiner(at + verbs[0] + 1)

    def _goes_on_after(self, at: int) -> bool:
        """Return True for *then* inside a clause: *the lid is then placed on it*, *the cook then puts it on*."""
        after = self.norms[at + 1]
        form = self._verbs.get(after)
        if self._previous() == "BE":
            return (form is not None and form.form in ("past", "participle")) or after.endswith(("ed", "ly"))
        third = form is not None and form.form == "s" and not self.nouns.is_known_noun(after)
        return self._previous() == "NP" and (third or after in IS_FORMS or after in MODALS)

    def _is_event(self, at: int) -> bool:
        """Return True for a noun phrase that names an event: *your first shift*."""
        found = self.nouns.phrase(at, "PREP") if self.nouns.starts(at) else None
        return found is not None and found[1] is not None and last_word(found[1].head) in EVENTS

    def _clause_follows(self, at: int) -> bool:
        """Return True if a noun phrase with a verb after it begins here: *before the guests enter*."""
        found = self.nouns.phrase(at, "SUB") if self.nouns.starts(at) else None
        if found is None or found[1] is None:
            return False
        norm = self.norms[found[0]]
        form = self._verbs.get(norm)
        phrase, last = found[1], self.norms[found[0] - 1]
        unknown = last.endswith("s") and not last.endswith("ss") and found[0] - at > 2 and norm in CLAUSE_ENDS
        if unknown and phrase.plural and phrase.determiner == "the" and not self.nouns.is_known_noun(last):
            inner = self.norms[found[0] - 2]
            if self.nouns.is_known_noun(inner) and not is_adjective(inner) and not is_known(last):
                return True  # 'before the water boils'
        return (
            norm in IS_FORMS
            or norm in MODALS
            or (form is not None and form.form in ("s", "past", "base") and norm not in ("left", "set"))
        )

    def _is_state(self, at: int) -> bool:
        """Return True if the verb after the noun phrase that begins here is *is*: *as the bowl is on the left, …*."""
        found = self.nouns.phrase(at, "SUB") if self.nouns.starts(at) else None
        return found is not None and self.norms[found[0]] in IS_FORMS

    def _end_of_free_relative(self, at: int) -> int | None:
        """Return the end of *whatever I have used* before the verb of which it is the subject."""
        found = self.nouns.phrase(at, "SUB") if self.nouns.starts(at) or self.norms[at] in PRONOUNS else None
        i = at if found is None else found[0]
        while self.norms[i] in IS_FORMS | MODALS.keys() | ADVERBS or self.norms[i] in ("has", "have", "had", "'ve"):
            i += 1
        if self.norms[i] not in self._verbs and not self.norms[i].endswith("ed"):
            return None
        i += 1
        form = self._verbs.get(self.norms[i])
        third = form is not None and form.form == "s" and self._match(i + 1) is not None
        return i if third or self.norms[i] in IS_FORMS | MODALS.keys() else None

    def _is_name(self, at: int) -> bool:
        """Return True for a name without an article, as a person has it."""
        named = at < len(self.words) and self.nouns.is_name(at)
        return named and not self.nouns.is_determiner(at) and self.norms[at] not in PRONOUNS

    def _is_back(self, chunk: Chunk) -> bool:
        """Return True for *your back*."""
        return chunk.type == "NP" and chunk.value.head == "back" and chunk.value.owner is not None

    def _demonstrative(self, at: int) -> bool:
        """Return True if *that* stands for a thing or before a noun, and does not begin a relative clause."""
        if self._previous() in ("NP", "ADV"):
            return False
        after = self.norms[at + 1]
        return self._previous() == "AND" and after in IS_FORMS


_THERE_STANDS = word_set("stands stand lies lie hangs hang sits sit stood lay hung sat")
"""Verbs after *there* that say that something is there."""

_LYING = frozenset(["lies", "lie", "stands", "stand", "sits", "sit", "hangs", "hang", "is", "are"])
"""Verbs between a place and its subject."""
_CONJUNCTIONS = {"and": "AND", "plus": "AND", "or": "OR", "nor": "OR", "but": "BUT", "yet": "BUT", "then": "THEN"}

_SUBORDINATING = {
    ("as", "soon", "as"), ("as", "long", "as"), ("so", "long", "as"), ("even", "if"), ("only", "if"),
    ("provided", "that"), ("given", "that"),
}  # fmt: skip

_ENSURING = frozenset({"make sure", "make sure that", "be sure that", "ensure that", "note that", "remember that",
                       "check that", "see to it that", "do not forget that", "take care that"})  # fmt: skip
"""Beginnings of a command after which a clause is a fact."""

_EXCEPTING = frozenset({("apart", "from"), ("aside", "from"), ("but", "for")})
"""Words before what is excepted."""

_WHOEVER = word_set("otherwise whoever whatever whichever whomever")
"""Words for any person or thing of which the clause holds: it is a condition."""

_ALL = frozenset({"all", "everything", "nothing", "none", "anything"})

_LATERAL = frozenset({"left", "right"})
