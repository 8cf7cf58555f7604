"""Measure the reading of English: facts of paragraphs about tables, traps, and the objects that the names refer to.

``$DEIXIS_DATA/english``: paragraphs with the facts that they state (``facts.json``), their scenes and the objects that
are meant (``truth.json``), and traps: sentences with facts that must not come out.

An object of ours is matched with a name of the truth by its words: one of its mentions, or its name, has the same words
(articles and possessives left out), or the last word of the one is the noun of the other and no other object has it.
Relations are compared up to synonyms (``near`` and ``next_to``, ``larger`` and ``bigger``). A fact of the truth is
found if a fact of ours has its relation, its sign, and one of its objects in each place. A fact of ours is right if a
fact of the truth agrees in the same way; the surface, adjectives and counts that the truth leaves out are not counted.

Prints recall, precision, traps, and with ``--ground`` the share of mentioned objects that are grounded right.

``--made N`` makes sentences from the templates in ``english_traps.txt``, which state a place or only mention one, and
prints which of them are misread.

``--texts FOLDER`` measures texts with their facts in short notation instead (``tests/grammar/english/texts``): after
``=== name`` the lines of the text, then lines ``> relation(subject, object); …`` with what it states, and
``> ? relation(…)`` with what may come out too. ``not`` denies a fact, ``~`` marks one that may come out but not as
asserted, ``corner:far left(lamp)`` has the part that is meant. A line of ``traps.txt`` is a sentence, a bar, and the
facts that must not be asserted.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from common import data_folder
from english_traps import STATEMENTS, Made, made
from records import command_line, count, recorded, share

from deixis.errors import DeixisError
from deixis.grammar.english import confidence
from deixis.grammar.english.reader import read_english
from deixis.ontology.graph.facts import Fact as ScriptFact
from deixis.report.layouts.read import reading_to_dict

SAME = {
    "next_to": "near", "larger": "bigger", "nearer": "closer", "farthest_from": "farthest", "centre": "middle",
    "part": "place", "edge": "place", "end": "place", "side": "place", "left of": "left",
}  # fmt: skip
SIDES = {"back": "far", "front": "near", "rear": "far"}
OPPOSITE = {"smaller": "bigger", "shorter": "taller"}
DETERMINERS = frozenset(
    ["the", "a", "an", "my", "your", "his", "her", "our", "their", "its", "this", "that", "these", "those"]
)
ADJECTIVES = frozenset(
    ["count", "colour", "size", "material", "contents", "kind", "state", "shape", "height", "length", "width",
     "thickness", "empty", "open", "closed", "none_on", "none_inside", "none_under", "none_next_to"]
)  # fmt: skip
"""Relations of facts that tell no place."""
NOT_COUNTED = frozenset({"count", "size", "colour", "material", "shape", "state", "with"})
Fact = dict[str, Any]


def words(name: str) -> tuple[str, ...]:
    """Return the words of a name in the singular, without articles and numbers."""
    found = re.sub(r"[_'’-]", " ", name.casefold()).split()
    kept = [word for word in found if word not in DETERMINERS and not word.isdigit()]
    return tuple(word.removesuffix("s") for word in kept)


class Names:
    """Correspondence between the names of a truth and the objects that were read."""

    def __init__(self, read: Fact) -> None:
        self.wordings = {
            thing["id"]: {words(phrase) for phrase in (thing["id"], *thing["mentions"])} for thing in read["objects"]
        }
        for name in read["absent"]:
            self.wordings.setdefault(name, {words(name)})
        if read.get("surface"):
            self.wordings.setdefault(read["surface"], {words(read["surface"])})

    def of(self, name: str) -> set[str]:
        """Return our objects for a name of the truth."""
        meant = words(name)
        exact = {ours for ours, wordings in self.wordings.items() if meant in wordings}
        if exact or not meant:
            return exact
        return {
            ours for ours, wordings in self.wordings.items() if any(one and one[-1] == meant[-1] for one in wordings)
        }


FACT = re.compile(r"(?P<mark>~?)(?P<no>not )?(?P<relation>\w+)(?::(?P<part>[^(]+))?\((?P<names>[^)]*)\)")


def written_facts(line: str) -> Iterator[Fact]:
    """Yield the facts of a line in short notation.

    >>> next(written_facts("not corner:far left(lamp, desk)"))["part"]
    'far left'
    """
    for match in FACT.finditer(line):
        subject, *ends = [name.strip() for name in match["names"].split(",")]
        yield {
            "relation": match["relation"], "subject": subject, "object": ends, "negated": bool(match["no"]),
            "part": match["part"], "asserted": not match["mark"],
        }  # fmt: skip


@dataclass(frozen=True, slots=True)
class Text:
    """A text with the facts that it states, and the facts that may come out too."""

    name: str
    text: str
    stated: list[Fact]
    allowed: list[Fact]


def written_texts(file: Path) -> Iterator[Text]:
    """Yield the texts of a file with their facts."""
    for entry in file.read_text(encoding="utf-8").split("=== ")[1:]:
        name, _, body = entry.partition("\n")
        facts = [line[2:] for line in body.splitlines() if line.startswith("> ")]
        yield Text(
            name.strip(),
            "\n".join(line for line in body.splitlines() if not line.startswith(">")).strip() + "\n",
            [fact for line in facts if not line.startswith("?") for fact in written_facts(line)],
            [fact for line in facts if line.startswith("?") for fact in written_facts(line)],
        )


def named(entry: Any) -> list[str]:
    """Return the names in a place of a fact."""
    return [] if entry is None else [str(one) for one in entry] if isinstance(entry, list) else [str(entry)]


def relation_of(fact: Fact) -> tuple[str, bool]:
    """Return the relation up to synonyms, and True if subject and object change places."""
    relation: str = SAME.get(str(fact["relation"]), str(fact["relation"]))
    return OPPOSITE.get(relation, relation), relation in OPPOSITE


def agree(ours: Fact, truth: Fact, names: Names, strict: bool = False) -> bool:
    """Return True if a fact of ours says what a fact of the truth says."""
    (mine, swapped), (theirs, swapped_too) = relation_of(ours), relation_of(truth)
    surface_place = mine == "place" and theirs in ("left", "right", "middle")
    if (mine != theirs and not surface_place) or ours["positive"] == truth.get("negated", False):
        return False
    first = set(ours["subjects"]) if ours["subject"] != "*" else {"*"}
    second = {*ours["arguments"], *([ours["object"]] if ours["object"] else [])} - first
    if ours["subject"] == "*":
        second = {*ours["arguments"], *([ours["object"]] if ours["object"] else [])}
    wanted = {one for name in named(truth["subject"]) for one in ({"*"} if name == "*" else names.of(name))}
    ends = {one for name in named(truth["object"]) for one in names.of(name)}
    if strict and not ends and named(truth["object"]):
        return False
    if swapped != swapped_too:
        first, second = second, first
    if truth.get("part") and "asserted" in truth and not _sides(truth["part"]) <= _sides(ours["value"]):
        return False
    return bool(first & wanted) and (not ends or (not second and not strict) or bool(second & ends))


def _sides(part: str | None) -> set[str]:
    return {SIDES.get(word, word) for word in (part or "").split()}


def counted(fact: Fact) -> bool:
    """Return True for a fact of ours that the truth would list."""
    alone = not fact["object"] and fact["relation"] in ("on", "inside")
    return fact["asserted"] and fact["relation"] not in NOT_COUNTED and not alone


def traps(folder: Path) -> Iterator[tuple[str, str]]:
    """Yield each false fact with its text."""
    for line in (folder / "traps.jsonl").read_text(encoding="utf-8").splitlines():
        trap = json.loads(line)
        try:
            read = reading_to_dict(read_english(trap["text"]))
        except DeixisError:
            continue
        names = Names(read)
        for fact in read["facts"]:
            if not fact["asserted"]:
                continue
            may = any(agree(fact, other, names) for other in trap["may"])
            if not may and any(agree(fact, other, names) for other in trap["must_not"]):
                yield trap["text"], f"{fact['relation']}({fact['subject']}, {fact['object']})"


def measure_texts(folder: Path, verbose: bool) -> tuple[Score, list[tuple[str, str]]]:
    """Return the score of the texts of a folder, and the traps that become facts."""
    score, wrong = Score(), []
    for file in sorted(folder.glob("*.txt")):
        if file.name == "traps.txt":
            wrong = list(written_traps(file))
            continue
        for text in written_texts(file):
            score.add(text, verbose)
    return score, wrong


def places_asserted(text: str) -> list[tuple[str, str]]:
    """Return the places that a text asserts, as relations and facts; not what is only adjectives and counts."""
    try:
        reading = read_english(text).reading
    except DeixisError:
        return []
    assert reading is not None
    stated = [fact.content for fact in reading.stated if fact.asserted and fact.content.positive]
    named = [(c.relations[0].name if isinstance(c, ScriptFact) else c.relation, str(c)) for c in stated]
    return [(relation, shown) for relation, shown in named if relation not in ADJECTIVES]


def wrong_about(sentence: Made) -> list[str]:
    """Return the false facts of a made sentence, or its place if it states one that was not read."""
    facts = places_asserted(sentence.text)
    if sentence.group == STATEMENTS:
        return [] if any(relation == sentence.relation for relation, _ in facts) else [sentence.relation]
    elsewhere = "in the sink" in sentence.text
    return [shown for _, shown in facts if not (elsewhere and "sink" in shown)]


def print_made(samples: int) -> None:
    """Print how many made traps become facts, and how many made statements do not."""
    wrong = {True: 0, False: 0}
    total = {True: 0, False: 0}
    for sentence in made(samples):
        states = sentence.group == STATEMENTS
        faults = wrong_about(sentence)
        wrong[states], total[states] = wrong[states] + bool(faults), total[states] + 1
        if faults:
            print(f"    {sentence.text} {'no ' * states}{', '.join(faults)}")
    print(f"{wrong[False]} of {total[False]} made traps become facts; {wrong[True]} of {total[True]} statements do not")


def print_guesses(folder: Path) -> None:
    """Print the share of right facts by the guesses at which they were read; doubtful facts count as asserted."""
    confidence.MIN_CONFIDENCE = {confidence.Standing.ASSERTED: 0.0}
    shares: dict[str, Score] = {}
    for file in sorted(path for path in folder.glob("*.txt") if path.name != "traps.txt"):
        for text in written_texts(file):
            script = read_english(text.text, text.name)
            read = reading_to_dict(script)
            assert script.reading is not None
            names = Names(read)
            possible = [{**fact, "part": None} for fact in (*text.stated, *text.allowed) if fact["asserted"]]
            for stated, fact in zip(script.reading.stated, read["facts"], strict=True):
                if counted(fact) and fact["relation"] not in ("contents", "kind"):
                    right = any(agree(fact, other, names) for other in possible)
                    for name in stated.guesses or ("NONE",):
                        score = shares.setdefault(name, Score())
                        score.right, score.read_facts = score.right + right, score.read_facts + 1
    for name, score in shares.items():
        print(f"{name:12s} {score.right / score.read_facts:.3f} of {score.read_facts}")


def written_traps(file: Path) -> Iterator[tuple[str, str]]:
    """Yield each sentence of a file of traps that gives a fact which it must not give."""
    for line in file.read_text(encoding="utf-8").splitlines():
        sentence, _, facts = line.partition(" | ")
        try:
            read = reading_to_dict(read_english(sentence))
        except DeixisError:
            continue
        names, refused = Names(read), list(written_facts(facts))
        for fact in read["facts"]:
            if fact["asserted"] and any(agree(fact, other, names, strict=True) for other in refused):
                yield sentence, f"{fact['relation']}({fact['subject']}, {fact['object']})"


@dataclass(slots=True)
class Score:
    """Counts of stated facts and of the facts that were read, over texts."""

    found: int = 0
    stated: int = 0
    right: int = 0
    read_facts: int = 0

    def add(self, text: Text, verbose: bool = False) -> None:
        """Read a text and compare its facts; print what is missing or wrong if ``verbose``."""
        try:
            read = reading_to_dict(read_english(text.text, text.name))
        except DeixisError as error:
            read = {"objects": [], "facts": [], "absent": []}
            if verbose:
                print(f"{text.name}: {error}")
        names = Names(read)
        for fact in text.stated:
            hit = any(ours["asserted"] and agree(ours, fact, names) for ours in read["facts"])
            hit = hit or (fact["negated"] and _absent(fact, read))
            self.found, self.stated = self.found + hit, self.stated + 1
            if verbose and not hit:
                print(f"{text.name}: missing {_shown(fact)}")
        possible = [fact for fact in (*text.stated, *text.allowed) if fact["asserted"]]
        for ours in filter(counted, read["facts"]):
            if ours["relation"] in ("contents", "kind"):
                continue
            hit = any(agree(ours, {**fact, "part": None}, names) for fact in possible)
            self.right, self.read_facts = self.right + hit, self.read_facts + 1
            if verbose and not hit:
                ends = [ours["object"]] if ours["object"] else ours["arguments"]
                print(f"{text.name}: not in the truth {ours['relation']}({ours['subjects']}, {ends})")


def _shown(fact: Fact) -> str:
    part = f":{fact['part']}" if fact["part"] else ""
    return f"{'not ' * fact['negated']}{fact['relation']}{part}({', '.join([fact['subject'], *fact['object']])})"


def grounded(case: Path, names: Names) -> tuple[int, int]:
    """Return how many of the mentioned objects are right, and how many there are."""
    from deixis.workflows.grounding.ground import ground
    from deixis.workflows.layouts.read import read_script

    truth = json.loads((case / "truth.json").read_text(encoding="utf-8"))
    found = ground(read_script(case / "text.txt"), case / "table.scene.json", time_limit=20.0).matches
    right = total = 0
    for name, meant in truth.items():
        if name.startswith("_") or name == "notes":
            continue
        total += 1
        ours = {found[one].perceived for one in names.of(name) if one in found}
        wanted = set(named(meant))
        right += (not ours) if not wanted else bool(ours) and (ours <= wanted if len(wanted) > 1 else ours == wanted)
    return right, total


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--ground", action="store_true", help="ground the texts in their scenes as well")
    parser.add_argument("--verbose", action="store_true", help="print the facts that are missing or wrong")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--made", type=int, metavar="N", help="make N sentences of each template of english_traps.txt")
    parser.add_argument("--guesses", action="store_true", help="print the share of right facts by guess (with --texts)")
    parser.add_argument("--texts", type=Path, metavar="FOLDER", help="measure texts in short notation instead")
    with recorded(parser) as options:
        if options.made is not None:
            print_made(options.made)
            return
        if options.texts is not None and options.guesses:
            print_guesses(options.texts)
            return
        if options.texts is not None:
            score, wrong = measure_texts(options.texts, options.verbose)
            share("stated facts of texts found", score.found, score.stated)
            share("facts of texts read that they state", score.right, score.read_facts)
            found, right = score.found / score.stated, score.right / score.read_facts
            print(f"facts found {found:.3f} of {score.stated}; of our {score.read_facts} facts {right:.3f} are stated")
            print(f"traps that become false facts: {len(wrong)}", *(f"\n    {text}: {fact}" for text, fact in wrong))
            return
        folder = data_folder("english")
        if folder is None:
            return
        found = stated = right = read_facts = placed = mentioned = 0
        for case in sorted(path for path in folder.iterdir() if path.is_dir()):
            read = reading_to_dict(read_english((case / "text.txt").read_text(encoding="utf-8"), case.name))
            names, truth = Names(read), json.loads((case / "facts.json").read_text(encoding="utf-8"))
            for fact in truth:
                hit = any(agree(ours, fact, names) for ours in read["facts"])
                hit = hit or (fact["object"] == "0" and bool(words(fact["subject"])) and _absent(fact, read))
                found, stated = found + hit, stated + 1
                if options.verbose and not hit:
                    print(f"{case.name}: missing {fact}")
            for ours in filter(counted, read["facts"]):
                hit = any(agree(ours, fact, names) for fact in truth)
                right, read_facts = right + hit, read_facts + 1
                if options.verbose and not hit:
                    print(f"{case.name}: not in the truth {ours['relation']}({ours['subjects']}, {ours['arguments']})")
            if options.ground:
                one, of = grounded(case, names)
                placed, mentioned = placed + one, mentioned + of
                if options.verbose:
                    print(f"{case.name}: {one} of {of} objects")
        wrong = list(traps(folder))
        answer = {
            "facts": stated, "recall": round(found / stated, 3), "precision": round(right / read_facts, 3),
            "traps_wrong": len(wrong), "objects_right": round(placed / mentioned, 3) if mentioned else None,
        }  # fmt: skip
        share("stated facts found", found, stated)
        share("facts read that are in the truth", right, read_facts)
        count("traps that become false facts", len(wrong))
        share("mentioned objects grounded right", placed, mentioned)
        if options.json:
            print(json.dumps(answer))
            return
        print(
            f"facts found {answer['recall']} of {stated}; "
            f"of our {read_facts} facts {answer['precision']} are in the truth"
        )
        print(f"traps that become false facts: {len(wrong)}", *(f"\n    {text}: {fact}" for text, fact in wrong))
        if mentioned:
            print(f"objects grounded right: {answer['objects_right']} of {mentioned}")


def _absent(fact: Fact, read: Fact) -> bool:
    return any(words(name) == words(fact["subject"]) for name in read["absent"])


if __name__ == "__main__":
    main()
