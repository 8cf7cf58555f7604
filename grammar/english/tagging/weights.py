"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.14       2.12       0.78      -2.89      -1.41      -2.45       1.48       0.88      -0.66
be                    -1.97      -1.66       0.69      -1.76       1.92       3.29          -       0.40          -
by                    -1.64          -      -0.84      -0.99          -       2.29          -       0.07      -0.07
determiner             2.63       2.81      -1.66      -2.42          -      -2.12      -1.14      -0.60       0.13
ing                   -0.68       1.26       0.07      -1.25      -0.13       0.82      -0.37      -0.09      -0.35
joint                 -0.05      -0.88      -0.88      -0.20       2.81       0.68       0.51       0.14       0.24
modal                 -1.30      -0.96      -0.48       1.61      -0.31      -0.73      -0.75       1.44       0.44
noun                   0.18      -0.95       1.19      -0.64       1.07       0.87       1.26      -1.49      -0.29
of                     1.17       1.30      -0.27      -1.32          -          -          -      -1.19       0.15
participle             2.21      -0.49       0.20      -1.14      -0.38       1.60          -      -0.22       1.49
place                  0.35          -          -      -0.35          -          -          -          -          -
preposition           -0.50       0.62      -1.29      -2.10       0.05      -0.27       0.99      -0.50      -1.50
pronoun               -2.67      -1.63       2.67       0.21       0.43       1.13       2.00      -0.27       0.30
relative              -0.48      -0.29       1.08          -       0.14          -       0.18       1.15       0.11
start                  0.20      -0.15      -2.53       0.31       0.78       0.78       0.81      -0.41      -0.22
subordinate            0.51      -0.83      -0.93      -0.37       0.44       1.81       0.53       1.24       0.39
to                    -1.09       0.95       2.26       0.67       1.07          -          -      -0.09          -
verb                  -1.18      -1.25       0.19       0.11       0.65      -0.30      -0.35       1.14      -0.14
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.13      -2.37       0.79      -0.42       2.13      -0.78       0.85      -0.40       0.58
adverb                -0.74      -0.79       0.40      -0.56       0.33       2.15       1.49      -0.65       0.67
be                     0.60       1.18      -2.62      -0.57      -0.87      -2.01       2.25      -1.29       1.29
colon                  1.80       1.04      -1.83      -1.77      -0.91       1.31      -0.46      -0.49       0.85
determiner            -0.96      -0.53       1.57       0.76       1.47          -       0.51      -0.68      -0.35
digits                 1.61          -       0.19      -1.42      -0.46          -          -          -          -
end                    0.89       1.59          -      -1.31      -0.64       1.38      -0.77      -1.45       1.41
joint                  0.81       1.86      -0.14      -1.05      -0.18       1.02      -1.11      -0.89       0.99
of                     1.45       0.94      -0.84      -1.78      -1.44      -0.83      -0.87       0.13      -0.46
participle             0.12          -      -0.31          -      -0.09      -0.35          -       0.45      -0.45
place                 -0.75       0.70       1.15      -0.57       0.88       1.30      -0.71      -1.88       0.47
pronoun               -0.38       1.08       2.50      -1.08      -0.60      -0.35       1.30          -      -0.14
relative               0.20       0.35      -0.74       0.08       0.84      -0.32          -          -          -
there                 -0.78       0.10       0.32       0.24          -       0.97          -       0.98       1.13
to                    -0.23       0.65       1.07      -1.33       0.40       0.72          -          -          -
verb or noun           0.88      -1.12      -1.73       0.13       1.42      -1.42       1.12      -0.33      -0.73
word                   0.62      -1.53      -0.19      -0.24       2.09          -          -       0.10      -1.19
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.23,
    "-ing before a name": 2.26,
    "-ing before an unknown noun": 0.07,
    "-ing of a known noun": 0.93,
    "-ing of a verb": 1.06,
    "acronym": 0.93,
    "capital within a sentence": 1.15,
    "command before adjective": 0.89,
    "command before adverb": -0.19,
    "command before be": -1.36,
    "command before colon": -2.25,
    "command before determiner": 1.21,
    "command before digits": -1.08,
    "command before end": 0.12,
    "command before joint": -2.87,
    "command before of": -2.17,
    "command before participle": -0.28,
    "command before place": -0.26,
    "command before pronoun": 1.39,
    "command before relative": 0.63,
    "command before there": 1.08,
    "command before to": 0.11,
    "command before verb or noun": 0.48,
    "command before word": -0.09,
    "command like a thing": 0.71,
    "command like a thing without an object": -0.57,
    "command with an object and a place": 2.03,
    "command, comma within a command": -1.30,
    "command, comma within a command, after a subject": -1.86,
    "command, comma within a open": 1.79,
    "command, comma within a open, after a subject": -1.35,
    "command, comma within a statement": -0.66,
    "command, comma within a statement, after a subject": -0.64,
    "command, conjunction within a command": 0.73,
    "command, conjunction within a command, after a subject": 0.33,
    "command, conjunction within a open": 0.91,
    "command, conjunction within a open, after a subject": -1.05,
    "command, conjunction within a statement": -0.45,
    "command, conjunction within a statement, after a subject": 0.35,
    "command, start": 0.31,
    "command, subordinate": -0.37,
    "find": 1.23,
    "finite verb after a joint, within a command": 0.68,
    "finite verb after a joint, within a open": -0.08,
    "finite verb after a joint, within a statement": -0.82,
    "finite verb after a modal verb": -0.57,
    "form in -s": 0.87,
    "form in -s of a known noun": 0.55,
    "hardly a noun": 2.90,
    "infinitive": 0.94,
    "infinitive missing": -0.81,
    "known compound begins": 3.49,
    "known compound ends": 3.10,
    "known noun in -ing": -2.96,
    "left over": 0.74,
    "modal can": -0.08,
    "modal may": 2.28,
    "modal might": 1.10,
    "modal need": 1.39,
    "modal will": 1.59,
    "never a plural": 3.74,
    "noun after a plural": -3.12,
    "object after a transitive verb": 0.69,
    "other command": 0.09,
    "participle like its base": -1.61,
    "participle of a verb": 2.71,
    "past like a noun": 0.78,
    "past of a known noun": 0.60,
    "past of a verb": 1.84,
    "place after a verb of place": 0.60,
    "place after another verb": -1.82,
    "plain form": 1.57,
    "plain form of a known noun": 0.10,
    "plural after a determiner of one": -2.18,
    "plural after a number": 2.33,
    "put": 1.55,
    "rather a noun": -1.39,
    "rather a plural": -1.85,
    "second verb of a clause": -2.62,
    "singular after a number": -1.77,
    "that": 0.49,
    "unknown in -ed": 2.41,
    "unknown in -s": -2.83,
    "unknown plain form": -3.32,
    "unknown verb before adjective": -1.11,
    "unknown verb before adverb": -1.49,
    "unknown verb before be": -1.17,
    "unknown verb before colon": -0.66,
    "unknown verb before determiner": -1.34,
    "unknown verb before digits": -0.75,
    "unknown verb before end": -0.81,
    "unknown verb before joint": -0.61,
    "unknown verb before of": -0.91,
    "unknown verb before participle": -0.83,
    "unknown verb before place": -0.61,
    "unknown verb before pronoun": -0.50,
    "unknown verb before relative": -0.73,
    "unknown verb before there": -0.41,
    "unknown verb before to": 0.15,
    "unknown verb before verb or noun": -0.87,
    "unknown verb before word": -1.54,
    "verb after a place only": -0.93,
    "verb agrees": 0.54,
    "verb disagrees": -2.13,
    "verb missing": -0.12,
    "verb of saying": 1.88,
    "verb without a subject": -2.28,
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
