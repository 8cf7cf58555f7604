"""Measure the reading of English: facts of paragraphs about tables, traps, and the objects that the names refer to.

``$DEIXIS_DATA/english``: paragraphs with the facts that they state (``facts.json``), their scenes and the objects that
are meant (``truth.json``), and traps: sentences with facts that must not come out.

An object of ours is matched with a name of the truth by its words: one of its mentions, or its name, has the same words
(articles and possessives left out), or the last word of the one is the noun of the other and no other object has it.
Relations are compared up to synonyms (``near`` and ``next_to``, ``larger`` and ``bigger``). A fact of the truth is
found if a fact of ours has its relation, its sign, and one of its objects in each place. A fact of ours is right if a
fact of the truth agrees in the same way; the surface, adjectives and counts that the truth leaves out are not counted.

Prints recall, precision, traps, and with ``--ground`` the share of mentioned objects that are grounded right.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from common import data_folder
from records import command_line, count, recorded, share

from deixis.errors import DeixisError
from deixis.grammar.english.reader import read_english
from deixis.report.read import reading_to_dict

SAME = {
    "next_to": "near", "larger": "bigger", "nearer": "closer", "farthest_from": "farthest", "centre": "middle",
    "part": "place", "edge": "place", "end": "place", "side": "place", "left of": "left",
}  # fmt: skip
OPPOSITE = {"smaller": "bigger", "shorter": "taller"}
DETERMINERS = frozenset(
    ["the", "a", "an", "my", "your", "his", "her", "our", "their", "its", "this", "that", "these", "those"]
)
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
        self.said = {
            thing["id"]: {words(phrase) for phrase in (thing["id"], *thing["mentions"])} for thing in read["objects"]
        }

    def of(self, name: str) -> set[str]:
        """Return our objects for a name of the truth."""
        meant = words(name)
        exact = {ours for ours, said in self.said.items() if meant in said}
        if exact or not meant:
            return exact
        return {ours for ours, said in self.said.items() if any(one and one[-1] == meant[-1] for one in said)}


def named(entry: Any) -> list[str]:
    """Return the names in a place of a fact."""
    return [] if entry is None else [str(one) for one in entry] if isinstance(entry, list) else [str(entry)]


def relation_of(fact: Fact) -> tuple[str, bool]:
    """Return the relation up to synonyms, and True if subject and object change places."""
    relation: str = SAME.get(str(fact["relation"]), str(fact["relation"]))
    return OPPOSITE.get(relation, relation), relation in OPPOSITE


def agree(ours: Fact, truth: Fact, names: Names) -> bool:
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
    if swapped != swapped_too:
        first, second = second, first
    return bool(first & wanted) and (not ends or not second or bool(second & ends))


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


def grounded(case: Path, names: Names) -> tuple[int, int]:
    """Return how many of the mentioned objects are right, and how many there are."""
    from deixis.workflows.ground import ground
    from deixis.workflows.read import read_script

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
    with recorded(parser) as options:
        folder = data_folder("english")
        if folder is None:
            return
        found = stated = right = told = placed = mentioned = 0
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
                right, told = right + hit, told + 1
                if options.verbose and not hit:
                    print(f"{case.name}: not in the truth {ours['relation']}({ours['subjects']}, {ours['arguments']})")
            if options.ground:
                one, of = grounded(case, names)
                placed, mentioned = placed + one, mentioned + of
                if options.verbose:
                    print(f"{case.name}: {one} of {of} objects")
        wrong = list(traps(folder))
        answer = {
            "facts": stated, "recall": round(found / stated, 3), "precision": round(right / told, 3),
            "traps_wrong": len(wrong), "objects_right": round(placed / mentioned, 3) if mentioned else None,
        }  # fmt: skip
        share("stated facts found", found, stated)
        share("facts read that are in the truth", right, told)
        count("traps that become false facts", len(wrong))
        share("mentioned objects grounded right", placed, mentioned)
        if options.json:
            print(json.dumps(answer))
            return
        print(f"facts found {answer['recall']} of {stated}; of our {told} facts {answer['precision']} are in the truth")
        print(f"traps that become false facts: {len(wrong)}", *(f"\n    {text}: {fact}" for text, fact in wrong))
        if mentioned:
            print(f"objects grounded right: {answer['objects_right']} of {mentioned}")


def _absent(fact: Fact, read: Fact) -> bool:
    return any(words(name) == words(fact["subject"]) for name in read["absent"])


if __name__ == "__main__":
    main()
