"""Build the tree while the parser runs: one method per rule of ``layout.lark``."""

from __future__ import annotations

from lark import Token, Transformer, v_args

from deixis.grammar.errors import StatementError, shortened
from deixis.grammar.layout.claims import Phrase, adjective_property, is_collective, meaning
from deixis.grammar.layout.draft import place
from deixis.grammar.layout.names import key_of, require_short, unquote
from deixis.grammar.layout.words import NUMBERS, VERBS_OR_NOUNS
from deixis.grammar.script import (
    Chain,
    ClaimStatement,
    Declaration,
    Header,
    Include,
    Mention,
    Modifiers,
    RelationStatement,
    Statement,
)
from deixis.ontology.graph.claims import PLACES, Claim
from deixis.ontology.graph.facts import Source
from deixis.ontology.relations.relation import Reading, Relation, plain_phrase

UNQUALIFIED_DECLARATION = "the kind or colour of an object cannot be denied, optional or hedged"

THAN_HINT = "say 'than' after 'closer to' or 'farther from'"
OR_HINT = "state each relation on its own"

Pair = tuple[tuple[Relation, ...], Mention, Mention]


def source_of(token: Token) -> Source:
    """Return the place of a token.

    Parameters
    ----------
    token
        The token.

    Returns
    -------
    Source
        File, line and column, from start to end.
    """
    return Source(place.get().file, token.line, token.column, token.end_line, token.end_column)  # type: ignore[arg-type]


def span_of(tokens: list[Token]) -> Source:
    """Return the place of a run of tokens, from the start of the first to the end of the last.

    Parameters
    ----------
    tokens
        The tokens, at least one.

    Returns
    -------
    Source
        File, line and column, from start to end.
    """
    first, last = tokens[0], tokens[-1]
    return Source(place.get().file, first.line, first.column, last.end_line, last.end_column)  # type: ignore[arg-type]


def text_of(token: Token) -> str:
    """Return the name that a NAME or STRING token stands for.

    Parameters
    ----------
    token
        The token.

    Returns
    -------
    str
        The name.
    """
    return unquote(token[1:-1], source_of(token)) if token.type == "STRING" else str(token)


@v_args(inline=True)
class TreeBuilder(Transformer[Token, Statement]):
    """Transformer with one method per rule: it takes the parts of the rule, and returns the node of the tree.

    The methods raise StatementError for a statement that is grammatical but has no meaning.
    """

    def header(self, name: Token, title: Token | None, surface: str | None, viewpoint: Token | None) -> Header:
        """Return the header of ``layout NAME "Title" on SURFACE seen from VIEWPOINT``."""
        return self._header(str(name), title, viewpoint, surface)

    def title_header(self, title: Token, surface: str | None, viewpoint: Token | None) -> Header:
        """Return the header of ``layout "Title" on SURFACE seen from VIEWPOINT``."""
        return self._header(None, title, viewpoint, surface)

    def surface_header(self, surface: str, viewpoint: Token | None) -> Header:
        """Return the header of ``layout on SURFACE seen from VIEWPOINT``."""
        return self._header(None, None, viewpoint, surface)

    def view_header(self, viewpoint: Token) -> Header:
        """Return the header of ``layout seen from VIEWPOINT``."""
        return self._header(None, None, viewpoint)

    def surface(self, relation: Token, name: Token) -> str:
        """Return the name of the surface in a header: ``on SURFACE``."""
        if place.get().draft.relation(relation).name != "on":
            hint = 'as in: layout dinner "A dinner" on table seen from chair'
            raise StatementError(source_of(relation), f"expected 'on' and a surface, not '{relation}'", hint)
        require_short(text_of(name), source_of(name))
        return text_of(name)

    def _header(
        self, name: str | None, title: Token | None, viewpoint: Token | None, surface: str | None = None
    ) -> Header:
        shown = None
        require_short(name or "", place.get().statement)
        if title is not None:
            shown = " ".join(title[1:-1].split())
            require_short(shown, source_of(title))
            unquote(shown or "-", source_of(title))
        view = text_of(viewpoint) if viewpoint else None
        return Header(name, shown or None, view, place.get().statement, surface)

    def include(self, path: Token) -> Include:
        """Return the include, still without the statements of its file."""
        return Include(path[1:-1], source_of(path))

    def declaration(
        self, modifiers: Modifiers | None, subjects: tuple[Mention, ...], _is: Token, word: Token
    ) -> Declaration | ClaimStatement:
        """Return the declaration of a kind or a colour, and record it in the draft; or the claim of an adjective."""
        here = place.get()
        if word.type == "NAME" and here.draft.ontology.quality(str(word)) == (None, None):
            stated = adjective_property(str(word))
            if stated is not None:
                return self._claims(modifiers, subjects, None, stated, ())
        if modifiers is not None:
            raise StatementError(here.statement, UNQUALIFIED_DECLARATION)
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
    ) -> RelationStatement | ClaimStatement:
        """Return the statement of ``SUBJECTS RELATIONS OBJECTS``, with the modifiers before it and in its verb."""
        here = place.get()
        surface = next((mention for mention in objects if _is_surface(mention)), None)
        if surface is not None:
            if len(objects) == 1 and [relation.name for relation in relations] == ["on"]:
                return self._claims(modifiers, subjects, link, Phrase("on"), ())
            hint = "only 'on' relates an object to the surface; places are said as 'at the left edge'"
            raise StatementError(surface.source, f"'{surface.name}' is the surface that the objects stand on", hint)
        merged = _merged(modifiers, subjects, link)
        here.draft.grow(_size(subjects) * _size(objects), here.statement)
        _check_apart(subjects, objects)
        return RelationStatement(subjects, relations, objects, merged, here.statement)

    def claim(
        self,
        modifiers: Modifiers | None,
        subjects: tuple[Mention, ...],
        link: tuple[Modifiers, Token | None] | None,
        phrase: Token,
        *objects: tuple[Mention, ...] | None,
    ) -> ClaimStatement:
        """Return the claims of ``SUBJECTS at far left corner``, ``SUBJECTS between OBJECTS`` and similar statements."""
        stated = meaning(phrase)
        than = objects[-1]
        if than is not None and stated.term not in ("closer", "farther"):
            raise StatementError(than[0].source, f"'than' cannot follow '{shortened(phrase)}'", THAN_HINT)
        arguments = tuple(mention for mentions in objects for mention in mentions or ())
        if stated.term == "between" and _size(arguments) < 2:
            raise StatementError(arguments[0].source, "'between' needs at least two objects")
        return self._claims(modifiers, subjects, link, stated, arguments)

    def unseen(
        self,
        modifiers: Modifiers | None,
        subjects: tuple[Mention, ...],
        link: tuple[Modifiers, Token | None] | None,
        relations: tuple[Relation, ...],
        name: Token,
    ) -> ClaimStatement:
        """Return the claims of ``SUBJECTS RELATION unseen NAME``: what is named is not among the objects."""
        if len(relations) > 1:
            raise StatementError(place.get().statement, "'or' cannot join relations to something unseen", OR_HINT)
        return self._claims(modifiers, subjects, link, Phrase(relations[0].name, value_of(name)), ())

    def property(
        self, modifiers: Modifiers | None, subjects: tuple[Mention, ...], phrase: Token, value: Token
    ) -> ClaimStatement:
        """Return the claims of ``SUBJECTS has colour VALUE``."""
        return self._claims(modifiers, subjects, None, Phrase(meaning(phrase).term, value_of(value)), ())

    def nothing(
        self,
        modifiers: Modifiers | None,
        link: tuple[Modifiers, Token | None] | None,
        relations: tuple[Relation, ...] | Token,
        objects: tuple[Mention, ...],
    ) -> ClaimStatement:
        """Return the claim of ``nothing on OBJECTS``."""
        if isinstance(relations, Token):
            stated = meaning(relations)
            term = stated.term if stated == Phrase(stated.term) else None
        else:
            term = relations[0].name if len(relations) == 1 else None
        if term is None:
            raise StatementError(place.get().statement, "'nothing' needs one relation, as in 'nothing on plate'")
        return self._claims(modifiers, objects, link, Phrase(f"none_{term}"), ())

    def _claims(
        self,
        modifiers: Modifiers | None,
        subjects: tuple[Mention, ...],
        link: tuple[Modifiers, Token | None] | None,
        stated: Phrase,
        arguments: tuple[Mention, ...],
    ) -> ClaimStatement:
        here = place.get()
        how = _merged(modifiers, subjects, link)
        _check_apart(subjects, arguments)
        if stated.term in PLACES and len(arguments) == 1 and _is_surface(arguments[0]):
            arguments = ()
        names, others = _names_of(subjects), _names_of(arguments)
        here.draft.grow(len(names) + len(others), here.statement)
        together = is_collective(stated.term)
        claims = tuple(
            Claim(stated.term, about, others, stated.value, stated.metres, how.positive, how.optional, how.weight,
                  here.statement)
            for about in ([names] if together else [(name,) for name in names])
        )  # fmt: skip
        return ClaimStatement(subjects, arguments, claims, how, here.statement)

    def pairs(self, modifiers: Modifiers | None, first: Pair, *others: Pair) -> RelationStatement | ClaimStatement:
        """Return the statement of ``left(a, b) or right(a, b)``."""
        relations, subject, thing = first
        how = modifiers or Modifiers()
        for more, other_subject, other_thing in others:
            if (other_subject.names, other_thing.names) != (subject.names, thing.names):
                hint = "state each pair on its own, without 'or'"
                raise StatementError(other_subject.source, "'or' must be between relations of the same pair", hint)
            if not how.positive:
                hint = "say `not left or right(a, b)` if neither holds"
                raise StatementError(
                    other_subject.source, "'not' before several pairs does not say which one it denies", hint
                )
            relations += more
        one = _one_reading(relations, place.get().statement)
        return self.placement(modifiers, (subject,), None, one, (thing,))

    def pair(self, relations: tuple[Relation, ...], subject: Mention, thing: Mention) -> Pair:
        """Return the parts of ``left(a, b)``."""
        return relations, subject, thing

    def chain(self, modifiers: Modifiers | None, head: Token, objects: tuple[Mention, ...]) -> Chain:
        """Return the chain of ``left to right: a, b, c``."""
        here = place.get()
        how = modifiers or Modifiers()
        if not how.positive:
            raise StatementError(here.statement, "a chain cannot be denied", "deny each pair on its own")
        here.draft.grow(_size(objects), here.statement)
        before = None
        for mention in objects:
            for name in mention.names:
                if name == before:
                    raise StatementError(mention.source, f"'{shortened(name)}' cannot be related to itself")
                before = name
        if _size(objects) < 2:
            raise StatementError(objects[0].source, "a chain needs at least two objects")
        start = here.draft.chains[plain_phrase(head.removesuffix(":"))]
        return Chain(start, objects, how, here.statement)

    def objects(self, *mentions: Mention) -> tuple[Mention, ...]:
        """Return the mentions of a list."""
        return mentions

    def object(self, count: Token | None, name: Token) -> Mention:
        """Return the mention of a name, with its count."""
        number = None if count is None else NUMBERS.get(count.casefold()) or int(count)
        return place.get().draft.book.mention(text_of(name), number, source_of(name))

    def relations(self, *phrases: Token) -> tuple[Relation, ...]:
        """Return the relations of phrases that are joined by 'or'."""
        draft = place.get().draft
        if len(phrases) == 1:
            return (draft.relation(phrases[0]),)
        return _one_reading(tuple(draft.relation(phrase) for phrase in phrases), source_of(phrases[-1]))

    def modifiers(self, *words: Token) -> Modifiers:
        """Return the modifiers before a statement."""
        return _modifiers(words)

    def link(self, *words: Token) -> tuple[Modifiers, Token | None]:
        """Return the modifiers within the verb, and a bare verb that can also be a noun (a cake stand)."""
        verbs = [word for word in words if word.type in ("IS", "VERB")]
        for before, word in zip([None, *verbs], verbs, strict=False):
            if before is not None and (before.type, word.type) != ("IS", "VERB"):
                raise StatementError(source_of(word), f"'{word}' is one verb too many")
        noun = verbs[0] if verbs and verbs[0].casefold() in VERBS_OR_NOUNS else None
        return _modifiers(tuple(word for word in words if word.type not in ("IS", "VERB"))), noun


def value_of(token: Token) -> str:
    """Return the value that a word, a number or a quoted text stands for.

    Parameters
    ----------
    token
        Token of the grammar.

    Returns
    -------
    str
        Text without its quotation marks, or words with spaces instead of underscores.

    Raises
    ------
    StatementError
        If a quoted text is empty or has a control character.
    """
    if token.type == "STRING":
        unquote(token[1:-1], source_of(token))
        return str(token[1:-1])
    return token.replace("_", " ")


def _is_surface(mention: Mention) -> bool:
    surface = place.get().draft.surface
    return surface is not None and key_of(mention.name) == key_of(surface)


def _names_of(mentions: tuple[Mention, ...]) -> tuple[str, ...]:
    return tuple(name for mention in mentions for name in mention.names)


def _check_apart(subjects: tuple[Mention, ...], objects: tuple[Mention, ...]) -> None:
    """Raise StatementError for an object that is related to itself."""
    among = {name for mention in subjects for name in mention.names}
    for mention in objects:
        for name in mention.names:
            if name in among:
                raise StatementError(mention.source, f"'{shortened(name)}' cannot be related to itself")


def _merged(
    modifiers: Modifiers | None, subjects: tuple[Mention, ...], link: tuple[Modifiers, Token | None] | None
) -> Modifiers:
    """Return the modifiers before a statement and in its verb together; raise StatementError for one said twice."""
    how, noun = link or (None, None)
    if noun is not None and _size(subjects) == 1:
        verb = f"is {noun}" if noun.casefold() in ("set", "put") else f"{noun}s"
        hint = f"say '{verb}' for the verb; join the words of the name with '_', or quote it"
        raise StatementError(source_of(noun), f"'{noun}' may be a verb here, or belong to the name", hint)
    if modifiers is None or how is None:
        return modifiers or how or Modifiers()
    where = place.get().statement
    if modifiers.hedge and how.hedge:
        raise _twice("HEDGE", how.hedge, where)
    if not modifiers.positive and not how.positive:
        raise _twice("NOT", "not", where)
    if modifiers.optional and how.optional:
        raise _twice("OPTIONAL", "optional", where)
    hedge, weight = (modifiers.hedge, modifiers.weight) if modifiers.hedge else (how.hedge, how.weight)
    return Modifiers(modifiers.positive and how.positive, modifiers.optional or how.optional, hedge, weight)


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


def _twice(modifier: str, word: str, where: Source) -> StatementError:
    if modifier == "HEDGE":
        return StatementError(where, f"one word such as 'usually' is enough: '{word}' is a second one")
    return StatementError(where, f"'{word}' must not be said twice")


def _one_reading(relations: tuple[Relation, ...], where: Source) -> tuple[Relation, ...]:
    """Return the relations without duplicates; raise StatementError for a mix of wide and exact relations."""
    if len({relation.reading is Reading.EXACT for relation in relations}) > 1:
        wide, exact = (
            next(r.phrase for r in relations if (r.reading is Reading.EXACT) == is_exact) for is_exact in (False, True)
        )
        hint = "say 'exactly' with each of them, or with none"
        raise StatementError(where, f"'or' cannot mix a wide relation ('{wide}') with an exact one ('{exact}')", hint)
    return tuple(dict.fromkeys(relations))


def _size(mentions: tuple[Mention, ...]) -> int:
    return len(mentions[0].names) if len(mentions) == 1 else sum(len(mention.names) for mention in mentions)
