"""Warnings about a script that can be read: likely misspellings, facts that add nothing, contradictions."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from pathlib import Path

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.grammar.layout.names import key_of
from deixis.grammar.reading import Reading, source_of_span
from deixis.grammar.script import Mention, RelationStatement, Script, mentions
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.export import ON_SURFACE
from deixis.ontology.graph.facts import Fact, Source
from deixis.ontology.inflection import is_plural, singular
from deixis.ontology.things.kinds import plain_name
from deixis.reasoning.errors import require_time_limit
from deixis.workflows.layouts.read import as_script

LINT_TIME_LIMIT = 5.0
"""Default time limit in seconds for the warnings that need inference."""

CODES = {
    "N001": "A name is one letter away from another name, or from the word of a kind.",
    "N002": "No fact mentions a declared name.",
    "N003": "The kind of a name is unknown.",
    "N004": "A counted name is a plural, so the names of its members are plurals.",
    "N005": "A name stands beside numbered names of the same noun.",
    "N006": "A name consists of the names of two other objects.",
    "F001": "A fact is stated twice.",
    "F002": "A fact follows from the other facts.",
    "F003": "Facts contradict each other.",
    "F004": "No facts connect two groups of objects.",
    "F005": "An alternative of a choice is a special case of another alternative.",
    "H001": "A hedge has the weight 1, so it changes nothing.",
    "H002": "A denied fact has a hedge such as 'rarely', which denies it again.",
    "E001": "A phrase of an English text is not understood.",
    "E002": "A pronoun could stand for several objects.",
    "E003": "The number of a group is unknown, so the group stands for all things that fit it.",
    "L001": "A script uses left, right, above or below without a viewpoint.",
}
"""Meanings of the codes of warnings: N for names, F for facts, H for hedges, E for English, L for the layout."""

PROPERTIES = frozenset(
    {"colour", "size", "shape", "material", "state", "height", "length", "width", "thickness", "kind", "count"}
    | {"contents", "empty", "open", "closed", "upside_down", "tallest", "largest", "smallest", "shortest", "longest"}
    | {"widest", "thickest", "thinnest"}
)
"""Claims that do not say where a thing is."""

MIN_COMPARED_LETTERS = 4  # minimum number of letters of a name that is compared with others
MAX_NAMES_SHOWN = 4  # names of a group that a message lists
LETTERS = "abcdefghijklmnopqrstuvwxyz"


@dataclass(frozen=True, slots=True)
class Finding:
    """A warning about one place of a script; ``replacement`` is a text to put there instead, or None."""

    code: str
    source: Source
    message: str
    hint: str | None = None
    replacement: str | None = None


@dataclass(frozen=True, repr=False)
class Lint(Answer):
    """Warnings about a script; ``complete`` is False if the time limit was reached before all were searched.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.lint(deixis.read_script(text="fork left of plate; fork left of plate"))
    >>> [(finding.code, finding.message) for finding in found.findings]
    [('F001', 'left(fork, plate) was stated before, in <text>:1:1')]
    """

    file: str
    findings: tuple[Finding, ...]
    complete: bool

    def summary(self) -> str:
        """Return the file and the number of warnings."""
        return f"{self.file}: {count(len(self.findings), 'warning')}"


@checks_arguments
def lint(
    script: Script | str | Path,
    *,
    select: Sequence[str] = (),
    ignore: Sequence[str] = (),
    time_limit: float = LINT_TIME_LIMIT,
) -> Lint:
    """Find what is probably wrong or needless in a script.

    Parameters
    ----------
    script
        The script, or the path of its file.
    select
        Codes, or their beginnings such as ``F``, of the warnings to report; all by default.
    ignore
        Codes, or their beginnings, of the warnings to leave out.
    time_limit
        Seconds for reading the script and for the warnings that need inference.

    Returns
    -------
    Lint
        The warnings in the order of their places.

    Raises
    ------
    DeixisError
        If the script cannot be read, or not in time, or no code begins as ``select`` or ``ignore`` says.

    Examples
    --------
    >>> import deixis
    >>> script = deixis.read_script(text="layout seen from chair; fork left of plate; knife right of plaet")
    >>> [(finding.code, finding.message) for finding in lint(script, select=["N001"]).findings]
    [('N001', "'plaet' is one letter away from 'plate'")]
    """
    for prefix in (*select, *ignore):
        if not prefix or not any(code.startswith(prefix.upper()) for code in CODES):
            raise DeixisError(f"lint: no code begins with '{prefix}'; the codes are {', '.join(CODES)}")
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    read = as_script(script, deadline=deadline)
    from_facts, complete = _inferred_findings(read, deadline)
    found = [*_name_findings(read), *_fact_findings(read), *from_facts]
    found += _number_findings(read) if read.reading is None else _english_findings(read, read.reading)
    shown = [f for f in found if _chosen(f.code, select, ignore) and not _suppressed(read, f)]
    return Lint(read.file, tuple(sorted(shown, key=lambda f: (f.source, f.code))), complete)


def _chosen(code: str, select: Sequence[str], ignore: Sequence[str]) -> bool:
    wanted = not select or code.startswith(tuple(prefix.upper() for prefix in select))
    return wanted and not (ignore and code.startswith(tuple(prefix.upper() for prefix in ignore)))


def _suppressed(script: Script, finding: Finding) -> bool:
    """Return True if a comment ``# noqa`` or ``# noqa: CODE, CODE`` stands on the line of the warning."""
    for comment in script.comments:
        if (comment.source.file, comment.source.line) == (finding.source.file, finding.source.line):
            marked = re.fullmatch(r"noqa(?::\s*(?P<codes>[A-Za-z0-9, ]+))?", comment.text)
            if marked and (marked["codes"] is None or finding.code in re.split("[, ]+", marked["codes"].upper())):
                return True
    return False


def _english_findings(script: Script, reading: Reading) -> Iterator[Finding]:
    """Yield the warnings that only a text in English can have."""
    for sentence in reading.sentences:
        for problem in sentence.problems:
            yield Finding("E001", problem.source, problem.message, problem.hint, problem.replacement)
    for pronoun in reading.doubtful_pronouns:
        others = " or ".join(f"'{name}'" for name in pronoun.others)
        message = f"'{pronoun.word}' is read as '{pronoun.chosen}' but could also mean {others}"
        source = source_of_span(reading.text, pronoun.span, script.file)
        yield Finding("E002", source, message, "repeat the noun")
    for name in reading.uncounted:
        message = f"the number of '{name}' is unknown, so the name stands for all things that fit"
        yield Finding("E003", _written(name, script) or Source(script.file, 1, 1, 1, 1), message, "state the number")


def _written(name: str, script: Script) -> Source | None:
    """Return the place where an English text first says the words of a name; None if it uses other words."""
    reading = script.reading
    if reading is None:
        return None
    words = [name, re.sub(r"_\d+$", "", name), *(m.split()[-1] for m in reading.mentions.get(name, ()) if m)]
    for word in words:
        found = re.search(rf"\b{'[ _-]'.join(map(re.escape, word.split('_')))}\b", reading.text, re.IGNORECASE)
        if found is not None:
            return source_of_span(reading.text, found.span(), script.file)
    return None


def _name_findings(script: Script) -> Iterator[Finding]:
    """Yield the warnings about names: each name once, at its first mention."""
    first: dict[str, Mention] = {}
    uses: Counter[str] = Counter()
    counted = set(script.reading.uncounted) if script.reading is not None else set()
    for statement in script.all_statements():
        for mention in mentions(statement):
            if mention.name in counted:
                continue
            name = plain_name(mention.name)
            if name not in first:
                place = _written(mention.name, script)
                first[name] = mention if place is None else replace(mention, source=place)
            uses[name] += 1
    ontology = script.ontology
    known = {name for name in first if ontology.of_name(name)[0] is not None}
    declared = {plain_name(name) for name in script.kinds}
    misspelt = _misspelt(list(first), known, declared, uses)
    for name, mention in first.items():
        if name in misspelt:
            near = misspelt[name]
            message, hint = f"'{name}' is one letter away from '{near}'", f"did you mean '{near}'?"
            yield Finding("N001", mention.source, message, hint, near if mention.name == name else None)
        elif name not in known | declared:
            kinds = [word for word in one_letter_away(name) if ontology.kinds.of_word(word)]
            kind = max(
                kinds, key=lambda word: SequenceMatcher(None, word, name).ratio(), default=None
            )  # 'fork' for 'forck'
            if kind is not None and len(name) >= MIN_COMPARED_LETTERS:
                message, hint = f"'{name}' is one letter away from '{kind}'", f"did you mean '{kind}'?"
                yield Finding("N001", mention.source, message, hint, kind if mention.name == name else None)
            else:
                message = f"the kind of '{name}' is unknown, so it has no usual size"
                hint = "declare its kind if it is one of docs/reference/ontology.md, as in: soup_spoon is a spoon"
                yield Finding("N003", mention.source, message, hint)
    stated = script.stated if script.reading is None else _connecting(script)
    related = {plain_name(name) for content in stated for name in _ends(content)}
    for name, mention in first.items():
        if name not in related and script.reading is None:
            yield Finding("N002", mention.source, f"'{name}' is declared, but no fact mentions it")
        elif name not in related:
            yield Finding("N002", mention.source, f"nothing says where '{name}' is")


def _number_findings(script: Script) -> Iterator[Finding]:
    """Yield the warnings about numbered and joined names of a layout script: each name once, at its first mention."""
    first: dict[str, Mention] = {}
    for statement in script.all_statements():
        for mention in mentions(statement):
            one = singular(mention.name.replace("_", " ")).replace(" ", "_")
            is_counted = mention.count is not None and is_plural(mention.name)
            if is_counted and one != mention.name and mention.name not in first:
                message = f"'{mention.name}' is a plural, so the members are {_shown(mention.names)}"
                yield Finding("N004", mention.source, message, f"write the singular: {mention.count} {one}")
            for name in (mention.name, *mention.names):
                first.setdefault(name, mention)
    objects, by_noun = set(script.objects), defaultdict[str, list[str]](list)
    for name in script.objects:
        by_noun[plain_name(name)].append(name)
    for name in script.objects:
        numbered = [other for other in by_noun.get(name, ()) if other != name]
        if numbered:
            message = f"'{name}' is another object than {_shown(numbered)}"
            yield Finding("N005", first[name].source, message, "give it a number too, or use one of their names")
        words = name.split("_")
        ends = (("_".join(words[:at]), "_".join(words[at:])) for at in range(1, len(words)))
        joined = next((pair for pair in ends if objects.issuperset(pair) and plain_name(pair[1]) != pair[1]), None)
        if joined is not None:
            message = f"'{name}' consists of the names '{joined[0]}' and '{joined[1]}'"
            yield Finding("N006", first[name].source, message, f"for two objects, write {', '.join(joined)}")


def _misspelt(names: list[str], known: set[str], declared: set[str], uses: Counter[str]) -> dict[str, str]:
    """Return the names that are one letter away from another name, with that name.

    Of two names, the one without a kind is misspelt, else the one used less often, else the later one.
    """
    by_key = {key_of(name): name for name in reversed(names)}
    found: dict[str, str] = {}
    for place, name in enumerate(names):
        if len(name) < MIN_COMPARED_LETTERS or name in known | declared:
            continue
        for key in one_letter_away(key_of(name)):
            other = by_key.get(key)
            if other is None or len(other) < MIN_COMPARED_LETTERS or other in found:
                continue
            here, there = (uses[name], -place), (uses[other], -names.index(other))
            if other in known | declared or here < there:
                found[name] = other
                break
    return found


def one_letter_away(word: str) -> Iterator[str]:
    """Yield the words one edit away (Damerau 1964): neighbours exchanged, or a letter left out, changed or added.

    Single letters and numbers as parts of a name are left as they are, since they number things.

    Parameters
    ----------
    word
        A name, with underscores.

    Yields
    ------
    str
        A word, possibly more than once.

    Examples
    --------
    >>> sorted({"fork", "frok"} & set(one_letter_away("frk"))), "cup_b" in one_letter_away("cup_a")
    (['fork', 'frok'], False)
    """
    for at in range(len(word) + 1):
        head, tail = word[:at], word[at:]
        if re.search(r"(?:^|[_-])(?:\w|\d+)?$", head) and re.match(r"(?:\w|\d+)?(?:$|[_-])", tail):
            continue
        yield from (head + letter + tail for letter in LETTERS)
        if tail:
            yield head + tail[1:]
            yield from (head + letter + tail[1:] for letter in LETTERS if letter != tail[0])
        if len(tail) > 1 and tail[0] != tail[1]:
            yield head + tail[1] + tail[0] + tail[2:]


def _place(fact: Fact | Claim, script: Script) -> Source:
    return fact.source or Source(script.file, 1, 1, 1, 1)


def _fact_findings(script: Script) -> Iterator[Finding]:
    """Yield the warnings about facts and hedges that need no inference."""
    before: dict[tuple[str, frozenset[str], str, bool], Fact] = {}
    for fact in script.facts:
        place = _place(fact, script)
        key = (fact.subject, frozenset(r.name for r in fact.relations), fact.object, fact.positive)
        earlier = before.setdefault(key, fact)
        if earlier is not fact:
            yield Finding("F001", place, f"{fact} was stated before, in {_place(earlier, script)}")
        for relation in fact.relations:
            wider = [r for r in fact.relations if r.name in relation.broader]
            if wider:
                message = f"'{relation.phrase}' is a special case of the alternative '{wider[0].phrase}'"
                yield Finding("F005", place, message, "leave one of them out")
        if not fact.positive and fact.rare:
            yield Finding("H002", place, f"{fact} is denied twice", "say that it usually holds")
    for statement in script.all_statements():
        how = getattr(statement, "modifiers", None)
        if how is not None and how.hedge is not None and how.weight >= 1:
            yield Finding("H001", statement.source, f"'{how.hedge}' has the weight 1, so it changes nothing")
    sided = [s for s in script.all_statements() if isinstance(s, RelationStatement)]
    first = next((s for s in sided if any(r.z_atoms == 0 for r in s.relations)), None)
    if script.viewpoint is None and first is not None and script.file.endswith(".layout"):
        hint = "begin with a header, as in: layout seen from chair"
        yield Finding("L001", first.source, "the script does not say from where left and right are seen", hint)


def _inferred_findings(script: Script, deadline: Deadline) -> tuple[list[Finding], bool]:
    """Return the warnings that need inference, and whether all were searched within the time limit."""
    from deixis.reasoning.entailment.redundant import redundant_facts
    from deixis.reasoning.errors import OutOfTimeError
    from deixis.workflows.layouts.infer import inference_of, verdict_of

    if not script.stated:
        return [], True
    try:
        verdict = verdict_of(script, deadline.left)
    except OutOfTimeError:
        verdict = None
    if verdict is False:
        conflict = inference_of(script, deadline.left).conflict
        if conflict is None:
            return [], False
        facts = conflict.facts
        where = ", ".join(str(_place(fact, script)) for fact in facts[:-1])
        message = f"{conflict.reason} (with {where})" if where else conflict.reason
        return [Finding("F003", _place(facts[-1], script), message)], True
    connecting = _connecting(script)
    groups = list(_groups(script.objects, connecting))
    found = []
    for group in groups[1:]:
        stated = next(stated for stated in connecting if not group.isdisjoint(_ends(stated)))
        some, others = (_shown([name for name in script.objects if name in members]) for members in (group, groups[0]))
        found.append(Finding("F004", _place(stated, script), f"no facts connect {some} with {others}"))
    if verdict is None:
        return found, False
    graph = script.graph()
    redundant, complete = redundant_facts(graph, deadline)
    seen: set[str] = set()
    for number, fact in enumerate(script.facts):
        if number in redundant and str(fact) not in seen:
            found.append(Finding("F002", _place(fact, script), f"{fact} follows from the other facts"))
        seen.add(str(fact))
    return found, complete


def _shown(names: Sequence[str]) -> str:
    """Return the first names of a group in quotation marks, and the number of the others."""
    more = len(names) - MAX_NAMES_SHOWN
    first = ", ".join(f"'{name}'" for name in names[:MAX_NAMES_SHOWN])
    return f"{first} and {more} more" if more > 0 else first


_SURFACE = ""
"""Node of the surface, which connects everything that has a place on it."""


def _connecting(script: Script) -> list[Fact | Claim]:
    """Return the facts and claims that relate objects or place them, not those about properties of one."""
    return [stated for stated in script.stated if isinstance(stated, Fact) or stated.relation not in PROPERTIES]


def _ends(stated: Fact | Claim) -> tuple[str, ...]:
    """Return the objects that a fact or a claim connects."""
    if isinstance(stated, Fact):
        return stated.subject, stated.object
    places_on_surface = stated.relation in ON_SURFACE and not stated.arguments
    return (*stated.subjects, *stated.arguments, *((_SURFACE,) if places_on_surface else ()))


def _groups(objects: Sequence[str], stated: Iterable[Fact | Claim]) -> Iterator[set[str]]:
    """Yield the sets of objects that facts and claims connect, in the order of the script, without single objects."""
    near: dict[str, list[str]] = defaultdict(list)
    for first, *others in map(_ends, stated):
        for other in others:
            near[first].append(other)
            near[other].append(first)
    seen: set[str] = set()
    for name in objects:
        if name in seen or name not in near:
            continue
        group, waiting = {name}, [name]
        while waiting:
            for other in near[waiting.pop()]:
                if other not in group:
                    group.add(other)
                    waiting.append(other)
        seen |= group
        yield group
