"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.21       2.02       0.83      -2.67      -1.30      -2.75       1.03       1.06      -0.53
be                    -1.85      -1.69       0.62      -1.69       2.02       2.81          -       0.33          -
by                    -1.88          -      -0.88      -1.77          -       2.35          -          -          -
determiner             2.58       2.84      -1.64      -2.52       0.16      -2.57      -1.25      -0.67       0.20
ing                   -0.77       1.51      -0.10      -1.09      -0.16       0.85      -0.07          -          -
joint                     -      -0.86      -0.67      -0.38       2.91       0.56       0.57      -0.23          -
modal                 -1.03      -1.36      -0.33       1.30      -0.39      -0.67      -0.79       1.24       0.41
noun                   0.11      -0.83       0.97      -0.86       1.20       0.77       1.11      -1.47      -0.26
of                     1.02       1.24      -0.40      -1.17          -          -          -      -1.25      -0.22
participle             2.27      -0.20       0.54      -1.11      -0.62       1.77          -      -0.15       1.58
place                  0.43          -          -      -0.43          -          -          -          -          -
preposition           -0.28       0.56      -1.05      -1.74       0.19      -0.15       1.18      -0.40      -0.98
pronoun               -2.27      -1.95       2.32       0.42       0.70       0.81       2.17      -0.13       0.99
relative                  -      -0.29       0.56          -       0.21          -       0.38       1.06       0.19
start                  0.26      -0.34      -2.77       0.32       0.62       0.70       0.87      -0.64          -
subordinate            0.55      -0.68      -1.00      -0.32       0.19       1.61       0.56       1.35      -0.33
to                    -0.86       0.86       2.09       0.43       1.09          -          -      -0.15      -0.05
verb                  -1.28      -1.12       0.11       0.11       0.87      -0.69      -0.46       1.12      -0.17
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.10      -2.29       1.09      -0.67       2.03      -0.70       1.53      -0.48       0.54
adverb                -0.56      -1.16       0.72      -0.64       0.24       2.00       1.91      -0.65       0.57
be                     0.52       1.35      -2.19      -0.58      -0.92      -2.59       2.23      -1.74       1.33
colon                  1.66       1.07      -1.77      -2.06      -0.92       1.20      -0.37      -0.38       1.09
determiner            -0.98      -0.41       1.38       0.77       1.69          -       0.61      -0.64      -0.39
digits                 1.70          -       0.24      -1.33      -0.47          -          -          -          -
end                    0.61       1.53      -0.10      -1.09      -0.63       1.32      -0.77      -1.39       1.39
joint                  0.63       1.87          -      -0.81      -0.17       1.05      -0.64      -1.05       1.22
of                     2.37       1.25      -2.12      -1.39      -1.28      -0.70      -0.77       0.38      -0.64
participle             0.25          -      -0.19       0.22      -0.13      -0.34          -       0.75      -0.75
place                 -0.90       0.73       1.16      -0.62       0.79       1.30      -0.75      -2.02       0.73
pronoun               -0.39       1.05       2.79      -1.13      -0.39      -0.39       1.57       0.06      -0.46
relative                  -       0.31      -0.36       0.20       0.80      -0.33          -          -          -
there                 -0.90       0.27       0.56       0.44          -       0.91          -       1.40       1.53
to                    -0.17       0.59       1.35      -1.14       0.15       0.89          -          -          -
verb or noun           1.01      -1.18      -1.57       0.34       1.63      -1.42       1.36      -0.53      -1.35
word                   0.51      -1.86      -0.13      -0.23       2.11      -0.05      -0.23       0.31      -0.81
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.25,
    "-ing before a name": 2.06,
    "-ing before an unknown noun": 0.32,
    "-ing of a known noun": 1.03,
    "-ing of a verb": 0.99,
    "acronym": 0.96,
    "capital within a sentence": 1.11,
    "command before adjective": 1.01,
    "command before adverb": -0.32,
    "command before be": -0.92,
    "command before colon": -1.78,
    "command before determiner": 1.22,
    "command before digits": -1.05,
    "command before joint": -3.04,
    "command before of": -1.71,
    "command before participle": -0.36,
    "command before place": -0.29,
    "command before pronoun": 1.51,
    "command before relative": 0.63,
    "command before there": 1.11,
    "command before to": 0.19,
    "command before verb or noun": 0.43,
    "command before word": -0.19,
    "command like a thing": 0.66,
    "command like a thing without an object": -0.43,
    "command with an object and a place": 2.42,
    "command, comma within a command": -1.67,
    "command, comma within a command, after a subject": -1.59,
    "command, comma within a open": 1.91,
    "command, comma within a open, after a subject": -1.11,
    "command, comma within a statement": -0.47,
    "command, comma within a statement, after a subject": -0.25,
    "command, conjunction within a command": 0.95,
    "command, conjunction within a command, after a subject": 0.23,
    "command, conjunction within a open": 1.51,
    "command, conjunction within a open, after a subject": -1.18,
    "command, conjunction within a statement": -0.25,
    "command, conjunction within a statement, after a subject": 0.53,
    "command, start": 0.32,
    "command, subordinate": -0.27,
    "find": 1.29,
    "finite verb after a joint, within a command": 0.58,
    "finite verb after a joint, within a open": -0.29,
    "finite verb after a joint, within a statement": -1.13,
    "finite verb after a modal verb": -0.83,
    "form in -s": 0.54,
    "form in -s of a known noun": 0.46,
    "hardly a noun": 2.91,
    "infinitive": 0.74,
    "infinitive missing": -1.16,
    "known compound begins": 3.75,
    "known compound ends": 3.24,
    "known noun in -ing": -2.72,
    "left over": 0.59,
    "modal may": 1.99,
    "modal might": 1.37,
    "modal need": 1.46,
    "modal will": 1.40,
    "never a plural": 3.47,
    "noun after a plural": -3.15,
    "object after a transitive verb": 0.86,
    "other command": 0.08,
    "participle like its base": -1.65,
    "participle of a verb": 2.92,
    "past like a noun": 0.95,
    "past of a known noun": 0.33,
    "past of a verb": 1.25,
    "place after a verb of place": 0.69,
    "place after another verb": -1.56,
    "plain form": 1.20,
    "plain form of a known noun": 0.10,
    "plural after a determiner of one": -2.11,
    "plural after a number": 2.20,
    "put": 1.79,
    "rather a noun": -1.72,
    "rather a plural": -1.77,
    "second verb of a clause": -2.66,
    "singular after a number": -1.49,
    "that": 0.38,
    "unknown in -ed": 1.94,
    "unknown in -ing": -0.16,
    "unknown in -s": -2.64,
    "unknown plain form": -3.25,
    "unknown verb before adjective": -0.93,
    "unknown verb before adverb": -1.53,
    "unknown verb before be": -1.19,
    "unknown verb before colon": -0.83,
    "unknown verb before determiner": -1.32,
    "unknown verb before digits": -0.70,
    "unknown verb before end": -0.71,
    "unknown verb before joint": -0.89,
    "unknown verb before of": -0.32,
    "unknown verb before participle": -0.77,
    "unknown verb before place": -0.82,
    "unknown verb before pronoun": -0.41,
    "unknown verb before relative": -0.79,
    "unknown verb before there": -0.55,
    "unknown verb before to": -1.27,
    "unknown verb before verb or noun": -0.59,
    "unknown verb before word": -1.53,
    "verb after a place only": -0.78,
    "verb agrees": 0.49,
    "verb disagrees": -2.05,
    "verb missing": -0.14,
    "verb of saying": 1.82,
    "verb without a subject": -2.38,
}
"""Evidence of a word for one of its classes, and of its clause for or against a verb."""


def _cells(table: str, side: str) -> dict[str, float]:
    columns, *rows = table.strip("\n").splitlines()
    found = {}
    for row in rows:
        name, values = row[:16].strip(), row[16:].split()
        for column, value in zip(columns.split(), values, strict=True):
            if value != "-":
                found[f"{column} {side} {name}"] = float(value)
    return found


WEIGHTS: dict[str, float] = {**_cells(_AFTER, "after"), **_cells(_BEFORE, "before"), **_SINGLE}
"""Weight of each feature by its name."""
