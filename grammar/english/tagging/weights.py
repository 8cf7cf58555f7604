"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -       2.02       1.13      -2.69      -1.36      -2.20       1.80       1.05      -0.48
be                    -1.76      -1.97       0.69      -1.33       1.86       3.40          -       0.30          -
by                    -1.68          -      -0.49      -1.40          -       2.47          -       0.07      -0.07
determiner             2.67       2.91      -1.55      -2.45       0.07      -2.37      -0.92      -0.64       0.28
ing                   -0.83       1.54          -      -1.31       0.05       0.89      -0.19      -0.15      -0.43
joint                     -      -0.81      -0.60      -0.27       3.07       0.86       0.71      -0.08       0.53
modal                 -1.44      -1.29      -0.17       1.45      -0.44      -0.71      -0.79       1.39       0.31
noun                   0.13      -0.94       1.27      -0.57       1.04       0.91       1.28      -1.36      -0.09
of                     1.43       1.12      -0.25      -1.41          -          -          -      -1.20      -0.40
participle             1.95       0.22       0.24      -1.11      -0.21       1.48          -      -0.32       1.55
place                  0.46          -          -      -0.46          -          -          -          -          -
preposition           -0.52          -      -1.08      -1.99       1.39      -0.25       0.93      -0.56      -1.37
pronoun               -2.98      -1.92       2.40          -       0.35       0.79       1.95      -0.50       0.44
relative              -0.53      -0.13       1.22      -0.08      -0.13          -       0.24       0.94          -
start                     -      -0.62      -2.70       0.13       0.80       0.71       0.93      -0.58      -0.19
subordinate            0.38      -1.14       0.08      -0.46      -0.28       1.72       0.45       1.33       0.78
to                    -1.04       0.06       1.88       0.72       0.67          -          -      -0.11      -0.05
verb                  -1.34      -1.26          -       0.67       0.55      -0.32      -0.29       1.17      -0.06
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -      -2.21       0.95      -0.53       2.17      -0.75       1.48      -0.53       0.68
adverb                -0.60      -0.88       0.48      -0.13       0.14       2.08       1.83      -0.61       0.60
be                     0.69       1.00      -2.38      -0.38      -0.89      -2.12       2.47      -1.28       1.11
colon                  1.87       0.87      -2.22      -1.89      -1.02       1.35      -0.50      -0.16       0.67
determiner            -0.90      -0.60       1.65       0.89       1.55      -0.11       0.76      -0.93      -0.17
digits                 1.65          -       0.26      -1.31      -0.44          -          -          -          -
end                    0.87       1.50          -      -1.22      -0.68       1.08      -0.71      -1.34       1.30
joint                  0.67       1.81      -0.20      -1.12      -0.28       0.59      -1.19      -1.14       1.21
of                     1.68       1.11      -0.87      -1.48      -1.53      -0.74      -0.88       0.20      -0.40
participle                -          -      -0.34       0.20      -0.14      -0.51          -       0.80      -0.79
place                 -0.69       0.93       1.22      -0.37       0.99       1.05      -0.62      -1.84       0.31
pronoun               -0.53       1.26       2.73      -0.97      -0.27      -0.51       1.45      -0.05          -
relative                  -       0.30      -0.61          -       0.81      -0.37          -          -          -
there                 -0.67       0.12       0.26       0.34          -       0.97          -       1.04       1.17
to                    -0.20       0.19       1.09      -1.08       0.74       0.67          -          -          -
verb or noun           0.91      -1.39      -1.60       0.33       1.60      -1.56       1.20      -0.36      -0.61
word                   0.38      -1.88      -0.26      -0.33       2.09      -0.17      -0.17          -      -1.04
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.52,
    "-ing before a name": 2.06,
    "-ing before an unknown noun": -0.14,
    "-ing of a known noun": 1.08,
    "-ing of a verb": 1.24,
    "acronym": 0.84,
    "capital within a sentence": 1.12,
    "command before adjective": 1.10,
    "command before adverb": -0.43,
    "command before be": -1.60,
    "command before colon": -1.67,
    "command before determiner": 1.52,
    "command before digits": -0.91,
    "command before end": 0.17,
    "command before joint": -3.20,
    "command before of": -2.14,
    "command before participle": -0.48,
    "command before place": -0.37,
    "command before pronoun": 1.28,
    "command before relative": 0.89,
    "command before there": 1.05,
    "command before to": 0.06,
    "command before verb or noun": 1.28,
    "command before word": -0.29,
    "command like a thing": 0.50,
    "command like a thing without an object": -0.50,
    "command with an object and a place": 2.39,
    "command, comma within a command": -1.22,
    "command, comma within a command, after a subject": -1.37,
    "command, comma within a open": 1.97,
    "command, comma within a open, after a subject": -1.20,
    "command, comma within a statement": -0.54,
    "command, comma within a statement, after a subject": -0.48,
    "command, conjunction within a command": 1.08,
    "command, conjunction within a command, after a subject": 0.54,
    "command, conjunction within a open": 1.47,
    "command, conjunction within a open, after a subject": -0.97,
    "command, conjunction within a statement": -0.32,
    "command, conjunction within a statement, after a subject": 0.66,
    "command, start": 0.13,
    "command, subordinate": -0.46,
    "find": 1.16,
    "finite verb after a joint, within a command": 0.87,
    "finite verb after a joint, within a open": -0.31,
    "finite verb after a joint, within a statement": -0.80,
    "finite verb after a modal verb": -0.74,
    "form in -s": 0.80,
    "form in -s of a known noun": 0.45,
    "hardly a noun": 2.68,
    "infinitive": 0.95,
    "infinitive missing": -0.84,
    "known compound begins": 3.78,
    "known compound ends": 3.13,
    "known noun in -ing": -2.85,
    "left over": 0.82,
    "modal can": -0.31,
    "modal may": 2.20,
    "modal might": 1.39,
    "modal need": 1.38,
    "modal will": 1.33,
    "never a plural": 3.52,
    "noun after a plural": -2.97,
    "object after a transitive verb": 0.92,
    "other command": 0.07,
    "participle like its base": -1.43,
    "participle of a verb": 2.52,
    "past like a noun": 0.87,
    "past of a known noun": 0.65,
    "past of a verb": 1.83,
    "place after a verb of place": 0.54,
    "place after another verb": -1.61,
    "plain form": 1.45,
    "plain form of a known noun": 0.08,
    "plural after a determiner of one": -2.33,
    "plural after a number": 2.20,
    "put": 1.43,
    "rather a noun": -1.23,
    "rather a plural": -1.92,
    "second verb of a clause": -2.43,
    "singular after a number": -1.63,
    "that": 0.77,
    "unknown in -ed": 2.35,
    "unknown in -ing": 0.14,
    "unknown in -s": -3.07,
    "unknown plain form": -3.51,
    "unknown verb before adjective": -0.79,
    "unknown verb before adverb": -1.46,
    "unknown verb before be": -0.82,
    "unknown verb before colon": -0.69,
    "unknown verb before determiner": -1.19,
    "unknown verb before digits": -0.71,
    "unknown verb before end": -0.79,
    "unknown verb before joint": -0.61,
    "unknown verb before of": -1.05,
    "unknown verb before participle": -0.55,
    "unknown verb before place": -0.55,
    "unknown verb before pronoun": -0.55,
    "unknown verb before relative": -0.92,
    "unknown verb before there": -0.43,
    "unknown verb before to": 0.40,
    "unknown verb before verb or noun": -0.86,
    "unknown verb before word": -1.51,
    "verb after a place only": -1.03,
    "verb agrees": 0.44,
    "verb disagrees": -2.22,
    "verb missing": -0.29,
    "verb of saying": 1.53,
    "verb without a subject": -2.71,
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
