"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.23       2.00       0.83      -2.36      -1.20      -2.71       1.41       0.78      -0.36
be                    -2.02      -1.77       0.63      -1.51       1.90       3.08          -       0.31          -
by                    -1.57          -      -0.83      -1.05          -       2.49          -       0.18      -0.18
determiner             2.74       2.87      -1.27      -2.30       0.19      -2.49      -1.10      -0.68       0.31
ing                   -0.95       1.47       0.21      -1.37       0.30       0.83      -0.13      -0.12      -0.24
joint                 -0.08      -0.82      -0.70      -0.20       2.89       0.35       0.63      -0.20       0.16
modal                 -1.05      -1.43      -0.37       1.35      -0.30      -0.70      -0.69       1.24       0.26
noun                      -      -0.84       1.03      -0.67       1.04       0.52       1.30      -1.45      -0.10
of                     1.41       1.12      -0.30      -1.45          -          -          -      -1.28      -0.27
participle             2.21      -0.67       0.35      -0.96      -0.41       1.61          -      -0.53       1.68
place                  0.31          -          -      -0.31          -          -          -          -          -
preposition           -0.35       0.85      -0.96      -1.64       0.13      -0.41       0.86      -0.65      -0.77
pronoun               -2.67      -2.07       2.08       0.31       0.75       0.46       1.80      -0.18       1.09
relative              -0.06      -0.19       0.81       0.13          -          -       0.36       0.84       0.27
start                 -0.13       0.58      -3.15       0.28       1.04       0.22       0.84      -0.67      -0.16
subordinate            0.60      -1.45      -0.66      -0.22      -0.29       1.53       0.46       1.40      -0.24
to                    -0.91       1.07       2.15       0.23       0.90          -          -      -0.20      -0.13
verb                  -1.29      -1.06       0.11       0.39       0.78      -0.90      -0.35       1.00      -0.20
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.15      -2.36       0.84      -0.62       2.35      -0.79       1.68      -0.51       0.56
adverb                -0.42      -1.12       0.71      -0.49       0.16       2.08       1.68      -0.62       0.58
be                     0.61       1.17      -2.24      -0.32      -0.86      -1.96       2.34      -1.37       0.84
colon                  1.70       0.97      -2.03      -2.08      -0.88       1.25      -0.42      -0.51       0.86
determiner            -1.01      -0.64       1.40       0.92       1.25      -0.07       0.51      -0.65      -0.37
digits                 1.51          -       0.31      -1.19      -0.48          -          -          -          -
end                    0.69       1.62          -      -0.90      -0.79       1.09      -0.45      -1.14       1.21
joint                  0.72       1.94      -0.08      -0.62      -0.34       0.82      -1.07      -0.81       0.91
of                     2.26       1.23      -2.14      -1.35      -1.26      -0.72      -0.78       0.35      -0.58
participle             0.27          -      -0.43       0.26      -0.25      -0.42          -       0.66      -0.65
place                 -0.65       0.85       1.25      -0.32       0.64       1.30      -0.77      -1.89       0.76
pronoun               -0.44       1.44       3.07      -0.73      -0.33      -0.32       1.09       0.07      -0.76
relative               0.10       0.25      -0.21       0.41       0.74      -0.42          -          -          -
there                 -0.86       0.26       0.51       0.49          -       0.93          -       1.34       1.53
to                    -0.15       0.57       1.27      -1.13       0.06       0.69          -          -          -
verb or noun           0.88      -1.04      -2.04       0.22       1.45      -1.78       1.03      -0.80      -1.15
word                   0.34      -1.43      -0.34      -0.34       1.99      -0.19      -0.38       0.19      -0.65
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.41,
    "-ing before a name": 2.14,
    "-ing before an unknown noun": 0.06,
    "-ing of a known noun": 1.25,
    "-ing of a verb": 1.35,
    "acronym": 0.87,
    "capital within a sentence": 1.37,
    "command before adjective": 1.03,
    "command before adverb": -0.30,
    "command before be": -1.53,
    "command before colon": -1.54,
    "command before determiner": 1.28,
    "command before digits": -1.01,
    "command before end": 0.06,
    "command before joint": -3.18,
    "command before of": -1.80,
    "command before participle": -0.38,
    "command before place": -0.38,
    "command before pronoun": 1.32,
    "command before relative": 0.55,
    "command before there": 1.04,
    "command before to": 0.19,
    "command before verb or noun": 0.47,
    "command before word": -0.19,
    "command like a thing": 0.50,
    "command like a thing without an object": -0.44,
    "command with an object and a place": 2.28,
    "command, comma within a command": -1.71,
    "command, comma within a command, after a subject": -1.54,
    "command, comma within a open": 1.93,
    "command, comma within a open, after a subject": -1.06,
    "command, comma within a statement": -0.35,
    "command, comma within a statement, after a subject": -0.16,
    "command, conjunction within a command": 0.94,
    "command, conjunction within a command, after a subject": 0.29,
    "command, conjunction within a open": 1.29,
    "command, conjunction within a open, after a subject": -1.25,
    "command, conjunction within a statement": -0.33,
    "command, conjunction within a statement, after a subject": 0.57,
    "command, start": 0.28,
    "command, subordinate, after a subject": 0.09,
    "find": 1.16,
    "finite verb after a joint, within a command": 0.32,
    "finite verb after a joint, within a open": -0.18,
    "finite verb after a joint, within a statement": -1.10,
    "finite verb after a modal verb": -0.59,
    "form in -s": 0.51,
    "form in -s of a known noun": 0.51,
    "hardly a noun": 2.95,
    "infinitive": 1.08,
    "infinitive missing": -0.89,
    "known compound begins": 3.91,
    "known compound ends": 3.18,
    "known noun in -ing": -2.26,
    "left over": 0.95,
    "modal can": -0.28,
    "modal may": 1.85,
    "modal might": 0.97,
    "modal need": 1.65,
    "modal will": 1.48,
    "never a plural": 3.89,
    "noun after a plural": -3.12,
    "object after a transitive verb": 0.81,
    "other command": -0.07,
    "participle like its base": -1.27,
    "participle of a verb": 3.21,
    "past like a noun": 0.80,
    "past of a known noun": 0.32,
    "past of a verb": 1.22,
    "place after a verb of place": 0.74,
    "place after another verb": -1.55,
    "plain form": 1.03,
    "plural after a determiner of one": -1.92,
    "plural after a number": 2.23,
    "put": 1.66,
    "rather a noun": -1.74,
    "rather a plural": -1.83,
    "second verb of a clause": -2.63,
    "singular after a number": -1.54,
    "that": 0.37,
    "unknown in -ed": 2.12,
    "unknown in -ing": 0.25,
    "unknown in -s": -2.57,
    "unknown plain form": -3.69,
    "unknown verb before adjective": -0.65,
    "unknown verb before adverb": -1.50,
    "unknown verb before be": -1.16,
    "unknown verb before colon": -0.86,
    "unknown verb before determiner": -1.27,
    "unknown verb before digits": -1.05,
    "unknown verb before end": -0.89,
    "unknown verb before joint": -0.89,
    "unknown verb before of": -0.42,
    "unknown verb before participle": -0.74,
    "unknown verb before place": -0.64,
    "unknown verb before pronoun": -0.51,
    "unknown verb before relative": -0.88,
    "unknown verb before there": -0.36,
    "unknown verb before to": -0.86,
    "unknown verb before verb or noun": -0.53,
    "unknown verb before word": -1.43,
    "verb after a place only": -0.83,
    "verb agrees": 0.42,
    "verb disagrees": -2.13,
    "verb missing": -0.13,
    "verb of saying": 1.68,
    "verb without a subject": -2.40,
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
