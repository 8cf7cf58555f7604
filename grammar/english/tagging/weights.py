"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.29       2.25       0.86      -2.56      -1.23      -2.66       1.51       1.07      -0.44
be                    -2.00      -1.61       0.45      -1.83       1.99       3.16          -       0.34          -
by                    -1.72          -      -0.93      -1.69          -       2.09          -       0.05      -0.05
determiner             2.65       2.94      -1.74      -2.32       0.08      -2.43      -0.89      -0.70       0.30
ing                   -0.70       1.14          -      -1.28       0.52       0.89      -0.11          -      -0.34
joint                     -      -0.99      -0.62      -0.39       2.76       0.50       0.44      -0.24      -0.23
modal                 -1.03      -1.21      -0.09       1.13      -0.24      -0.63      -0.87       1.17       0.55
noun                   0.23      -0.77       1.17      -0.82       1.19       0.75       1.22      -1.61      -0.34
of                     1.48       1.15      -0.33      -1.66          -          -          -      -1.30       0.34
participle             2.25      -0.37       0.23      -1.21      -0.28       1.71          -      -0.16       1.81
place                  0.47          -          -      -0.47          -          -          -          -          -
preposition           -0.10       0.66      -0.98      -1.74       0.22      -0.10       1.00      -0.16      -0.70
pronoun               -2.61      -1.93       2.37          -       0.72       0.81       1.99      -0.06       0.70
relative               0.08      -0.14       0.75       0.22      -0.13          -       0.25       1.18       0.17
start                  0.38      -0.12      -2.52       0.23       0.68       0.76       0.85      -0.63       0.17
subordinate            0.60      -1.12      -1.06      -0.33       0.12       1.73       0.41       1.14      -0.29
to                    -0.84       1.15       2.04       0.36       1.13          -          -      -0.14      -0.05
verb                  -1.17      -1.13       0.18      -0.09       0.83      -0.86      -0.33       0.93      -0.24
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -      -2.63       0.99      -0.93       2.26      -0.48       1.51      -0.52       0.60
adverb                -0.51      -1.17       0.24      -0.52       0.18       2.27       1.83      -0.59       0.59
be                     0.46       0.91      -2.68      -0.53      -0.88      -2.20       2.27      -1.64       1.64
colon                  1.60       1.06      -1.71      -1.64      -0.89       1.27      -0.55      -0.59       1.11
determiner            -0.96      -0.49       1.57       0.69       1.54      -0.30       0.49          -      -0.64
digits                 1.52          -       0.17      -1.43      -0.55          -          -          -          -
end                    0.58       1.42      -0.05      -1.21      -0.73       1.09      -0.54      -1.24       1.28
joint                  0.59       1.82      -0.10      -0.94      -0.20       0.79      -0.73      -1.09       1.19
of                     2.21       1.23      -2.24      -1.35      -1.28      -0.82      -0.79       0.41      -0.64
participle             0.21          -          -       0.27      -0.26      -0.46          -       0.69      -0.68
place                 -0.80       0.69       1.37      -0.55       0.79       1.25      -0.71      -1.82       0.83
pronoun               -0.33       1.43       2.86      -0.96      -0.20      -0.29       1.27      -0.10      -0.35
relative              -0.09       0.35      -0.40       0.14       0.89      -0.43          -          -          -
there                 -0.97       0.25       0.39       0.42          -       0.91          -       1.48       1.53
to                    -0.10       0.46       1.52      -1.05       0.15       0.84          -          -          -
verb or noun           0.70      -1.29      -1.93       0.30       1.58      -1.74       1.32      -0.47      -1.11
word                   0.43      -1.56      -0.27      -0.29       2.32          -      -0.24       0.28      -0.85
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.42,
    "-ing before a name": 1.99,
    "-ing before an unknown noun": 0.16,
    "-ing of a known noun": 1.05,
    "-ing of a verb": 1.21,
    "acronym": 1.04,
    "capital within a sentence": 1.10,
    "command before adjective": 1.35,
    "command before adverb": -0.29,
    "command before be": -1.55,
    "command before colon": -1.85,
    "command before determiner": 1.40,
    "command before digits": -1.06,
    "command before end": 0.23,
    "command before joint": -2.92,
    "command before of": -1.37,
    "command before participle": -0.31,
    "command before pronoun": 1.26,
    "command before relative": 0.85,
    "command before there": 1.08,
    "command before to": 0.39,
    "command before verb or noun": 0.56,
    "command like a thing": 0.53,
    "command like a thing without an object": -0.42,
    "command with an object and a place": 2.59,
    "command, comma within a command": -1.72,
    "command, comma within a command, after a subject": -1.74,
    "command, comma within a open": 1.58,
    "command, comma within a open, after a subject": -1.31,
    "command, comma within a statement": -0.75,
    "command, comma within a statement, after a subject": -0.54,
    "command, conjunction within a command": 0.94,
    "command, conjunction within a command, after a subject": 0.08,
    "command, conjunction within a open": 0.79,
    "command, conjunction within a open, after a subject": -1.57,
    "command, conjunction within a statement": -0.57,
    "command, start": 0.23,
    "command, subordinate": -0.39,
    "command, subordinate, after a subject": 0.59,
    "find": 1.14,
    "finite verb after a joint, within a command": 0.53,
    "finite verb after a joint, within a open": -0.23,
    "finite verb after a joint, within a statement": -1.08,
    "finite verb after a modal verb": -1.13,
    "form in -s": 0.53,
    "form in -s of a known noun": 0.42,
    "hardly a noun": 3.06,
    "infinitive": 0.79,
    "infinitive missing": -1.05,
    "known compound begins": 3.93,
    "known compound ends": 3.07,
    "known noun in -ing": -2.57,
    "left over": 0.78,
    "modal can": -0.07,
    "modal may": 2.15,
    "modal might": 1.33,
    "modal need": 1.45,
    "modal will": 1.24,
    "never a plural": 3.66,
    "noun after a plural": -3.04,
    "object after a transitive verb": 0.92,
    "other command": -0.16,
    "participle like its base": -1.60,
    "participle of a verb": 2.89,
    "past like a noun": 0.94,
    "past of a known noun": 0.37,
    "past of a verb": 1.44,
    "place after a verb of place": 0.58,
    "place after another verb": -1.51,
    "plain form": 1.55,
    "plain form of a known noun": 0.41,
    "plural after a determiner of one": -1.99,
    "plural after a number": 2.13,
    "put": 1.58,
    "rather a noun": -1.83,
    "rather a plural": -1.87,
    "second verb of a clause": -2.65,
    "singular after a number": -1.59,
    "that": 0.10,
    "unknown in -ed": 1.95,
    "unknown in -ing": 0.10,
    "unknown in -s": -2.76,
    "unknown plain form": -2.94,
    "unknown verb before adjective": -1.01,
    "unknown verb before adverb": -1.35,
    "unknown verb before be": -1.21,
    "unknown verb before colon": -0.87,
    "unknown verb before determiner": -1.22,
    "unknown verb before digits": -0.69,
    "unknown verb before end": -0.92,
    "unknown verb before joint": -0.97,
    "unknown verb before of": -0.45,
    "unknown verb before participle": -0.88,
    "unknown verb before place": -0.86,
    "unknown verb before pronoun": -0.87,
    "unknown verb before relative": -1.20,
    "unknown verb before there": -0.42,
    "unknown verb before to": -1.33,
    "unknown verb before verb or noun": -0.62,
    "unknown verb before word": -0.95,
    "verb after a place only": -0.79,
    "verb agrees": 0.55,
    "verb disagrees": -1.95,
    "verb missing": -0.07,
    "verb of saying": 1.87,
    "verb without a subject": -2.22,
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
