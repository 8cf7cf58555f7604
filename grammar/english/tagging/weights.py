"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.16       1.90       0.78      -2.51      -1.33      -2.45       1.19       1.10      -0.28
be                    -2.02      -1.53       0.53      -1.56       1.92       2.91          -       0.27          -
by                    -1.89          -      -0.80      -1.64          -       2.09          -       0.10      -0.10
determiner             2.61       2.72      -1.55      -2.46       0.08      -2.59      -1.23      -0.52       0.31
ing                   -0.85       1.37       0.10      -1.29      -0.15       0.86      -0.13      -0.09      -0.27
joint                 -0.12      -0.85      -0.74          -       2.73       0.43       0.52      -0.37      -0.37
modal                 -0.97      -1.00      -0.19       1.58          -      -0.68      -0.71       1.22       0.28
noun                   0.10      -0.86       0.98      -0.58       1.11       0.60       1.18      -1.42      -0.20
of                     1.45       0.97      -0.27      -1.68          -          -          -      -1.08          -
participle             2.15      -0.26       0.37      -0.92      -0.17       1.58          -      -0.20       1.91
place                  0.31          -          -      -0.31          -          -          -          -          -
preposition           -0.41       0.70      -1.11      -1.89      -0.06      -0.44       1.04      -0.45      -0.87
pronoun               -2.57      -2.11       2.34       0.47       0.77       0.47       1.84          -       0.92
relative               0.11      -0.21       0.46       0.34          -          -       0.39       1.20       0.18
start                     -          -      -2.77       0.40       0.76       0.37       0.51      -0.36      -0.25
subordinate            0.29      -0.98      -1.10      -0.17          -       1.22       0.61       1.46      -0.33
to                    -0.84       0.74       2.14       0.29       1.06          -          -      -0.16      -0.13
verb                  -1.22      -1.14       0.11       0.17       0.70      -0.81      -0.23       1.21      -0.11
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -      -2.16       0.94      -0.71       2.11      -0.73       0.78      -0.47       0.56
adverb                -0.44      -1.23       0.86      -0.44       0.48       2.14       2.07      -0.59       0.64
be                     0.36       1.29      -2.53      -0.41      -1.11      -2.07       2.29      -1.36       0.73
colon                  1.76       1.44      -1.92      -1.71      -1.01       1.43      -0.40      -0.83       1.24
determiner            -0.93      -0.51       1.69       0.91       1.43          -       0.75      -0.53      -0.39
digits                 1.61          -       0.25      -1.28      -0.46          -          -          -          -
end                    0.57       1.75      -0.06      -1.03      -0.54       1.06      -0.58      -1.34       1.34
joint                  0.42       1.92      -0.23      -0.85      -0.34       0.62      -1.24      -0.95       1.15
of                     2.16       1.25      -2.48      -1.35      -1.18      -0.84      -0.83       0.45      -0.73
participle             0.08          -      -0.29       0.10      -0.18      -0.46          -       0.59      -0.59
place                 -0.71       0.85       1.34      -0.34       0.78       1.33      -0.75      -1.92       0.91
pronoun               -0.31       1.43       3.08      -0.80      -0.36      -0.35       1.55          -      -0.57
relative              -0.05       0.26      -0.21       0.27       0.80      -0.36          -          -          -
there                 -0.86       0.24       0.50       0.42          -       0.92          -       1.31       1.57
to                    -0.36       0.58       1.21      -1.30       0.10       0.68          -          -          -
verb or noun           0.80      -1.02      -1.77       0.20       1.63      -1.81       1.00      -0.73      -1.21
word                   0.35      -1.60      -0.24      -0.33       2.08      -0.19       0.07       0.18      -0.60
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.33,
    "-ing before a name": 2.22,
    "-ing before an unknown noun": 0.13,
    "-ing of a known noun": 1.20,
    "-ing of a verb": 1.27,
    "acronym": 0.91,
    "capital within a sentence": 1.25,
    "command before adjective": 0.97,
    "command before adverb": -0.41,
    "command before be": -1.80,
    "command before colon": -1.55,
    "command before determiner": 1.19,
    "command before digits": -1.07,
    "command before end": -0.07,
    "command before joint": -3.69,
    "command before of": -1.98,
    "command before participle": -0.42,
    "command before place": -0.46,
    "command before pronoun": 1.22,
    "command before relative": 0.52,
    "command before there": 1.03,
    "command before verb or noun": 0.47,
    "command before word": -0.25,
    "command like a thing": 0.53,
    "command like a thing without an object": -0.45,
    "command with an object and a place": 2.29,
    "command, comma within a command": -1.64,
    "command, comma within a command, after a subject": -1.50,
    "command, comma within a open": 1.80,
    "command, comma within a open, after a subject": -1.21,
    "command, comma within a statement": -0.48,
    "command, comma within a statement, after a subject": -0.31,
    "command, conjunction within a command": 0.91,
    "command, conjunction within a command, after a subject": 0.28,
    "command, conjunction within a open": 1.45,
    "command, conjunction within a open, after a subject": -1.23,
    "command, conjunction within a statement": -0.31,
    "command, conjunction within a statement, after a subject": 0.50,
    "command, start": 0.40,
    "command, subordinate": -0.17,
    "command, subordinate, after a subject": 0.37,
    "find": 1.24,
    "finite verb after a joint, within a command": 0.41,
    "finite verb after a joint, within a open": -0.28,
    "finite verb after a joint, within a statement": -1.23,
    "finite verb after a modal verb": -0.50,
    "form in -s": 0.49,
    "form in -s of a known noun": 0.43,
    "hardly a noun": 3.03,
    "infinitive": 1.10,
    "infinitive missing": -0.86,
    "known compound begins": 3.92,
    "known compound ends": 3.18,
    "known noun in -ing": -3.07,
    "left over": 0.76,
    "modal can": -0.36,
    "modal may": 1.97,
    "modal might": 1.15,
    "modal need": 1.33,
    "modal will": 1.26,
    "never a plural": 3.70,
    "noun after a plural": -3.07,
    "object after a transitive verb": 0.86,
    "other command": -0.08,
    "participle like its base": -1.56,
    "participle of a verb": 3.23,
    "past like a noun": 0.83,
    "past of a verb": 0.77,
    "place after a verb of place": 0.72,
    "place after another verb": -1.52,
    "plain form": 0.95,
    "plain form of a known noun": -0.14,
    "plural after a determiner of one": -2.08,
    "plural after a number": 2.15,
    "put": 1.66,
    "rather a noun": -1.74,
    "rather a plural": -1.84,
    "second verb of a clause": -2.62,
    "singular after a number": -1.72,
    "that": 0.32,
    "unknown in -ed": 1.97,
    "unknown in -ing": 0.10,
    "unknown in -s": -3.01,
    "unknown plain form": -3.79,
    "unknown verb before adjective": -0.82,
    "unknown verb before adverb": -1.35,
    "unknown verb before be": -1.51,
    "unknown verb before colon": -0.61,
    "unknown verb before determiner": -1.17,
    "unknown verb before digits": -0.99,
    "unknown verb before end": -0.64,
    "unknown verb before joint": -0.77,
    "unknown verb before of": -0.32,
    "unknown verb before participle": -0.88,
    "unknown verb before place": -0.71,
    "unknown verb before pronoun": -0.53,
    "unknown verb before relative": -1.04,
    "unknown verb before there": -0.32,
    "unknown verb before to": -1.07,
    "unknown verb before verb or noun": -0.47,
    "unknown verb before word": -1.24,
    "verb after a place only": -0.83,
    "verb agrees": 0.47,
    "verb disagrees": -2.11,
    "verb missing": -0.11,
    "verb of saying": 1.87,
    "verb without a subject": -2.48,
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
