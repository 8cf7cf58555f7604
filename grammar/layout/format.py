"""Write scripts: the canonical form of a script, and a learned layout as a script."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deixis.arguments import checks_arguments
from deixis.grammar.layout.claims import PROPERTIES, Phrase, adjective_property, phrase_of
from deixis.grammar.script import (
    Chain,
    ClaimStatement,
    Comment,
    Declaration,
    Header,
    Include,
    Mention,
    Modifiers,
    RelationStatement,
    Script,
    Statement,
)
from deixis.ontology.graph.claims import SUPERLATIVES, Claim
from deixis.ontology.graph.facts import Source
from deixis.ontology.lessons.types import LayoutConcept
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.colours import Colour
from deixis.ontology.things.kinds import Kind


@checks_arguments
def format_script(script: Script) -> str:
    """Return the script's own statements in canonical form, without those of included files.

    Formatting the result again changes nothing.

    Parameters
    ----------
    script
        A parsed script.

    Returns
    -------
    str
        The text, with its comments, and a line end at its end.

    Examples
    --------
    >>> from deixis.grammar.layout.parser import parse_script
    >>> print(format_script(parse_script("left(salad fork, the plate); not on(napkin, plate)  # never")), end="")
    salad_fork left of plate
    napkin not on plate  # never
    """
    lines: list[str] = []
    last_line = 0
    writer = StatementWriter(script.ontology, script.surface)
    for block in _blocks(script):
        if lines and block.first_line > last_line + 1:
            lines.append("")
        lines += [_comment(comment) for comment in block.above]
        if block.statement is not None:
            after = f"  {_comment(block.after)}" if block.after else ""
            lines.append(writer.write(block.statement) + after)
        last_line = block.last_line
    return "".join(line + "\n" for line in lines)


@dataclass(slots=True)
class _Block:
    """A statement with the comments inside it and the comment behind it, or a comment that stands alone."""

    above: list[Comment]
    statement: Statement | None
    after: Comment | None
    first_line: int
    last_line: int


def _blocks(script: Script) -> Iterator[_Block]:
    """Yield the script cut into blocks, in order.

    A comment inside a statement moves above it. A comment behind a statement, on the line where the statement ends,
    stays there, unless another statement follows on that line: then the comment belongs to that statement.
    """
    comments = list(reversed(script.comments))
    for i, statement in enumerate(script.statements):
        start, end = statement.source.line, statement.source.end_line
        place = (end, statement.source.end_column)
        while comments and comments[-1].source.line < start:
            yield _alone(comments.pop())
        above = []
        while comments and (comments[-1].source.line, comments[-1].source.column) < place:
            above.append(comments.pop())
        after = None
        following = script.statements[i + 1].source.line if i + 1 < len(script.statements) else None
        if comments and comments[-1].source.line == end and following != end:
            after = comments.pop()
        yield _Block(above, statement, after, start, end)
    while comments:
        yield _alone(comments.pop())


def _alone(comment: Comment) -> _Block:
    return _Block([comment], None, None, comment.source.line, comment.source.line)


def _comment(comment: Comment) -> str:
    return f"# {comment.text}" if comment.text else "#"


class StatementWriter:
    """Writer of statements in the words of an ontology; it quotes the names that need it.

    ``surface`` is the name of the surface in the header of the script, if there is one.
    """

    def __init__(self, ontology: Ontology, surface: str | None = None) -> None:
        from deixis.grammar.layout.language import language_of  # here, so that only formatting loads lark

        self._ontology = ontology
        self._surface = surface
        self._language = language_of(ontology)
        self._written: dict[str, str] = {}

    def write(self, statement: Statement) -> str:
        """Return the statement on one line, without a line end.

        Parameters
        ----------
        statement
            The statement.

        Returns
        -------
        str
            The line.
        """
        match statement:
            case Header(name, title, viewpoint, _, surface):
                on = f"on {self.name(surface)}" if surface else None
                view = f"seen from {self.name(viewpoint)}" if viewpoint else None
                return " ".join(filter(None, ["layout", name, f'"{title}"' if title else None, on, view]))
            case Include(path):
                return f'include "{path}"'
            case Declaration(subjects, kind, colour):
                return f"{self._list(subjects)} {self._is(subjects, kind, colour)}"
            case Chain(relation, objects, modifiers):
                inverse = self._ontology.relations[relation.inverse]
                head = f"{relation.word} to {inverse.word}".replace("_", " ")
                return f"{_front(modifiers)}{head}: {self._list(objects)}"
            case ClaimStatement():
                return self._claim(statement)
            case RelationStatement(subjects, relations, objects, modifiers):
                denied = "" if modifiers.positive else "not "
                phrases = " or ".join(relation.phrase for relation in relations)
                words = f"{denied}{phrases}"
                return f"{_front(modifiers)}{self._list(subjects)} {words} {self._list(objects)}"

    def _claim(self, statement: ClaimStatement) -> str:
        """Return a statement of claims; a comment for a claim that the language cannot say."""
        claim, how = statement.claims[0], statement.modifiers
        front, denied = _front(how), "" if how.positive else "not "
        subjects, value = self._list(statement.subjects), claim.value
        if claim.relation.startswith("none_") and value is None:
            name = claim.relation.removeprefix("none_")
            relation = self._ontology.relations.get(name)
            phrase = phrase_of(Claim(name, ("",), ("",))) if relation is None else relation.phrase
            if phrase is not None:
                return f"{front}{'' if how.positive else 'not '}nothing {phrase} {subjects}"
        elif claim.relation == "on" and self._surface is not None and not claim.arguments and value is None:
            return f"{front}{subjects} {denied}on {self.name(self._surface)}"
        elif (phrase := phrase_of(claim)) is not None:
            are = f"{_are(statement.subjects)} " if claim.relation in _SAID_WITH_VERB else ""
            words = [f"{front}{subjects} {are}{denied}{phrase}"]
            things = list(statement.arguments)
            if claim.relation == "between" and len(things) > 1:
                words += [self._list(tuple(things[:-1])), "and"]
                things = things[-1:]
            if value is None and claim.relation in ("closer", "farther"):
                words.append(self._mention(things.pop(0)))
            if claim.relation in ("closer", "farther") and things:
                words.append("than")
            return " ".join([*words, self._list(tuple(things))]).rstrip()
        elif not claim.arguments and claim.metres is None:
            word = value if value is not None else claim.relation
            plain = word.isidentifier() and self._language.is_name_token(word)
            if plain and self._ontology.quality(word) == (None, None):
                stated = adjective_property(word)
                if stated == Phrase(claim.relation, value):
                    return f"{front}{denied}{subjects} {_are(statement.subjects)} {word}"
            if value is not None:
                relation = self._ontology.relations.get(claim.relation)
                if claim.relation in PROPERTIES:
                    has = "has" if _are(statement.subjects) == "is" else "have"
                    return f"{front}{denied}{subjects} {has} {claim.relation} {self._value(value)}"
                if relation is not None:
                    return f"{front}{subjects} {denied}{relation.phrase} unseen {self._value(value)}"
        return f"# {claim}"

    def _value(self, value: str) -> str:
        """Return the value of a claim, quoted unless it is read back unchanged."""
        if "_" not in value and self._language.is_name_token(value):
            return value
        return value if value.isdecimal() and 1 <= len(value) <= 2 and value[0] != "0" else f'"{value}"'

    def name(self, name: str) -> str:
        """Quote a name if it would not be read back unchanged.

        Parameters
        ----------
        name
            The name.

        Returns
        -------
        str
            The name as a script writes it.
        """
        written = self._written.get(name)
        if written is None:
            written = name if self._language.reads_as_name(name) else f'"{name}"'
            self._written[name] = written
        return written

    def _list(self, mentions: tuple[Mention, ...]) -> str:
        return ", ".join(self._mention(mention) for mention in mentions)

    def _mention(self, mention: Mention) -> str:
        counted = "" if mention.count is None else f"{mention.count} "
        return counted + self.name(mention.name)

    def _is(self, subjects: tuple[Mention, ...], kind: Kind | None, colour: Colour | None) -> str:
        # The first phrase that is read back as the same kind and colour.
        shades = colour.words if colour else ("",)
        things = (kind.name, *kind.words) if kind else ("",)
        phrases = [f"{shade} {thing}".strip() for shade in shades for thing in things]
        meant = (phrase for phrase in phrases if self._ontology.quality(phrase) == (kind, colour))
        words = next(meant, phrases[0]).split()
        word = " ".join(words) if all(map(self._language.reads_as_name, words)) else self.name("_".join(words))
        if _are(subjects) == "are":
            return f"are {word}"
        return f"is {word}" if kind is None else f"is {'an' if word[0] in 'AEIOUaeiou' else 'a'} {word}"


_SAID_WITH_VERB = frozenset({*SUPERLATIVES, "ordinal", "upside_down"})
"""Claims whose phrases sound odd without *is*."""


def _are(subjects: tuple[Mention, ...]) -> str:
    return "is" if len(subjects) == 1 and subjects[0].count is None else "are"


def _front(modifiers: Modifiers) -> str:
    optional = "optional " if modifiers.optional else ""
    return optional + (f"{modifiers.hedge} " if modifiers.hedge else "")


def layout_script(layout: LayoutConcept, ontology: Ontology) -> str:
    """Return a layout as a script in canonical form, one fact per line.

    Reading the script gives the same facts, kinds, colours and header.

    Parameters
    ----------
    layout
        The layout.
    ontology
        Words of the language.

    Returns
    -------
    str
        The text of the script.
    """
    lines = _Lines()
    statements = tuple(_statements(layout, ontology, lines))
    script = Script(
        f"<{layout.name}>", layout.name, layout.title, layout.viewpoint, statements, (), ontology, None, layout.surface
    )
    return format_script(script)


class _Lines:
    """Sources for statements that are in no file: one line each, and an empty line before a gap."""

    def __init__(self) -> None:
        self._line = 0

    def next(self, gap: bool = False) -> Source:
        self._line += 2 if gap else 1
        return Source("<layout>", self._line, 1, self._line, 2)


def _statements(layout: LayoutConcept, ontology: Ontology, lines: _Lines) -> Iterator[Statement]:
    yield Header(layout.name, layout.title, layout.viewpoint, lines.next(), layout.surface)
    gap = True
    related = {name for fact in layout.facts for name in (fact.subject, fact.object)}
    related |= {name for claim in layout.claims for name in (*claim.subjects, *claim.arguments)}
    coloured = {
        name
        for claim in layout.claims
        if claim.relation == "colour" and claim.positive and ontology.colours.of_word(claim.value or "") is not None
        for name in claim.subjects
    }
    for role in layout.roles:
        kind = ontology.kinds[role.kind] if role.declared and role.kind is not None else None
        # The colour needs no declaration if a claim states it, or if the name begins with it and is mentioned.
        colour = ontology.colours[role.colour] if role.colour is not None else None
        if role.name in coloured or (role.name in related and colour is ontology.of_name(role.name)[1]):
            colour = None
        if kind is not None or colour is not None:
            source = lines.next(gap)
            yield Declaration((_mention(role.name, source),), kind, colour, source)
            gap = False
    gap = True
    for fact in layout.facts:
        source = lines.next(gap)
        hedge = None if fact.weight >= 1 else _hedge(fact.weight, ontology)
        modifiers = Modifiers(fact.positive, fact.optional, hedge, fact.weight)
        ends = [(_mention(name, source),) for name in (fact.subject, fact.object)]
        yield RelationStatement(ends[0], fact.relations, ends[1], modifiers, source)
        gap = False
    gap = True
    for claim in layout.claims:
        source = lines.next(gap)
        hedge = None if claim.weight >= 1 else _hedge(claim.weight, ontology)
        modifiers = Modifiers(claim.positive, claim.optional, hedge, claim.weight)
        subjects, arguments = (
            tuple(_mention(name, source) for name in names) for names in (claim.subjects, claim.arguments)
        )
        yield ClaimStatement(subjects, arguments, (claim,), modifiers, source)
        gap = False


def _mention(name: str, source: Source) -> Mention:
    return Mention(name, source, None, (name,))


def _hedge(weight: float, ontology: Ontology) -> str:
    """Return the hedge whose weight is nearest; the first one of equals."""
    words: Sequence[str] = list(ontology.hedges)
    return min(words, key=lambda word: abs(ontology.hedges[word] - weight))
