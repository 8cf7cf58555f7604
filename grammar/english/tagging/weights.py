"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.05       1.99       1.00      -2.55      -1.34      -2.71       1.05       0.92      -0.64
be                    -2.15      -1.73       0.64      -1.98       1.90       2.90          -       0.32          -
by                    -1.59          -      -0.66      -0.94          -       2.49          -       0.11      -0.11
determiner             2.54       2.60      -1.62      -2.61          -      -2.51      -1.01      -0.60          -
ing                   -1.01       1.40      -0.11      -1.34          -       0.92      -0.28          -      -0.37
joint                 -0.22      -0.77      -0.79      -0.07       2.96       0.51       0.53       0.11       0.38
modal                 -1.41      -0.92      -0.51       1.61      -0.09      -0.76      -0.79       1.21       0.13
noun                   0.07      -0.94       1.20      -0.69       1.15       0.79       1.24      -1.42      -0.43
of                     1.36       1.08      -0.27      -1.58          -          -          -      -1.18      -0.29
participle             2.17      -0.33       0.31      -1.10      -0.21       1.63          -      -0.22       1.46
place                  0.39          -          -      -0.39          -          -          -          -          -
preposition           -0.54       0.93      -1.22      -2.12          -      -0.39       0.91      -0.52      -1.54
pronoun               -2.73      -1.65       2.55       0.26       0.52       0.96       1.96      -0.26       0.22
relative              -0.46      -0.29       1.21      -0.06       0.06          -       0.44       1.10      -0.22
start                  0.10      -0.06      -2.39       0.38       0.98       0.69       1.04      -0.32      -0.26
subordinate            0.40      -1.08      -0.26      -0.28       0.16       1.70       0.44       1.27       0.48
to                    -1.20       0.81       2.25       0.79       1.08          -          -      -0.09      -0.07
verb                  -1.31      -1.31       0.10       0.58       0.62      -0.42      -0.33       1.26      -0.17
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.23      -2.18       0.69      -0.58       2.15      -0.76       0.77      -0.34       0.56
adverb                -0.78      -1.20       0.18      -0.49       0.21       2.09       1.29      -0.69       0.64
be                     0.49       1.20      -2.69      -0.54      -0.89      -2.57       2.13      -1.19       1.26
colon                  1.58       1.07      -2.08      -2.08      -0.95       1.16      -0.51          -       0.57
determiner            -0.97      -0.48       1.37       0.89       1.41      -0.18       0.52      -0.65      -0.24
digits                 1.64          -       0.07      -1.33      -0.48          -          -          -          -
end                    0.76       1.70      -0.23      -1.32      -0.66       1.14      -0.67      -1.45       1.44
joint                  0.74       1.91      -0.25      -1.03      -0.30       0.81      -1.24      -1.06       1.13
of                     1.52       1.11      -0.83      -1.75      -1.50      -0.80      -0.86       0.10      -0.39
participle                -          -      -0.15       0.07      -0.19      -0.38          -       0.61      -0.61
place                 -0.72       0.79       1.04      -0.44       0.84       1.18      -0.75      -1.83       0.31
pronoun               -0.24       1.13       2.61      -0.86      -0.56      -0.27       1.62          -          -
relative               0.26       0.33      -0.43       0.18       0.86      -0.31          -          -          -
there                 -0.70       0.11       0.30       0.24          -       0.94          -       1.03       1.14
to                    -0.08       0.35       1.12      -1.02       0.21       0.94          -          -          -
verb or noun           0.78      -1.25      -1.78       0.49       1.45      -1.43       1.11      -0.33      -0.65
word                   0.44      -1.49      -0.35      -0.30       2.16          -      -0.09       0.08      -1.02
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.36,
    "-ing before a name": 2.09,
    "-ing of a known noun": 1.10,
    "-ing of a verb": 1.18,
    "acronym": 0.90,
    "capital within a sentence": 1.46,
    "command before adjective": 1.07,
    "command before adverb": -0.28,
    "command before be": -1.50,
    "command before colon": -2.21,
    "command before determiner": 1.09,
    "command before digits": -1.05,
    "command before end": 0.14,
    "command before joint": -2.97,
    "command before of": -1.60,
    "command before participle": -0.36,
    "command before place": -0.45,
    "command before pronoun": 1.27,
    "command before relative": 0.61,
    "command before there": 1.13,
    "command before verb or noun": 0.89,
    "command before word": -0.18,
    "command like a thing": 0.59,
    "command like a thing without an object": -0.60,
    "command with an object and a place": 1.98,
    "command, comma within a command": -1.40,
    "command, comma within a command, after a subject": -1.77,
    "command, comma within a open": 1.75,
    "command, comma within a open, after a subject": -1.37,
    "command, comma within a statement": -0.69,
    "command, comma within a statement, after a subject": -0.64,
    "command, conjunction within a command": 0.76,
    "command, conjunction within a command, after a subject": 0.43,
    "command, conjunction within a open": 0.92,
    "command, conjunction within a open, after a subject": -0.90,
    "command, conjunction within a statement": -0.55,
    "command, conjunction within a statement, after a subject": 0.49,
    "command, start": 0.38,
    "command, subordinate": -0.28,
    "find": 1.15,
    "finite verb after a joint, within a command": 0.63,
    "finite verb after a joint, within a open": -0.46,
    "finite verb after a joint, within a statement": -0.94,
    "finite verb after a modal verb": -0.57,
    "form in -s": 0.82,
    "form in -s of a known noun": 0.52,
    "hardly a noun": 2.86,
    "infinitive": 0.89,
    "infinitive missing": -0.89,
    "known compound begins": 3.66,
    "known compound ends": 3.16,
    "known noun in -ing": -2.85,
    "left over": 0.74,
    "modal can": -0.14,
    "modal may": 2.21,
    "modal might": 1.71,
    "modal need": 1.31,
    "modal will": 1.17,
    "never a plural": 3.68,
    "noun after a plural": -3.16,
    "object after a transitive verb": 0.78,
    "participle like its base": -1.61,
    "participle of a verb": 2.79,
    "past like a noun": 0.72,
    "past of a known noun": 0.67,
    "past of a verb": 1.95,
    "place after a verb of place": 0.65,
    "place after another verb": -1.77,
    "plain form": 1.38,
    "plural after a determiner of one": -2.10,
    "plural after a number": 2.10,
    "put": 1.44,
    "rather a noun": -1.22,
    "rather a plural": -1.88,
    "second verb of a clause": -2.56,
    "singular after a number": -1.69,
    "that": 0.65,
    "unknown in -ed": 2.14,
    "unknown in -ing": 0.13,
    "unknown in -s": -2.96,
    "unknown plain form": -3.68,
    "unknown verb before adjective": -1.22,
    "unknown verb before adverb": -1.30,
    "unknown verb before be": -1.18,
    "unknown verb before colon": -0.97,
    "unknown verb before determiner": -1.11,
    "unknown verb before digits": -0.86,
    "unknown verb before end": -0.65,
    "unknown verb before joint": -0.53,
    "unknown verb before of": -0.98,
    "unknown verb before participle": -0.88,
    "unknown verb before place": -0.49,
    "unknown verb before pronoun": -0.36,
    "unknown verb before relative": -0.94,
    "unknown verb before there": -0.40,
    "unknown verb before to": 0.12,
    "unknown verb before verb or noun": -1.03,
    "unknown verb before word": -1.77,
    "verb after a place only": -0.88,
    "verb agrees": 0.54,
    "verb disagrees": -2.08,
    "verb missing": -0.16,
    "verb of saying": 1.72,
    "verb without a subject": -2.51,
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
