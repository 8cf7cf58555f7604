"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.26       1.98       0.94      -2.15      -1.40      -2.53       1.42       1.25      -0.36
be                    -2.23      -1.80       0.42      -1.82       1.77       3.07          -       0.34          -
by                    -0.89          -      -1.41      -1.23          -       2.57          -       0.08      -0.08
determiner             2.61       2.72      -1.42      -2.46          -      -2.67      -1.14      -0.68       0.16
ing                   -0.77       1.48       0.30      -0.93       0.08       0.86      -0.28      -0.05      -0.26
joint                 -0.10      -0.86      -0.60      -0.25       2.79       0.49       0.31      -0.54          -
modal                 -1.25      -1.40      -0.27       1.31      -0.39      -0.67      -1.02       1.37       0.42
noun                   0.16      -0.76       1.34      -0.66       1.01       0.71       1.04      -1.79      -0.26
of                     1.48       1.07      -0.32      -1.66          -          -          -      -1.19      -0.27
participle             2.09      -0.12       0.37      -1.08      -0.57       1.71          -          -       1.66
place                  0.39          -          -      -0.39          -          -          -          -          -
preposition               -       0.70      -1.93      -1.93      -0.24          -       1.02      -0.27      -0.96
pronoun               -2.60      -1.82       2.04       0.26       0.55       0.73       2.29      -0.08       0.84
relative              -0.06      -0.19       0.78          -      -0.06          -       0.37       1.21       0.15
start                  0.09       0.06      -2.74       0.20       0.54       0.49       0.59      -0.46       0.22
subordinate            0.52      -0.83      -1.10      -0.31       0.25       1.68       0.38       1.28      -0.68
to                    -0.80       0.69       1.97       0.61       1.03          -          -      -0.16      -0.12
verb                  -1.32      -1.25       0.28          -       0.54      -1.02      -0.42       1.03      -0.32
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -      -2.37       0.87      -0.73       1.67      -0.84       1.50      -0.84       1.02
adverb                -0.52      -0.85          -      -0.81       0.21       2.30       1.44      -0.64       0.70
be                     0.72       1.37      -2.25      -0.35      -0.82      -1.99       2.53      -1.79       1.24
colon                  1.64       1.11      -1.96      -2.11      -1.02       1.30      -0.53      -0.72       1.03
determiner            -0.75      -0.38       1.39       0.83       1.44      -0.10       0.21      -0.73      -0.63
digits                 1.31          -      -0.17      -0.61      -0.78          -          -          -          -
end                    0.68       1.73       0.11      -1.09      -0.78       1.17      -0.35      -1.54       0.98
joint                  0.41       2.00      -0.31      -1.04      -0.36       0.69      -0.94      -1.54       1.10
of                     2.46       1.23      -2.39      -1.39      -1.33      -0.53      -0.79       0.40      -0.65
participle             0.07          -      -0.36       0.12      -0.19      -0.37          -       0.76      -0.76
place                 -0.70       0.76       1.04      -0.41       0.64       1.42      -0.69      -1.91       0.76
pronoun               -0.37       1.41       2.87      -0.99      -0.34      -0.32       1.29          -      -0.68
relative              -0.19       0.32      -0.52       0.23       0.81      -0.37          -          -          -
there                 -0.95       0.32       0.39       0.54          -       0.92          -       1.40       1.51
to                    -0.16       0.45       1.51      -1.15       0.08       0.97          -      -0.65          -
verb or noun           0.90      -1.08      -2.08       0.58       1.45      -1.47       1.20      -0.87      -1.17
word                   0.40      -1.39      -0.42      -0.32       2.17      -0.06      -0.22       0.52      -0.69
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.33,
    "-ing before a name": 2.09,
    "-ing before an unknown noun": 0.18,
    "-ing of a known noun": 1.11,
    "-ing of a verb": 1.08,
    "acronym": 0.89,
    "capital within a sentence": 1.31,
    "command before adjective": 1.32,
    "command before be": -1.28,
    "command before colon": -1.79,
    "command before determiner": 1.40,
    "command before digits": -0.33,
    "command before end": -0.20,
    "command before joint": -3.26,
    "command before of": -1.49,
    "command before participle": -0.37,
    "command before place": -0.27,
    "command before pronoun": 1.46,
    "command before relative": 0.75,
    "command before there": 1.15,
    "command before to": 0.23,
    "command before verb or noun": 0.72,
    "command before word": 0.18,
    "command like a thing": 0.53,
    "command like a thing without an object": -0.51,
    "command with an object and a place": 2.29,
    "command, comma within a command": -1.60,
    "command, comma within a command, after a subject": -1.67,
    "command, comma within a open": 1.74,
    "command, comma within a open, after a subject": -1.24,
    "command, comma within a statement": -0.39,
    "command, comma within a statement, after a subject": -0.43,
    "command, conjunction within a command": 1.42,
    "command, conjunction within a command, after a subject": 0.51,
    "command, conjunction within a open": 1.27,
    "command, conjunction within a open, after a subject": -1.30,
    "command, conjunction within a statement": -0.32,
    "command, conjunction within a statement, after a subject": 0.24,
    "command, start": 0.20,
    "command, subordinate": -0.20,
    "find": 1.10,
    "finite verb after a joint, within a command": 0.51,
    "finite verb after a joint, within a open": -0.21,
    "finite verb after a joint, within a statement": -0.84,
    "finite verb after a modal verb": -0.73,
    "form in -s": 0.56,
    "form in -s of a known noun": 0.27,
    "hardly a noun": 3.07,
    "infinitive": 0.87,
    "infinitive missing": -1.03,
    "known compound begins": 3.20,
    "known compound ends": 2.92,
    "known noun in -ing": -2.97,
    "left over": 1.05,
    "modal may": 2.24,
    "modal might": 1.57,
    "modal need": 1.45,
    "modal will": 1.46,
    "never a plural": 4.08,
    "noun after a plural": -3.10,
    "number after a word": 1.82,
    "object after a transitive verb": 0.89,
    "other command": -0.26,
    "participle like its base": -1.44,
    "participle of a verb": 3.32,
    "past like a noun": 0.95,
    "past of a known noun": 0.55,
    "past of a verb": 1.43,
    "place after a verb of place": 0.58,
    "place after another verb": -1.56,
    "plain form": 1.43,
    "plain form of a known noun": 0.18,
    "plural after a determiner of one": -1.94,
    "plural after a number": 1.34,
    "put": 1.54,
    "rather a noun": -1.87,
    "rather a plural": -1.77,
    "second verb of a clause": -2.68,
    "singular after a number": -1.44,
    "unknown in -ed": 2.20,
    "unknown in -s": -2.48,
    "unknown plain form": -3.48,
    "unknown verb before adjective": -1.14,
    "unknown verb before adverb": -1.71,
    "unknown verb before be": -0.96,
    "unknown verb before colon": -1.07,
    "unknown verb before determiner": -1.27,
    "unknown verb before digits": -1.34,
    "unknown verb before end": -0.66,
    "unknown verb before joint": -1.08,
    "unknown verb before of": -0.47,
    "unknown verb before participle": -0.77,
    "unknown verb before place": -0.54,
    "unknown verb before pronoun": -0.52,
    "unknown verb before relative": -1.11,
    "unknown verb before there": -0.50,
    "unknown verb before to": -0.78,
    "unknown verb before verb or noun": -0.51,
    "unknown verb before word": -1.46,
    "verb after a place only": -0.83,
    "verb agrees": 0.51,
    "verb disagrees": -2.26,
    "verb missing": -0.22,
    "verb of saying": 1.63,
    "verb without a subject": -2.24,
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
