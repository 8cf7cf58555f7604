"""Read an English text as a script: its facts with the words that state them, and a paraphrase of each sentence."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace

from deixis.deadline import Deadline
from deixis.grammar.english.confidence import Guess, Standing, confidence, standing
from deixis.grammar.english.discourse.discourse import Discourse
from deixis.grammar.english.discourse.drafts import Draft as FactDraft
from deixis.grammar.english.discourse.entities import Entity, Role, names_of
from deixis.grammar.english.parse import late, parse_until
from deixis.grammar.english.telling.paraphrase import paraphrase
from deixis.grammar.english.telling.wording import listed
from deixis.grammar.english.tree import Clause, Misunderstood, Mood, Sentence
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.errors import Diagnostic, ScriptError
from deixis.grammar.reading import DoubtfulPronoun, Reading, ReadSentence, StatedFact, joined_choices
from deixis.grammar.script import (
    ClaimStatement,
    Comment,
    Declaration,
    Header,
    Mention,
    Modifiers,
    RelationStatement,
    Script,
    Statement,
)
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact, Source
from deixis.ontology.tbox import Ontology, default_ontology


def read_english(
    text: str, file: str = "<text>", ontology: Ontology | None = None, deadline: Deadline = Deadline.never()
) -> Script:
    """Read an English text.

    Parameters
    ----------
    text
        Sentences, paragraphs with headings and numbered steps, or notes.
    file
        Name of the text in error messages and sources.
    ontology
        Relations, hedges, kinds and colours. By default :func:`default_ontology`.
    deadline
        Time limit.

    Returns
    -------
    A script whose ``reading`` holds the sentences, and all facts with what qualifies them. Its own facts are those that
    the text asserts.

    Raises
    ------
    ScriptError
        If nothing in the text was understood; it holds what was not.
    ScriptTimeError
        If the time limit is reached; it holds the script of the sentences that were read before.

    Examples
    --------
    >>> script = read_english("The fork is left of the plate. The knife is to the right of it.")
    >>> [str(fact) for fact in script.facts]
    ['left(fork, plate)', 'right(knife, plate)']
    """
    ontology = ontology or default_ontology()
    sentences, is_whole = parse_until(text, ontology, deadline.share(_SHARE_OF_PARSING))
    discourse = Discourse(text, sentences, dict(ontology.hedges), known_nouns(ontology.kinds))
    drafts = discourse.read(deadline.share(_SHARE_OF_PARSING))
    is_whole = is_whole and discourse.sentences == sentences
    try:
        script = _script_of(text, file, ontology, discourse, drafts) if is_whole or sentences else None
    except ScriptError:
        if is_whole:
            raise
        script = None
    if script is None or not is_whole:
        raise late(discourse.sentences, script)
    return script


_SHARE_OF_PARSING = 0.6
"""Share of a time limit that parsing may take, and reading facts of what is left, so that they can be written."""


def _script_of(text: str, file: str, ontology: Ontology, discourse: Discourse, drafts: list[FactDraft]) -> Script:
    """Return the script of the facts that the sentences of a discourse state."""
    sentences = discourse.sentences
    writer = _Writer(text, file, ontology, discourse)
    read = [fact for draft in drafts for fact in writer.facts(draft)]
    stated = tuple(fact for fact in read if _standing(fact) is not Standing.LEFT_OUT)
    by_sentence: dict[int, list[StatedFact]] = {}
    for fact in read:
        by_sentence.setdefault(fact.sentence, []).append(fact)
    reading = Reading(
        text=text,
        sentences=tuple(writer.sentence(s, by_sentence.get(i, [])) for i, s in enumerate(sentences)),
        stated=stated,
        mentions=writer.mentions(),
        absent=tuple(name for entity, name in writer.names.items() if entity.absent),
        surface=discourse.references.surface.noun.replace(" ", "_") if discourse.references.surface else None,
        uncounted=tuple(name for entity, name in writer.names.items() if entity.plural and not entity.single),
        doubtful_pronouns=tuple(writer.doubtful_pronouns()),
    )
    if not stated and not any(s.clauses and s.clauses[0].mood is Mood.QUESTION for s in sentences):
        raise ScriptError(_nothing_understood(text, file, reading, writer))
    asserted = joined_choices([fact for fact in stated if fact.asserted])
    statements = [statement for fact in asserted for statement in writer.statements(fact, reading)]
    surface = None if reading.surface in writer.names.values() else reading.surface
    viewpoint = None if discourse.seen_from is None else discourse.seen_from.replace(" ", "_")
    if surface is not None or viewpoint is not None:
        statements.insert(0, Header(None, None, viewpoint, Source(file, 1, 1, 1, 1), surface))
    comments = tuple(writer.comments(reading))
    return Script(file, None, None, viewpoint, tuple(statements), comments, ontology, reading, surface)


def _nothing_understood(text: str, file: str, reading: Reading, writer: _Writer) -> tuple[Diagnostic, ...]:
    problems = tuple(problem for sentence in reading.sentences for problem in sentence.problems)
    line = text.strip().split("\n", 1)[0]
    message = "nothing in this text says where something is, or what it is like"
    hint = "write sentences such as 'The fork is to the left of the plate.'"
    return (Diagnostic(Source(file, 1, 1, 1, 1 + max(1, len(line))), message, line, hint), *problems)


class _Writer:
    """Writer of drafts as facts with names, spans and sources."""

    def __init__(self, text: str, file: str, ontology: Ontology, discourse: Discourse) -> None:
        self.text, self.file, self.ontology, self.discourse = text, file, ontology, discourse
        self.starts = [0, *(i + 1 for i, c in enumerate(text) if c == "\n")]
        order: dict[Entity, None] = {}
        for entity in [*discourse.references.entities, *_entities(discourse.drafts)]:
            for leaf in entity.leaves():
                order[leaf] = None
        kept = [draft for draft in discourse.drafts if standing(draft.how.guesses) is not Standing.LEFT_OUT]
        stated, written = (
            {leaf for e in _entities(drafts) for leaf in e.leaves()} for drafts in (kept, discourse.drafts)
        )
        shown = [e for e in order if e.role in (Role.THING, Role.SURROUNDING) and e in written]
        self.names = names_of([e for e in shown if e in stated])
        self.names_in_hints = {**names_of(shown), **self.names}
        self.proper = {  # names of figures and persons, as they are written
            name: mention
            for entity, name in self.names_in_hints.items()
            for mention in entity.mentions
            if mention[:1].isupper()
            and mention.casefold().replace(" ", "_") == name.casefold()
            and not discourse.nouns.knows(name)
        }
        self.declared: set[tuple[str, str]] = set()  # names with a declared kind or colour, and which of the two

    def source(self, span: tuple[int, int]) -> Source:
        """Return the lines and columns of a span of characters."""
        start, end = (bisect_right(self.starts, at) - 1 for at in span)
        return Source(self.file, start + 1, span[0] - self.starts[start] + 1, end + 1, span[1] - self.starts[end] + 1)

    def name(self, names: Sequence[str]) -> str:
        """Return names with *the*, and those of figures and persons as they are written."""
        return listed([self.proper.get(name, f"the {name.replace('_', ' ')}") for name in names])

    def mentions(self) -> dict[str, tuple[str, ...]]:
        """Return the words used for each object, by its name."""
        return {name: tuple(entity.mentions) for entity, name in self.names.items()}

    def doubtful_pronouns(self) -> Iterator[DoubtfulPronoun]:
        """Yield the pronouns that could stand for several objects."""
        for use in self.discourse.references.doubtful:
            names = [self.names[leaf] for e in (use.chosen, *use.others) for leaf in e.leaves() if leaf in self.names]
            if len(names) > 1:
                yield DoubtfulPronoun(use.span, use.word, names[0], tuple(dict.fromkeys(names[1:])))

    def facts(self, draft: FactDraft) -> Iterator[StatedFact]:
        """Yield the facts of a draft: one for each object, or for each pair of members."""
        subjects = [leaf for s in draft.subjects for leaf in s.leaves() if leaf in self.names_in_hints]
        arguments = [leaf for a in draft.arguments for leaf in a.leaves() if leaf in self.names_in_hints]
        if not subjects or (draft.arguments and not arguments):
            return
        how = draft.how
        names = [self.names_in_hints[leaf] for leaf in subjects]
        ends = [self.names_in_hints[leaf] for leaf in arguments]
        contents: list[Fact | Claim] = []
        if draft.collective or draft.relation.startswith("none_"):
            contents.append(self._claim(draft, tuple(names), tuple(ends)))
        elif not ends or draft.value is not None or len(draft.arguments) > 1 or draft.relation in _OVER_ALL:
            contents += [self._claim(draft, (name,), tuple(ends)) for name in names]
        elif how.quantifier == "each" and len(names) == len(ends):
            contents += [self._binary(draft, a, b) for a, b in zip(names, ends, strict=True)]
        else:
            contents += [self._binary(draft, a, b) for a in names for b in ends if a != b]
        for content in contents:
            yield StatedFact(
                content,
                how.sentence,
                how.span,
                how.condition,
                how.past,
                how.uncertain,
                how.alternative,
                how.quantifier,
                how.need_not_hold,
                confidence(how.guesses),
                tuple(sorted(guess.name for guess in how.guesses)),
                how.by_handle,
            )

    def _binary(self, draft: FactDraft, subject: str, thing: str) -> Fact | Claim:
        how = draft.how
        relation = self.ontology.relations.get(draft.relation)
        if how.by_handle:
            return self._claim(replace(draft, value="handle"), (subject,), (thing,))
        if relation is None or draft.metres is not None:
            return self._claim(draft, (subject,), (thing,))
        source = self.source(how.span)
        return Fact(subject, (relation,), thing, how.positive, how.optional, how.weight, source)

    def _claim(self, draft: FactDraft, subjects: tuple[str, ...], arguments: tuple[str, ...]) -> Claim:
        how = draft.how
        return Claim(
            draft.relation, subjects, arguments, draft.value, draft.metres,
            how.positive, how.optional, how.weight, self.source(how.span),
        )  # fmt: skip

    def sentence(self, sentence: Sentence, facts: list[StatedFact]) -> ReadSentence:
        """Return a sentence with its paraphrase and the diagnostics of what was not understood."""
        surface = self.discourse.references.surface
        question = any(clause.mood is Mood.QUESTION for clause in sentence.clauses)
        doubted = [
            Misunderstood(fact.span, ", ".join(Guess[name].value for name in fact.guesses), self._plainly(fact))
            for fact in facts
            if _standing(fact) is not Standing.ASSERTED
        ]
        silent = [
            Misunderstood(clause.span, "this has no relation or property that a fact can state")
            for clause in sentence.clauses
            if not (facts or sentence.misunderstood) and _says_a_place(clause)
        ]
        notes = sorted(dict.fromkeys((*sentence.misunderstood, *doubted, *silent)), key=lambda note: note.span)
        return ReadSentence(
            text=" ".join(sentence.text.split()),
            span=sentence.span,
            paraphrase=paraphrase(
                [fact for fact in facts if _standing(fact) is not Standing.LEFT_OUT],
                surface.noun if surface is not None else "table",
                self.name,
            ),
            understood=sentence.understood,
            words=sentence.words,
            question=question,
            heading=sentence.heading,
            problems=tuple(self._problem(m.span, m.reason, m.suggestion) for m in notes),
            problem_spans=tuple(m.span for m in notes),
        )

    def _plainly(self, doubted: StatedFact) -> str:
        """Return a sentence that states a doubtful fact."""
        surface = self.discourse.references.surface
        content = replace(doubted.content, weight=1.0, optional=False)
        plain = replace(doubted, content=content, uncertain=False, past=False, condition=None, alternative=None)
        return paraphrase([plain], surface.noun if surface is not None else "table", self.name)

    def _problem(self, span: tuple[int, int], reason: str, suggestion: str | None) -> Diagnostic:
        source = self.source(span)
        line = self.text[self.starts[source.line - 1] :].split("\n", 1)[0]
        return Diagnostic(source, f"not understood: {reason}", line, _hint(suggestion))

    def statements(self, stated: StatedFact, reading: Reading) -> Iterator[Statement]:
        """Yield a fact or a claim as a statement of the layout language, unless it is about absent things."""
        content = stated.content
        source = content.source or Source(self.file, 1, 1, 1, 1)
        modifiers = Modifiers(content.positive, content.optional, self._hedge(content.weight), content.weight)
        absent = set(reading.absent)
        if stated.by_handle and isinstance(content, Claim) and content.value is not None:
            words = (OPPOSITE_DIRECTIONS.get(word, word) for word in content.value.split())
            content = replace(content, value=" ".join(words))
        if isinstance(content, Fact):
            if {content.subject, content.object}.isdisjoint(absent):
                ends = self._mention(content.subject, source), self._mention(content.object, source)
                yield RelationStatement((ends[0],), content.relations, (ends[1],), modifiers, source)
            return
        if not absent.isdisjoint((*content.subjects, *content.arguments)):
            return
        subjects = tuple(self._mention(name, source) for name in content.subjects)
        arguments = tuple(self._mention(name, source) for name in content.arguments)
        colour = self.ontology.colours.of_word(content.value or "") if content.relation == "colour" else None
        kind = self.ontology.kinds.words.get(content.value or "") if content.relation == "kind" else None
        new = not any((name, content.relation) in self.declared for name in content.subjects)
        if (colour is not None or kind is not None) and content.positive and new:
            self.declared |= {(name, content.relation) for name in content.subjects}
            yield Declaration(subjects, kind, colour, source)
        yield ClaimStatement(subjects, arguments, (content,), modifiers, source)

    def _hedge(self, weight: float) -> str | None:
        if weight >= 1:
            return None
        hedges = self.ontology.hedges
        return min(hedges, key=lambda word: abs(hedges[word] - weight))

    @staticmethod
    def _mention(name: str, source: Source) -> Mention:
        return Mention(name, source, None, (name,))

    def comments(self, reading: Reading) -> Iterator[Comment]:
        """Yield what the layout language cannot say, each at the place where the text says it."""
        for stated in reading.stated:
            content = stated.content
            source = content.source
            if source is None or stated.asserted:
                continue
            marks = [*(["past"] if stated.past else []), *(["uncertain"] if stated.uncertain else [])]
            marks += [stated.condition] if stated.condition else []
            note = f"{content}" + (f"  ({', '.join(marks)})" if marks else "")
            yield Comment(note, Source(source.file, source.line, source.column, source.line, source.column), True)


def _standing(fact: StatedFact) -> Standing:
    return standing(Guess[name] for name in fact.guesses)


def _entities(drafts: list[FactDraft]) -> list[Entity]:
    return [entity for draft in drafts for entity in (*draft.subjects, *draft.arguments)]


def _says_a_place(clause: Clause) -> bool:
    """Return True for a statement or command that relates its subject to something."""
    related = any(p.arguments for p in clause.predicates)
    return clause.mood is not Mood.QUESTION and related and not (clause.condition or clause.past or clause.modal)


def _hint(suggestion: str | None) -> str | None:
    """Return a suggested wording in quotation marks, and an instruction as it is."""
    if suggestion is None or suggestion.startswith(("say ", "deny ", "write ")):
        return suggestion
    return f"write {suggestion!r}"


OPPOSITE_DIRECTIONS = {"left": "right", "viewer": "away", "near": "far", "front": "back", "up": "down"}
OPPOSITE_DIRECTIONS |= {second: first for first, second in OPPOSITE_DIRECTIONS.items()}
"""Direction in which the head of a tool points, by that of its handle."""

_OVER_ALL = frozenset(
    {"between", "closer", "farther", "nearest", "farthest", "largest", "smallest", "tallest", "shortest"}
)
