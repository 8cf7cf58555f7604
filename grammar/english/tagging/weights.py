"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.13       2.12       0.77      -2.91      -1.42      -2.45       1.47       0.92      -0.62
be                    -1.96      -1.64       0.70      -1.80       1.94       3.29          -       0.40          -
by                    -1.64          -      -0.85      -0.98          -       2.28          -       0.07      -0.07
determiner             2.63       2.82      -1.65      -2.42          -      -2.11      -1.14      -0.57       0.15
ing                   -0.67       1.26       0.06      -1.25      -0.13       0.83      -0.37      -0.11      -0.36
joint                     -      -0.88      -0.93      -0.22       2.86       0.69       0.52       0.15       0.21
modal                 -1.30      -0.96      -0.50       1.62      -0.34      -0.74      -0.74       1.44       0.44
noun                   0.19      -0.92       1.19      -0.68       1.11       0.88       1.27      -1.52      -0.32
of                     1.18       1.34      -0.28      -1.33          -          -          -      -1.22       0.20
participle             2.20      -0.51       0.27      -1.18      -0.51       1.60          -      -0.12       1.54
place                  0.35          -          -      -0.35          -          -          -          -          -
preposition           -0.47       0.63      -1.21      -2.10          -      -0.26       1.00      -0.38      -1.02
pronoun               -2.74      -1.64       2.67       0.31       0.44       1.14       1.99      -0.27       0.31
relative              -0.52      -0.29       1.08       0.06       0.13          -       0.17       1.07          -
start                  0.20      -0.15      -2.47       0.31       0.73       0.77       0.81      -0.42      -0.23
subordinate            0.53      -1.05      -1.25      -0.36       0.31       1.83       0.53       1.38      -0.41
to                    -1.12       0.95       2.29       0.66       1.07          -          -      -0.09          -
verb                  -1.18      -1.25          -       0.10       0.72      -0.31      -0.35       1.09      -0.14
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.12      -2.37       0.80      -0.42       2.12      -0.78       0.85      -0.40       0.57
adverb                -0.72      -0.83       0.45      -0.60       0.24       2.17       1.51      -0.63       0.64
be                     0.61       1.18      -2.60      -0.57      -0.87      -2.01       2.26      -1.33       1.26
colon                  1.79       1.04      -1.83      -1.78      -0.90       1.32      -0.46      -0.38       0.75
determiner            -1.00      -0.46       1.40       0.77       1.56      -0.07       0.50      -0.58      -0.36
digits                 1.63          -       0.21      -1.41      -0.49          -          -          -          -
end                    0.89       1.60          -      -1.33      -0.63       1.38      -0.77      -1.43       1.40
joint                  0.80       1.85      -0.20      -0.96      -0.20       1.01      -1.11      -0.93       1.03
of                     1.46       0.94      -0.83      -1.79      -1.46      -0.85      -0.87       0.15      -0.50
participle             0.17          -      -0.30      -0.05      -0.09      -0.35          -       0.45      -0.45
place                 -0.74       0.70       1.14      -0.55       0.83       1.31      -0.72      -1.84       0.66
pronoun               -0.38       1.11       2.53      -1.11      -0.52      -0.36       1.29       0.11      -0.19
relative               0.18       0.36      -0.72       0.07       0.82      -0.32          -          -          -
there                 -0.83       0.11       0.32       0.19          -       0.98          -       0.99       1.14
to                    -0.22       0.64       1.04      -1.31       0.38       0.73          -          -          -
verb or noun           0.85      -1.12      -1.63       0.13       1.44      -1.43       1.10      -0.29      -0.81
word                   0.62      -1.54      -0.20      -0.24       2.10          -          -       0.10      -1.19
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.23,
    "-ing before a name": 2.26,
    "-ing before an unknown noun": 0.08,
    "-ing of a known noun": 0.93,
    "-ing of a verb": 1.06,
    "acronym": 0.93,
    "capital within a sentence": 1.16,
    "command before adjective": 0.91,
    "command before adverb": -0.30,
    "command before be": -1.37,
    "command before colon": -2.25,
    "command before determiner": 1.21,
    "command before digits": -1.06,
    "command before end": 0.15,
    "command before joint": -2.95,
    "command before of": -2.17,
    "command before participle": -0.28,
    "command before place": -0.25,
    "command before pronoun": 1.37,
    "command before relative": 0.62,
    "command before there": 1.09,
    "command before to": 0.11,
    "command before verb or noun": 0.49,
    "command before word": -0.07,
    "command like a thing": 0.72,
    "command like a thing without an object": -0.57,
    "command with an object and a place": 2.04,
    "command, comma within a command": -1.29,
    "command, comma within a command, after a subject": -1.85,
    "command, comma within a open": 1.74,
    "command, comma within a open, after a subject": -1.36,
    "command, comma within a statement": -0.64,
    "command, comma within a statement, after a subject": -0.61,
    "command, conjunction within a command": 0.73,
    "command, conjunction within a command, after a subject": 0.34,
    "command, conjunction within a open": 0.92,
    "command, conjunction within a open, after a subject": -1.09,
    "command, conjunction within a statement": -0.44,
    "command, conjunction within a statement, after a subject": 0.33,
    "command, start": 0.31,
    "command, subordinate": -0.37,
    "find": 1.25,
    "finite verb after a joint, within a command": 0.75,
    "finite verb after a joint, within a open": -0.21,
    "finite verb after a joint, within a statement": -0.83,
    "finite verb after a modal verb": -0.61,
    "form in -s": 0.88,
    "form in -s of a known noun": 0.58,
    "hardly a noun": 2.88,
    "infinitive": 0.92,
    "infinitive missing": -0.83,
    "known compound begins": 3.49,
    "known compound ends": 3.10,
    "known noun in -ing": -2.97,
    "left over": 0.74,
    "modal can": -0.07,
    "modal may": 2.27,
    "modal might": 1.10,
    "modal need": 1.40,
    "modal will": 1.60,
    "never a plural": 3.63,
    "noun after a plural": -3.16,
    "object after a transitive verb": 0.76,
    "other command": 0.10,
    "participle like its base": -1.59,
    "participle of a verb": 2.77,
    "past like a noun": 0.78,
    "past of a known noun": 0.54,
    "past of a verb": 1.74,
    "place after a verb of place": 0.57,
    "place after another verb": -1.79,
    "plain form": 1.58,
    "plain form of a known noun": 0.11,
    "plural after a determiner of one": -2.20,
    "plural after a number": 2.34,
    "put": 1.56,
    "rather a noun": -1.40,
    "rather a plural": -1.81,
    "second verb of a clause": -2.60,
    "singular after a number": -1.79,
    "that": 0.45,
    "unknown in -ed": 2.39,
    "unknown in -s": -2.85,
    "unknown plain form": -3.33,
    "unknown verb before adjective": -1.13,
    "unknown verb before adverb": -1.49,
    "unknown verb before be": -1.19,
    "unknown verb before colon": -0.66,
    "unknown verb before determiner": -1.33,
    "unknown verb before digits": -0.74,
    "unknown verb before end": -0.79,
    "unknown verb before joint": -0.79,
    "unknown verb before of": -0.90,
    "unknown verb before participle": -0.81,
    "unknown verb before place": -0.58,
    "unknown verb before pronoun": -0.57,
    "unknown verb before relative": -0.70,
    "unknown verb before there": -0.37,
    "unknown verb before to": 0.15,
    "unknown verb before verb or noun": -0.90,
    "unknown verb before word": -1.56,
    "verb after a place only": -0.95,
    "verb agrees": 0.54,
    "verb disagrees": -2.01,
    "verb missing": -0.11,
    "verb of saying": 1.96,
    "verb without a subject": -2.43,
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
