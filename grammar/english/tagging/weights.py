"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -       1.91       1.11      -2.52      -1.16      -2.60       1.40       1.00      -0.61
be                    -2.18      -1.91       0.66      -2.03       1.94       2.87          -       0.29          -
by                    -1.57          -      -0.79      -0.92          -       2.59          -       0.06      -0.06
determiner             2.53       2.57      -1.59      -2.65       0.07      -2.62      -1.08      -0.59       0.12
ing                   -0.85       1.45      -0.10      -1.28       0.12       0.85      -0.14          -      -0.21
joint                 -0.21      -0.84      -0.97      -0.14       2.89       0.49       0.44       0.11       0.47
modal                 -1.42      -1.00      -0.55       1.64      -0.20      -0.73      -0.75       1.24       0.29
noun                   0.14      -1.06       1.17      -0.64       1.24       0.77       1.27      -1.42      -0.27
of                     1.35       1.09      -0.25      -1.53          -          -          -      -1.20          -
participle             2.11      -0.48       0.37      -1.16      -0.34       1.61          -      -0.26       1.45
place                  0.34          -          -      -0.34          -          -          -          -          -
preposition           -0.60       0.87      -1.21      -2.11          -      -0.46       1.07      -0.52      -1.54
pronoun               -2.58      -1.89       2.58       0.33       0.64       0.91       2.00      -0.30       0.38
relative              -0.34      -0.28       1.22      -0.07          -          -       0.34       1.09      -0.09
start                  0.24      -0.51      -1.95       0.39       0.82       0.76       0.94      -0.48      -0.22
subordinate            0.52      -1.04      -0.41      -0.31       0.36       1.71       0.39       1.36       0.48
to                    -1.23       0.83       2.13       0.75       1.04          -          -      -0.08      -0.07
verb                  -1.26      -1.48       0.13       0.57       0.63      -0.42      -0.31       1.21          -
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.21      -2.51       0.76      -0.27       2.06      -0.69       0.86      -0.51       0.66
adverb                -0.79      -1.03       0.13      -0.51       0.43       2.19       1.28      -0.63       0.59
be                     0.70       1.22      -2.24      -0.46      -0.90      -2.01       2.23      -1.23       1.14
colon                  1.71       1.06      -2.11      -2.03      -0.96       1.32      -0.44      -0.05       0.69
determiner            -0.98      -0.37       1.35       0.86       1.48      -0.16       0.51      -0.53      -0.29
digits                 1.65          -       0.09      -1.32      -0.47          -          -          -          -
end                    0.78       1.81      -0.19      -1.35      -0.63       1.20      -0.63      -1.35       1.28
joint                  0.70       2.01      -0.35      -1.16      -0.30       0.80      -1.21      -1.06       1.13
of                     1.58       1.05      -0.86      -1.91      -1.60      -0.78      -0.84       0.11      -0.39
participle                -          -      -0.21          -      -0.15      -0.37          -       0.62      -0.62
place                 -0.66       1.01       1.09      -0.44       0.82       1.32      -0.69      -1.94       0.38
pronoun               -0.16       1.19       2.54      -0.98      -0.68      -0.25       1.43      -0.05      -0.17
relative                  -       0.28      -0.67      -0.05       0.85      -0.31          -          -          -
there                 -0.70       0.10       0.33       0.27          -       0.94          -       1.04       1.14
to                    -0.12       0.40       1.07      -1.06       0.22       0.85          -          -          -
verb or noun           0.78      -1.19      -1.90       0.45       1.47      -1.53       1.07      -0.33      -0.82
word                   0.37      -1.54      -0.42      -0.32       2.04      -0.17      -0.06       0.16      -1.05
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.29,
    "-ing before a name": 2.14,
    "-ing of a known noun": 1.12,
    "-ing of a verb": 1.18,
    "acronym": 0.82,
    "capital within a sentence": 1.39,
    "command before adjective": 0.79,
    "command before adverb": -0.25,
    "command before be": -1.32,
    "command before colon": -2.25,
    "command before determiner": 1.17,
    "command before digits": -1.01,
    "command before end": 0.18,
    "command before joint": -2.71,
    "command before of": -1.55,
    "command before participle": -0.38,
    "command before place": -0.33,
    "command before pronoun": 1.51,
    "command before relative": 0.66,
    "command before there": 1.07,
    "command before to": -0.07,
    "command before verb or noun": 0.92,
    "command before word": -0.22,
    "command like a thing": 0.56,
    "command like a thing without an object": -0.61,
    "command with an object and a place": 2.06,
    "command, comma within a command": -1.41,
    "command, comma within a command, after a subject": -1.71,
    "command, comma within a open": 1.70,
    "command, comma within a open, after a subject": -1.39,
    "command, comma within a statement": -0.72,
    "command, comma within a statement, after a subject": -0.65,
    "command, conjunction within a command": 0.68,
    "command, conjunction within a command, after a subject": 0.41,
    "command, conjunction within a open": 0.88,
    "command, conjunction within a open, after a subject": -0.81,
    "command, conjunction within a statement": -0.57,
    "command, conjunction within a statement, after a subject": 0.46,
    "command, start": 0.39,
    "command, subordinate": -0.31,
    "find": 1.08,
    "finite verb after a joint, within a command": 0.78,
    "finite verb after a joint, within a open": -0.26,
    "finite verb after a joint, within a statement": -0.78,
    "finite verb after a modal verb": -0.60,
    "form in -s": 0.90,
    "form in -s of a known noun": 0.54,
    "hardly a noun": 2.89,
    "infinitive": 0.88,
    "infinitive missing": -0.89,
    "known compound begins": 3.88,
    "known compound ends": 3.04,
    "known noun in -ing": -2.94,
    "left over": 0.70,
    "modal can": -0.06,
    "modal may": 2.11,
    "modal might": 1.67,
    "modal need": 1.32,
    "modal will": 1.65,
    "never a plural": 3.55,
    "noun after a plural": -3.17,
    "object after a transitive verb": 0.68,
    "participle like its base": -1.63,
    "participle of a verb": 2.84,
    "past like a noun": 0.79,
    "past of a known noun": 0.53,
    "past of a verb": 1.67,
    "place after a verb of place": 0.64,
    "place after another verb": -1.82,
    "plain form": 1.54,
    "plain form of a known noun": 0.09,
    "plural after a determiner of one": -2.23,
    "plural after a number": 2.10,
    "put": 1.38,
    "rather a noun": -1.28,
    "rather a plural": -1.80,
    "second verb of a clause": -2.56,
    "singular after a number": -1.47,
    "that": 0.62,
    "unknown in -ed": 2.14,
    "unknown in -ing": 0.12,
    "unknown in -s": -2.84,
    "unknown plain form": -3.57,
    "unknown verb before adjective": -1.29,
    "unknown verb before adverb": -1.30,
    "unknown verb before be": -1.24,
    "unknown verb before colon": -0.65,
    "unknown verb before determiner": -1.15,
    "unknown verb before digits": -0.89,
    "unknown verb before end": -0.75,
    "unknown verb before joint": -0.51,
    "unknown verb before of": -1.00,
    "unknown verb before participle": -0.87,
    "unknown verb before place": -0.48,
    "unknown verb before pronoun": -0.27,
    "unknown verb before relative": -0.94,
    "unknown verb before there": -0.39,
    "unknown verb before to": 0.31,
    "unknown verb before verb or noun": -0.90,
    "unknown verb before word": -1.76,
    "verb after a place only": -0.88,
    "verb agrees": 0.56,
    "verb disagrees": -2.11,
    "verb missing": -0.15,
    "verb of saying": 1.72,
    "verb without a subject": -2.56,
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
