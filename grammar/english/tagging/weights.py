"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.19       2.15       0.74      -2.34      -1.17      -2.65       1.44       1.27      -0.38
be                    -1.96      -1.70       0.60      -1.69       1.92       2.97          -       0.25          -
by                    -0.90          -      -1.67      -0.62          -       2.35          -       0.08      -0.08
determiner             2.78       2.95      -1.40      -2.45       0.19      -2.06      -1.24      -0.63       0.20
ing                   -0.69       1.63       0.16      -1.18          -       0.90      -0.07      -0.08      -0.31
joint                  0.05      -0.94      -0.47      -0.22       2.88       0.60       0.35      -0.20       0.18
modal                 -1.21      -1.00      -0.33       1.26      -0.46      -0.67      -0.79       1.51       0.46
noun                   0.39      -0.75       1.37      -0.47       1.06       0.99       1.26      -1.77      -0.25
of                     1.73       1.09      -0.31      -1.73          -          -          -      -1.29      -0.19
participle             2.03      -0.31       0.26      -1.06      -0.43       1.57          -      -0.08       1.67
place                  0.36          -          -      -0.36          -          -          -          -          -
preposition           -0.11       0.90      -2.06      -1.70          -          -       1.06      -0.21      -0.78
pronoun               -2.48      -1.64       2.02       0.32       0.76       0.87       2.27      -0.13       0.89
relative               0.27      -0.12       0.97       0.29      -0.08          -       0.09       1.10       0.09
start                  0.22      -0.36      -2.41       0.21       0.58       0.56       0.89      -0.46       0.22
subordinate            0.54      -1.35      -0.69      -0.18      -0.17       1.60       0.44       1.43      -0.45
to                    -0.97       1.08       2.12       0.37       1.12          -          -      -0.11          -
verb                  -1.06      -1.23       0.23       0.08       0.75      -0.72      -0.38       1.23      -0.17
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.12      -2.03       0.92      -0.47       2.20      -1.14       1.10      -0.75       0.89
adverb                -0.54      -1.02       0.11      -0.58       0.20       2.14       1.58      -0.48       0.67
be                     0.48       1.13      -2.35      -0.50      -0.93      -2.70       2.24      -1.64       1.61
colon                  1.72       1.18      -1.68      -1.77      -1.00       1.24      -0.55      -0.68       1.16
determiner            -0.76      -0.49       1.37       0.79       1.53          -       0.66      -0.53      -0.54
digits                 1.39          -      -0.21      -0.70      -0.66          -          -          -          -
end                    0.64       1.50       0.24      -1.02      -0.85       1.13      -0.49      -1.56       1.17
joint                  0.49       1.75      -0.15      -0.88      -0.47       0.84      -0.90      -1.51       1.05
of                     2.32       1.18      -1.99      -1.50      -1.38      -0.54      -0.80       0.42      -0.68
participle             0.08          -      -0.10       0.26      -0.16      -0.40      -0.05       0.78      -0.78
place                 -0.73       0.72       1.10      -0.31       0.72       1.42      -0.67      -1.89       0.80
pronoun               -0.39       1.15       2.81      -0.97      -0.39      -0.18       1.09       0.08      -0.62
relative              -0.12       0.21      -0.47       0.27       0.83      -0.42          -          -          -
there                 -0.85       0.33       0.56       0.46          -       0.90          -       1.35       1.56
to                    -0.42       0.23       1.39      -1.15       0.12       0.66          -      -0.68          -
verb or noun           0.78      -1.36      -2.05       0.50       1.53      -1.29       1.34      -0.89      -1.12
word                   0.26      -1.93      -0.40      -0.41       1.99          -      -0.33       0.50      -0.65
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.35,
    "-ing before a name": 2.07,
    "-ing before an unknown noun": 0.21,
    "-ing of a known noun": 0.96,
    "-ing of a verb": 1.06,
    "acronym": 0.96,
    "capital within a sentence": 1.35,
    "command before adjective": 0.96,
    "command before adverb": -0.15,
    "command before be": -1.11,
    "command before colon": -1.62,
    "command before determiner": 1.31,
    "command before digits": -0.28,
    "command before end": -0.16,
    "command before joint": -3.15,
    "command before of": -1.79,
    "command before participle": -0.27,
    "command before place": -0.26,
    "command before pronoun": 1.27,
    "command before relative": 0.72,
    "command before there": 1.05,
    "command before to": 0.13,
    "command before verb or noun": 0.74,
    "command before word": 0.07,
    "command like a thing": 0.55,
    "command like a thing without an object": -0.57,
    "command with an object and a place": 2.39,
    "command, comma within a command": -1.45,
    "command, comma within a command, after a subject": -1.53,
    "command, comma within a open": 1.70,
    "command, comma within a open, after a subject": -1.22,
    "command, comma within a statement": -0.51,
    "command, comma within a statement, after a subject": -0.40,
    "command, conjunction within a command": 1.36,
    "command, conjunction within a command, after a subject": 0.42,
    "command, conjunction within a open": 1.15,
    "command, conjunction within a open, after a subject": -1.37,
    "command, conjunction within a statement": -0.49,
    "command, conjunction within a statement, after a subject": 0.32,
    "command, start": 0.21,
    "command, subordinate": -0.36,
    "command, subordinate, after a subject": 0.26,
    "find": 0.85,
    "finite verb after a joint, within a command": -0.22,
    "finite verb after a joint, within a open": -0.42,
    "finite verb after a joint, within a statement": -0.96,
    "finite verb after a modal verb": -0.73,
    "form in -s": 0.63,
    "form in -s of a known noun": 0.35,
    "hardly a noun": 3.04,
    "infinitive": 0.83,
    "infinitive missing": -1.00,
    "known compound begins": 3.13,
    "known compound ends": 2.96,
    "known noun in -ing": -2.97,
    "left over": 0.86,
    "modal can": 0.11,
    "modal may": 2.12,
    "modal might": 1.56,
    "modal need": 1.42,
    "modal will": 1.67,
    "never a plural": 4.13,
    "noun after a plural": -3.08,
    "number after a word": 1.84,
    "object after a transitive verb": 0.96,
    "other command": -0.24,
    "participle like its base": -1.34,
    "participle of a verb": 2.97,
    "past like a noun": 0.73,
    "past of a known noun": 0.63,
    "past of a verb": 1.55,
    "place after a verb of place": 0.54,
    "place after another verb": -1.65,
    "plain form": 1.39,
    "plain form of a known noun": 0.14,
    "plural after a determiner of one": -1.88,
    "plural after a number": 1.26,
    "put": 1.56,
    "rather a noun": -1.82,
    "rather a plural": -1.65,
    "second verb of a clause": -2.67,
    "singular after a number": -1.37,
    "that": 0.09,
    "unknown in -ed": 2.37,
    "unknown in -s": -2.35,
    "unknown plain form": -3.43,
    "unknown verb before adjective": -1.36,
    "unknown verb before adverb": -1.50,
    "unknown verb before be": -1.10,
    "unknown verb before colon": -0.87,
    "unknown verb before determiner": -1.48,
    "unknown verb before digits": -1.25,
    "unknown verb before end": -0.72,
    "unknown verb before joint": -1.07,
    "unknown verb before of": -0.40,
    "unknown verb before participle": -1.05,
    "unknown verb before place": -0.54,
    "unknown verb before pronoun": -0.53,
    "unknown verb before relative": -1.05,
    "unknown verb before there": -0.34,
    "unknown verb before to": -1.18,
    "unknown verb before verb or noun": -0.40,
    "unknown verb before word": -1.46,
    "verb after a place only": -0.90,
    "verb agrees": 0.44,
    "verb disagrees": -2.35,
    "verb missing": -0.25,
    "verb of saying": 1.76,
    "verb without a subject": -2.62,
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
