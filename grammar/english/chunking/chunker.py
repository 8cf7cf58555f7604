"""Cut the words of a sentence into chunks: noun phrases, verb groups, prepositions, joints.

A word can have several categories (*left*, *stand*, *that*); the words beside it decide. The chunks are the terminals
of ``english.lark``.
"""

from __future__ import annotations

from dataclasses import replace

from deixis.grammar.english.chunking.chunk import FINITE, Chunk, VerbGroup
from deixis.grammar.english.chunking.fixed_phrases import FixedPhraseChunker
from deixis.grammar.english.chunking.relators import CLAUSE_ENDS
from deixis.grammar.english.chunking.verb_groups import PARTICLES
from deixis.grammar.english.tagging.word_classes import is_known
from deixis.grammar.english.tree import Adjective, Degree, NounPhrase
from deixis.grammar.english.vocabulary.adjectives import QUALITIES, adjectives, is_material_noun
from deixis.grammar.english.vocabulary.function_words import ADVERBS, HEDGES, NEGATIONS
from deixis.grammar.english.vocabulary.nouns import FIGURES, last_word
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, prepositions
from deixis.grammar.english.vocabulary.tables import word_set


class Chunker(FixedPhraseChunker):
    """Chunker of the words of one sentence."""

    def run(self) -> list[Chunk]:
        """Return the chunks of the sentence; every word is in one of them.

        Returns
        -------
        list of Chunk
            Chunks in the order of the text.
        """
        at, end = 0, len(self.words)
        while at < end:
            if (used := self._use(at)) is not None:
                self._name_used()
                at = used
                continue
            chunk = self._chunk(at)
            chunk.span = self.words[at].start, self.words[chunk.end - 1].end
            if chunk.type == "GO":  # 'stand back': you stand back
                start = chunk.span[0]
                you = NounPhrase((start, start), pronoun="you")
                self.chunks.append(Chunk("NP", at, at, you, (start, start)))
                chunk.type = "VERB"
            self.chunks.append(chunk)
            if self._object_left_out:
                here, self._object_left_out = (chunk.span[1], chunk.span[1]), False
                self.chunks.append(Chunk("NP", chunk.end, chunk.end, NounPhrase(here, pronoun="object"), here))
            at = chunk.end
            if self._denied_be is not None and chunk.type == "NP" and self.norms[at] not in ("of", "and", "or"):
                self.chunks.append(Chunk("BE", at, at, self._denied_be, (chunk.span[1], chunk.span[1])))
                self._denied_be = None
                if self.norms[at : at + 2] == ["to", "be"]:  # 'at no time are coats to be left on it'
                    span = self.words[at].start, self.words[at + 1].end
                    self.chunks.append(Chunk("ADVERB", at, at + 2, "to be", span))
                    at += 2
        return self.chunks

    def _chunk(self, at: int) -> Chunk:
        norm = self.norms[at]
        fixed = _PUNCTUATION.get(norm)
        if fixed is not None:
            return Chunk(fixed, at, at + 1)
        if self.norms[at : at + 1] and (end := self._denial(at)) is not None:
            return Chunk("ADVERB", at, end, "never")
        if norm in ("most", "more") and self.norms[at + 1].endswith("ly") and self.nouns.is_determiner(at + 2):
            return Chunk("ADVERB", at, at + 2, self.norms[at + 1])  # 'most traditionally the napkin lies on it'
        if (verb := self._causative(at)) is not None:
            self._made = verb
            return Chunk("ADVERB", at, at + 1, norm)
        if self._made is not None and at >= self._made - (norm == "to"):
            verb, self._made = self._made, None
            form = self._verbs[self.norms[verb]]
            return Chunk("VERB", at, verb + 1, VerbGroup(form.lemma, form.kind, "s"))
        for find in (self._measure, self._idiom, self._joint, self._relator, self._verb_group, self._noun_phrase):
            chunk = find(at)
            if chunk is not None:
                return chunk
        if norm in NEGATIONS:
            return Chunk("NOT", at, at + 1)
        if norm in ADVERBS or norm in HEDGES or norm.endswith("ly"):
            return Chunk("ADVERB", at, at + 1, norm)
        return Chunk("UNKNOWN", at, at + 1, norm)

    def _unknown_imperative(self, at: int) -> bool:
        """Return True for an unknown word before a determiner where a command can begin: *tighten the screws*."""
        norm = self.norms[at]
        if (
            is_known(norm)
            or not norm.isalpha()
            or norm.endswith("ly")  # 'traditionally the towels …'
            or self.nouns.is_known_noun(norm)
            or self.norms[at + 1] in ("that", "which")
        ):
            return False
        if not self.nouns.is_determiner(at + 1) or self.nouns.is_letter(at + 1):
            return False
        previous = self._previous()
        return previous in ("", "CUT") or (
            previous in ("AND", "COMMA", "THEN", "ADVERB") and any(chunk.type in ("PUT", "DO") for chunk in self.chunks)
        )

    def _changes(self, at: int) -> bool:
        """Return True for a quality that a command gives to something: *clear the table*, *empty the bin*."""
        quality = adjectives().get(self.norms[at]) in ("state", "other", "colour") and self.nouns.is_determiner(at + 1)
        begins = self._previous() in ("", "CUT")
        begins = begins or (self._previous() == "COMMA" and self.chunks[0].type == "SUB")  # 'before you begin, clear …'
        return quality and begins and self.norms[at] not in _BEFORE_DETERMINERS

    def _is_material_here(self, at: int, end: int) -> bool:
        """Return True for a material, or a side after *whose*, that is a noun: *neither paper nor cloth*."""
        before = [chunk.type for chunk in self.chunks[-2:]]
        listed = before[-1:] == ["OF"] or before in (["NP", "AND"], ["NP", "OR"])
        return (listed and is_material_noun(self.norms[end - 1])) or (
            before[-1:] == ["WHOSE"] and end == at + 1 and self.norms[at] in PLACE_NOUNS
        )

    def _noun_phrase(self, at: int) -> Chunk | None:
        """Return a noun phrase, or an adjective phrase."""
        if self._unknown_imperative(at):
            return Chunk("DO", at, at + 1, VerbGroup(self.norms[at], "unknown", "base"))
        after_verb = [chunk.type for chunk in self.chunks if chunk.type != "ADVERB"][-1:] == ["VERB"]
        if after_verb and self.norms[at] in ("first", "last") and self.norms[at + 1] in CLAUSE_ENDS:
            return Chunk("ADVERB", at, at + 1, self.norms[at])  # 'the drum goes down first, on the rug'
        if self._changes(at):
            return Chunk("DO", at, at + 1, VerbGroup(self.norms[at], "unknown", "base"))
        if (
            not self._previous() and self.norms[at + 1] in PARTICLES and self.nouns.is_determiner(at + 2)
            and self.norms[at].isalpha() and self.norms[at] not in DIRECTION_WORDS and not self._relator(at)
        ):  # fmt: skip
            return Chunk("DO", at, at + 2, VerbGroup(self.norms[at], "unknown", "base"))  # 'wipe off the oil'
        back = self.norms[at : at + 2] == ["right", "back"] and self._previous() in FINITE | {"PART"}
        if back and self.norms[at + 2] in prepositions():
            return Chunk("ADVERB", at, at + 2, "back")  # 'pushed right back against the wall'
        if (
            self.norms[at] == "back"
            and self._previous() in FINITE | {"PART", "NP", "NOT"}
            and self.norms[at + 1] in prepositions()
            and (
                self.norms[at + 1] not in ("of", "to") or (self.norms[at + 1] == "to" and not self.nouns.starts(at + 2))
            )
        ):
            return Chunk("ADVERB", at, at + 1, "back")
        if self.norms[at + 1] in ("quarters", "quarter", "thirds", "third") and self.norms[at + 2] in _HALF_STATES:
            span = self.words[at].start, self.words[at + 2].end
            return Chunk("ADJP", at, at + 3, (Adjective(f"partly {self.norms[at + 2]}", "state", Degree.PLAIN, span),))
        if self.norms[at].endswith(("-quarters", "-thirds")) and self.norms[at + 1] in _HALF_STATES:
            span = self.words[at].start, self.words[at + 1].end
            return Chunk("ADJP", at, at + 2, (Adjective(f"partly {self.norms[at + 1]}", "state", Degree.PLAIN, span),))
        if self.norms[at] in ("missing", "absent") and self._previous() == "BE":
            span = self.words[at].start, self.words[at].end
            return Chunk("ADJP", at, at + 1, (Adjective("missing", "state", Degree.PLAIN, span),))
        if self.norms[at] == "half" and self.norms[at + 1] in _HALF_STATES | ADVERBS:
            span = self.words[at].start, self.words[at + 1].end
            return Chunk("ADJP", at, at + 2, (Adjective(f"half {self.norms[at + 1]}", "state", Degree.PLAIN, span),))
        found = self.nouns.phrase(at, self._previous())
        if found is None:
            return None
        end, phrase, adjectives = found
        if self._made is not None and at < self._made < end:
            verb, self.norms[self._made] = self.norms[self._made], ","  # 'let ivy trail over the rim'
            found = self.nouns.phrase(at, self._previous()) or found
            self.norms[self._made] = verb
            end, phrase, adjectives = found
        if self._denied is not None and end - at > 1 and self._is_base(end - 1) and self._predicate_after(end - 1):
            verb, self.norms[end - 1] = self.norms[end - 1], ","  # 'must the container stand on it'
            shorter = self.nouns.phrase(at, self._previous())
            self.norms[end - 1] = verb
            end, phrase, adjectives = shorter or found
        if (
            phrase is not None
            and not phrase.head
            and not phrase.pronoun
            and phrase.determiner is None
            and (
                (self._previous() in ("NP", "BE") or self.norms[end + 2] in DIRECTION_WORDS)
                and self._previous() in ("NP", "BE", "COMMA")
                and self.norms[end] == "from"
                and phrase.adjectives
                and phrase.count is None
            )
        ):
            return Chunk("ADJP", at, end, phrase.adjectives)  # 'the block second from the left'
        follows = self._previous() in ("BE", "COMMA", "AND", "OR", "NP", "ADVERB", "ADJP")
        if end == at + 1 and phrase is not None and self.norms[at] in QUALITIES and follows:
            span = self.words[at].start, self.words[at].end
            return Chunk("ADJP", at, end, (Adjective(self.norms[at], "other", Degree.PLAIN, span),))
        if end == at + 1 and phrase is not None and self._previous() == "BE" and (words := self.nouns.predicative(at)):
            return Chunk("ADJP", at, end, words)
        if phrase is None and self._is_material_here(at, end):
            span = self.words[at].start, self.words[end - 1].end
            return Chunk("NP", at, end, NounPhrase(span, self.norms[end - 1], adjectives=adjectives[:-1]))
        if phrase is None:
            if self._previous() in ("PREP", "TPART", "WITH", "OF", "TVERB", "FIND", "PUT") or self.norms[end] == "of":
                span = self.words[at].start, self.words[end - 1].end
                return Chunk("NP", at, end, NounPhrase(span, adjectives=adjectives))
            return Chunk("ADJP", at, end, adjectives)
        if last_word(phrase.head) in FIGURES and end < len(self.words) and self.nouns.is_name(end):
            span = self.words[at].start, self.words[end].end  # 'the doll Anna'
            return Chunk("NP", at, end + 1, replace(phrase, span=span, head=self.norms[end]))
        return Chunk("NP", at, end, phrase)


_PUNCTUATION = {
    ",": "COMMA", ";": "CUT", ":": "COLON", ".": "CUT", "!": "CUT", "?": "CUT", "(": "COMMA", ")": "COMMA",
    "[": "COMMA", "]": "COMMA", "\u2013": "CUT", "\u2014": "CUT", "-": "CUT", "/": "OR", "\u2026": "CUT",
}  # fmt: skip

_BEFORE_DETERMINERS = word_set("such only right wrong opposite same last")

_HALF_STATES = word_set("dead empty full open closed finished done eaten asleep")
