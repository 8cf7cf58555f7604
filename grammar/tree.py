"""Builds the tree while the parser runs: a method a rule of ``layout.lark``."""

from __future__ import annotations

from lark import Token, Transformer, v_args

from deixis.grammar.draft import place
from deixis.grammar.errors import Refusal, shortened
from deixis.grammar.names import require_short, unquote
from deixis.grammar.script import Chain, Declaration, Header, Include, Mention, Modifiers, RelationStatement, Statement
from deixis.grammar.words import NUMBERS, VERBS_OR_NOUNS
from deixis.ontology.facts import Source
from deixis.ontology.relation import Relation, plain_phrase

UNQUALIFIED_DECLARATION = "what kind of thing an object is, or its colour, cannot be denied, optional or hedged"

Pair = tuple[tuple[Relation, ...], Mention, Mention]


def source_of(token: Token) -> Source:
    """Return where a token stands."""
    return Source(place.get().file, token.line, token.column, token.end_line, token.end_column)  # type: ignore[arg-type]


def span_of(tokens: list[Token]) -> Source:
    """Return where a run of tokens stands, from the start of the first to the end of the last."""
    first, last = tokens[0], tokens[-1]
    return Source(place.get().file, first.line, first.column, last.end_line, last.end_column)  # type: ignore[arg-type]


def text_of(token: Token) -> str:
    """Return the name that a NAME or a STRING stands for."""
    return unquote(token[1:-1], source_of(token)) if token.type == "STRING" else str(token)


@v_args(inline=True)
class TreeBuilder(Transformer[Token, Statement]):
    """A method takes what its rule holds, and returns a node; what makes no sense raises Refusal."""

    def header(self, name: Token, title: Token | None, viewpoint: Token | None) -> Header:
        return self._header(str(name), title, viewpoint)

    def title_header(self, title: Token, viewpoint: Token | None) -> Header:
        return self._header(None, title, viewpoint)

    def view_header(self, viewpoint: Token) -> Header:
        return self._header(None, None, viewpoint)

    def _header(self, name: str | None, title: Token | None, viewpoint: Token | None) -> Header:
        shown = None
        require_short(name or "", place.get().statement)
        if title is not None:
            shown = " ".join(title[1:-1].split())
            require_short(shown, source_of(title))
            unquote(shown or "-", source_of(title))
        return Header(name, shown or None, text_of(viewpoint) if viewpoint else None, place.get().statement)

    def include(self, path: Token) -> Include:
        return Include(path[1:-1], source_of(path))

    def declaration(
        self, modifiers: Modifiers | None, subjects: tuple[Mention, ...], _is: Token, word: Token
    ) -> Declaration:
        here = place.get()
        if modifiers is not None:
            raise Refusal(here.statement, UNQUALIFIED_DECLARATION)
        kind, colour = here.draft.quality(text_of(word), source_of(word))
        here.draft.grow(_size(subjects), here.statement)
        if kind is not None:
            here.draft.declare(subjects, kind)
        if colour is not None:
            here.draft.paint(subjects, colour)
        return Declaration(subjects, kind, colour, here.statement)

    def placement(
        self,
        modifiers: Modifiers | None,
        subjects: tuple[Mention, ...],
        link: tuple[Modifiers, Token | None] | None,
        relations: tuple[Relation, ...],
        objects: tuple[Mention, ...],
    ) -> RelationStatement:
        here = place.get()
        how, noun = link or (None, None)
        if noun is not None and _size(subjects) == 1:
            verb = f"is {noun}" if noun.casefold() in ("set", "put") else f"{noun}s"
            hint = f"say '{verb}' for the verb; join the words of the name with '_', or quote it"
            raise Refusal(source_of(noun), f"'{noun}' may be a verb here, or belong to the name", hint)
        here.draft.grow(_size(subjects) * _size(objects), here.statement)
        among = {name for mention in subjects for name in mention.names}
        for mention in objects:
            for name in mention.names:
                if name in among:
                    raise Refusal(mention.source, f"'{shortened(name)}' cannot be related to itself")
        if modifiers is None or how is None:
            merged = modifiers or how or Modifiers()
        else:
            where = place.get().statement
            if modifiers.hedge and how.hedge:
                raise _twice("HEDGE", how.hedge, where)
            if not modifiers.positive and not how.positive:
                raise _twice("NOT", "not", where)
            if modifiers.optional and how.optional:
                raise _twice("OPTIONAL", "optional", where)
            hedge, weight = (modifiers.hedge, modifiers.weight) if modifiers.hedge else (how.hedge, how.weight)
            merged = Modifiers(modifiers.positive and how.positive, modifiers.optional or how.optional, hedge, weight)
        return RelationStatement(subjects, relations, objects, merged, here.statement)

    def pairs(self, modifiers: Modifiers | None, first: Pair, *others: Pair) -> RelationStatement:
        relations, subject, thing = first
        how = modifiers or Modifiers()
        for more, other_subject, other_thing in others:
            if (other_subject.names, other_thing.names) != (subject.names, thing.names):
                hint = "state each pair on its own, without 'or'"
                raise Refusal(other_subject.source, "'or' must be between relations of one and the same pair", hint)
            if not how.positive:
                hint = "say `not left or right(a, b)` where neither holds"
                raise Refusal(other_subject.source, "'not' before several pairs does not say which it denies", hint)
            relations += more
        one = _one_reading(relations, place.get().statement)
        return self.placement(modifiers, (subject,), None, one, (thing,))

    def pair(self, relations: tuple[Relation, ...], subject: Mention, thing: Mention) -> Pair:
        return relations, subject, thing

    def chain(self, modifiers: Modifiers | None, head: Token, objects: tuple[Mention, ...]) -> Chain:
        here = place.get()
        how = modifiers or Modifiers()
        if not how.positive:
            raise Refusal(here.statement, "a chain cannot be denied", "deny each pair on its own")
        here.draft.grow(_size(objects), here.statement)
        before = None
        for mention in objects:
            for name in mention.names:
                if name == before:
                    raise Refusal(mention.source, f"'{shortened(name)}' cannot be related to itself")
                before = name
        if _size(objects) < 2:
            raise Refusal(objects[0].source, "a chain needs at least two objects")
        start = here.draft.chains[plain_phrase(head.removesuffix(":"))]
        return Chain(start, objects, how, here.statement)

    def objects(self, *mentions: Mention) -> tuple[Mention, ...]:
        return mentions

    def object(self, count: Token | None, name: Token) -> Mention:
        number = None if count is None else NUMBERS.get(count.casefold()) or int(count)
        return place.get().draft.book.mention(text_of(name), number, source_of(name))

    def relations(self, *phrases: Token) -> tuple[Relation, ...]:
        draft = place.get().draft
        if len(phrases) == 1:
            return (draft.relation(phrases[0]),)
        return _one_reading(tuple(draft.relation(phrase) for phrase in phrases), source_of(phrases[-1]))

    def modifiers(self, *words: Token) -> Modifiers:
        return _modifiers(words)

    def link(self, *words: Token) -> tuple[Modifiers, Token | None]:
        """Return what qualifies the relation, and a bare verb that may be a noun (a cake stand)."""
        verbs = [word for word in words if word.type in ("IS", "VERB")]
        for before, word in zip([None, *verbs], verbs, strict=False):
            if before is not None and (before.type, word.type) != ("IS", "VERB"):
                raise Refusal(source_of(word), f"'{word}' is one verb too many")
        noun = verbs[0] if verbs and verbs[0].casefold() in VERBS_OR_NOUNS else None
        return _modifiers(tuple(word for word in words if word.type not in ("IS", "VERB"))), noun


def _modifiers(words: tuple[Token, ...]) -> Modifiers:
    found: dict[str, Token] = {}
    for word in words:
        if word.type in found:
            raise _twice(word.type, str(word), source_of(word))
        found[word.type] = word
    hedge = found.get("HEDGE")
    plain = None if hedge is None else plain_phrase(hedge)
    weight = 1.0 if plain is None else place.get().draft.hedges[plain]
    return Modifiers("NOT" not in found, "OPTIONAL" in found, plain, weight)


def _twice(modifier: str, word: str, where: Source) -> Refusal:
    if modifier == "HEDGE":
        return Refusal(where, f"one word such as 'usually' is enough: '{word}' is a second one")
    return Refusal(where, f"'{word}' must not be said twice")


def _one_reading(relations: tuple[Relation, ...], where: Source) -> tuple[Relation, ...]:
    """Return the relations without repetition; raises Refusal where some are read widely and some exactly."""
    if len({relation.reading for relation in relations}) > 1:
        wide, exact = sorted({r.reading: r.phrase for r in relations}.values(), key=lambda p: "exactly" in p)
        hint = "say 'exactly' with each of them, or with none"
        raise Refusal(where, f"'or' cannot mix a wide relation ('{wide}') with an exact one ('{exact}')", hint)
    return tuple(dict.fromkeys(relations))


def _size(mentions: tuple[Mention, ...]) -> int:
    return len(mentions[0].names) if len(mentions) == 1 else sum(len(mention.names) for mention in mentions)
