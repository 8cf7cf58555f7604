"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.11       2.32       0.95      -2.64      -1.67      -2.69       1.46       1.01      -0.33
be                    -2.00      -1.63       0.53      -1.88       1.88       2.75          -       0.50      -0.11
by                    -1.78          -      -0.91      -1.53          -       2.24          -       0.10      -0.10
determiner             2.38       2.86      -1.38      -2.20      -0.15      -3.02      -1.12      -0.71          -
ing                   -0.82       1.55          -      -1.39          -       0.86      -0.23      -0.11          -
joint                 -0.06      -1.01      -0.76      -0.14       2.93       0.57       0.92      -0.18       0.32
modal                 -1.32      -1.31      -0.23       1.67      -0.54      -0.74      -1.20       1.23       0.16
noun                   0.15      -0.79       1.39      -0.51       1.17       0.79       1.39      -1.37      -0.31
of                     0.97       1.22      -0.32      -1.14          -          -          -      -1.21      -0.23
participle             2.12      -0.14       0.26      -1.04      -0.37       1.35          -      -0.17       1.82
place                  0.50          -          -      -0.50          -          -          -          -          -
preposition           -0.62      -0.12      -1.05      -2.14       1.21       0.21       0.78      -0.39      -1.39
pronoun               -2.65      -1.72       2.58       0.44       0.32       0.81       2.05      -0.35       0.19
relative              -0.97      -0.54       1.39      -0.24       0.36          -       0.30       1.12          -
start                  0.17      -0.61      -2.62       0.33       0.79       0.80       0.88      -0.47      -0.13
subordinate            0.66      -1.06      -0.34      -0.18       0.09       1.75       0.60       1.25       0.52
to                    -1.01       0.06       2.00       0.93       0.47          -          -      -0.13      -0.08
verb                  -1.19      -1.12      -0.10       0.57       0.29      -0.85      -0.34       1.14      -0.16
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.19      -2.89       0.82      -0.62       2.11      -0.76       1.23      -0.63       0.64
adverb                -0.53      -1.09       0.24      -0.33       0.43       2.13       1.70      -0.61       0.58
be                     0.61       1.13      -2.52      -0.59      -0.76      -2.27       2.28      -1.42       1.27
colon                  2.06       1.09      -1.85      -1.71      -0.97       1.23      -0.76      -0.53       0.86
determiner            -0.86      -0.49       1.81       0.79       1.67      -0.11       0.77      -0.68      -0.36
digits                 1.60          -       0.31      -1.23      -0.53          -          -          -          -
end                    0.80       1.45      -0.24      -1.28      -0.60       1.71      -0.68      -1.49       1.41
joint                  0.86       1.80      -0.13      -0.90      -0.15       0.46      -1.24      -1.20       1.29
of                     1.74       0.96      -0.86      -1.55      -1.32      -0.75      -0.84       0.10      -0.28
participle            -0.25          -      -0.15       0.18      -0.21      -0.35          -       0.66      -0.66
place                 -0.62       0.81       1.26      -0.49       0.88       0.91      -0.96      -1.87       0.43
pronoun               -0.52       1.38       2.71      -1.18      -0.07       0.25       1.80       0.22          -
relative               0.46       0.31      -0.58       0.10       0.88      -0.31          -          -          -
there                 -0.74       0.10       0.35       0.15          -       0.90          -       1.06       0.98
to                     0.10          -       0.94      -0.91       0.62       0.88          -          -          -
verb or noun           0.93      -1.31      -1.60       0.25       1.56      -1.45       0.98      -0.43      -0.92
word                   0.53      -2.55      -1.05      -0.37       2.20          -      -0.18          -      -1.12
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.54,
    "-ing before a name": 1.88,
    "-ing before an unknown noun": -0.10,
    "-ing of a known noun": 1.21,
    "-ing of a verb": 1.51,
    "acronym": 0.90,
    "capital within a sentence": 1.47,
    "command before adjective": 0.82,
    "command before adverb": -0.19,
    "command before be": -1.70,
    "command before colon": -1.55,
    "command before determiner": 1.38,
    "command before digits": -1.08,
    "command before joint": -3.14,
    "command before of": -1.85,
    "command before participle": -0.56,
    "command before place": -0.38,
    "command before pronoun": 1.23,
    "command before relative": 1.08,
    "command before there": 1.04,
    "command before to": 0.12,
    "command before verb or noun": 1.16,
    "command before word": -0.38,
    "command like a thing": 0.41,
    "command like a thing without an object": -0.55,
    "command with an object and a place": 2.32,
    "command, comma within a command": -1.39,
    "command, comma within a command, after a subject": -1.71,
    "command, comma within a open": 2.22,
    "command, comma within a open, after a subject": -1.12,
    "command, comma within a statement": -0.65,
    "command, comma within a statement, after a subject": -0.43,
    "command, conjunction within a command": 1.12,
    "command, conjunction within a command, after a subject": 0.63,
    "command, conjunction within a open": 1.29,
    "command, conjunction within a open, after a subject": -0.89,
    "command, conjunction within a statement": -0.33,
    "command, conjunction within a statement, after a subject": 0.69,
    "command, start": 0.33,
    "command, subordinate": -0.18,
    "find": 1.11,
    "finite verb after a joint, within a command": 0.66,
    "finite verb after a joint, within a open": -0.27,
    "finite verb after a joint, within a statement": -0.71,
    "finite verb after a modal verb": -0.66,
    "form in -s": 0.94,
    "form in -s of a known noun": 0.16,
    "hardly a noun": 2.81,
    "infinitive": 0.93,
    "infinitive missing": -0.80,
    "known compound begins": 3.47,
    "known compound ends": 1.84,
    "known noun in -ing": -2.17,
    "left over": 0.84,
    "modal can": -0.42,
    "modal may": 2.17,
    "modal might": 1.12,
    "modal need": 1.30,
    "modal will": 1.15,
    "never a plural": 3.35,
    "noun after a plural": -3.34,
    "object after a transitive verb": 1.00,
    "other command": 0.17,
    "participle like its base": -1.41,
    "participle of a verb": 2.53,
    "past like a noun": 0.70,
    "past of a known noun": 0.84,
    "past of a verb": 1.87,
    "place after a verb of place": 0.77,
    "place after another verb": -1.29,
    "plain form": 1.30,
    "plain form of a known noun": 0.11,
    "plural after a determiner of one": -2.23,
    "plural after a number": 2.06,
    "put": 1.45,
    "rather a noun": -1.15,
    "rather a plural": -1.34,
    "second verb of a clause": -2.34,
    "singular after a number": -1.54,
    "that": 0.86,
    "unknown in -ed": 2.18,
    "unknown in -ing": 0.14,
    "unknown in -s": -2.66,
    "unknown plain form": -3.45,
    "unknown verb before adjective": -1.43,
    "unknown verb before adverb": -1.31,
    "unknown verb before be": -1.29,
    "unknown verb before colon": -0.71,
    "unknown verb before determiner": -1.60,
    "unknown verb before digits": -1.24,
    "unknown verb before end": -0.80,
    "unknown verb before joint": -0.69,
    "unknown verb before of": -1.14,
    "unknown verb before participle": -0.79,
    "unknown verb before place": -0.79,
    "unknown verb before pronoun": -0.57,
    "unknown verb before relative": -0.77,
    "unknown verb before there": -0.45,
    "unknown verb before to": 0.19,
    "unknown verb before verb or noun": -1.29,
    "unknown verb before word": -1.80,
    "verb after a place only": -0.94,
    "verb agrees": 0.36,
    "verb disagrees": -2.25,
    "verb missing": -0.21,
    "verb of saying": 1.91,
    "verb without a subject": -2.44,
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
