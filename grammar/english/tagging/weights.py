"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.19       1.90       0.83      -2.65      -1.24      -2.60       1.72       1.19      -0.46
be                    -2.07      -1.88       0.59      -2.02       1.91       3.28          -       0.33          -
by                    -1.67          -      -0.78      -1.56          -       2.63          -       0.09      -0.09
determiner             2.78       2.74      -1.43      -2.85       0.16      -2.17      -1.05      -0.41       0.41
ing                   -0.80       1.57       0.07      -1.15       0.05       0.76      -0.06          -      -0.22
joint                     -      -0.77      -0.71      -0.44       2.93       0.67       0.74      -0.15       0.29
modal                 -1.30      -0.95      -0.27       1.47      -0.43      -0.71      -0.99       1.20       0.30
noun                      -      -1.01       1.09      -0.95       1.12       0.70       1.11      -1.40          -
of                     1.24       1.15      -0.26      -1.42          -          -          -      -1.47          -
participle             2.33      -0.70       0.54      -1.15      -0.17       1.78          -      -0.11       1.77
place                  0.33          -          -      -0.33          -          -          -          -          -
preposition           -0.33       0.77      -0.95      -2.06      -0.21      -0.17       0.84      -0.24      -0.84
pronoun               -2.83      -1.91       2.52       0.16       0.65       0.81       2.18      -0.50       0.05
relative              -0.34      -0.05       1.41       0.15      -0.05          -       0.21       1.25          -
start                 -0.10       0.13      -3.05       0.08       0.81       0.45       1.00      -0.58      -0.21
subordinate            0.56      -1.35      -0.80      -0.54       0.07       1.78       0.51       1.55      -0.41
to                    -0.97       0.62       2.24       0.77       1.01          -          -      -0.10      -0.08
verb                  -1.22      -1.22       0.12       0.15       0.62      -0.41      -0.40       1.27       0.09
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.15      -2.33       0.78      -0.62       2.22      -0.79       1.17      -0.60       0.66
adverb                -0.65      -1.33       0.52      -0.29       0.30       1.97       1.87      -0.58       0.54
be                     0.44       1.36      -2.43      -0.50      -0.99      -2.57       2.28      -1.48       1.24
colon                  1.87       1.19      -1.74      -1.83      -1.06       1.44      -0.45      -0.11       0.58
determiner            -0.94      -0.24       1.43       0.97       1.65          -       0.71      -0.35      -0.61
digits                 1.69          -       0.17      -1.26      -0.52          -          -          -          -
end                    0.62       1.67      -0.27      -1.32      -0.71       1.09      -0.68      -1.36       1.30
joint                  0.66       2.08      -0.19      -0.91      -0.14       0.78      -1.22      -1.15       1.21
of                     1.61       1.16      -0.77      -1.73      -1.91      -0.83      -0.89       0.27      -0.54
participle             0.07          -      -0.40          -      -0.22      -0.52          -       0.71      -0.71
place                 -0.73       0.95       1.17      -0.29       0.75       1.22      -0.71      -1.68       0.76
pronoun               -0.53       1.51       2.90      -0.99      -0.37      -0.27       1.84          -      -0.13
relative                  -       0.19      -0.53       0.12       0.90      -0.34          -          -          -
there                 -0.79       0.12       0.30       0.40          -       0.91          -       1.16       1.22
to                    -0.12       0.54       1.14      -0.95       0.25       0.84          -          -          -
verb or noun           0.85      -1.06      -1.60       0.16       1.37      -1.64       0.87      -0.24      -0.69
word                   0.39      -1.32      -0.39      -0.21       2.08      -0.25      -0.37          -      -0.93
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.34,
    "-ing before a name": 2.18,
    "-ing of a known noun": 1.14,
    "-ing of a verb": 1.12,
    "acronym": 0.90,
    "capital within a sentence": 1.50,
    "command before adjective": 1.10,
    "command before adverb": -0.44,
    "command before be": -1.37,
    "command before colon": -1.67,
    "command before determiner": 1.28,
    "command before digits": -0.94,
    "command before end": 0.12,
    "command before joint": -2.99,
    "command before of": -1.80,
    "command before participle": -0.31,
    "command before place": -0.44,
    "command before pronoun": 1.35,
    "command before relative": 0.61,
    "command before there": 1.03,
    "command before verb or noun": 0.39,
    "command before word": -0.30,
    "command like a thing": 0.77,
    "command like a thing without an object": -0.42,
    "command with an object and a place": 2.09,
    "command, comma within a command": -1.30,
    "command, comma within a command, after a subject": -1.55,
    "command, comma within a open": 1.87,
    "command, comma within a open, after a subject": -1.21,
    "command, comma within a statement": -0.58,
    "command, comma within a statement, after a subject": -0.44,
    "command, conjunction within a command": 0.86,
    "command, conjunction within a command, after a subject": 0.33,
    "command, conjunction within a open": 1.50,
    "command, conjunction within a open, after a subject": -1.10,
    "command, conjunction within a statement": -0.29,
    "command, conjunction within a statement, after a subject": 0.43,
    "command, start": 0.08,
    "command, subordinate": -0.29,
    "command, subordinate, after a subject": -0.17,
    "find": 1.35,
    "finite verb after a joint, within a command": 0.65,
    "finite verb after a joint, within a open": -0.35,
    "finite verb after a joint, within a statement": -0.93,
    "finite verb after a modal verb": -0.41,
    "form in -s": 0.86,
    "form in -s of a known noun": 0.55,
    "hardly a noun": 2.81,
    "infinitive": 0.79,
    "infinitive missing": -0.90,
    "known compound begins": 3.65,
    "known compound ends": 3.08,
    "known noun in -ing": -2.71,
    "left over": 0.77,
    "modal can": -0.22,
    "modal may": 2.35,
    "modal might": 1.47,
    "modal need": 1.46,
    "modal will": 1.19,
    "never a plural": 3.47,
    "noun after a plural": -3.20,
    "object after a transitive verb": 0.89,
    "other command": 0.22,
    "participle like its base": -1.51,
    "participle of a verb": 3.04,
    "past like a noun": 0.84,
    "past of a known noun": 0.24,
    "past of a verb": 1.41,
    "place after a verb of place": 0.67,
    "place after another verb": -1.62,
    "plain form": 1.44,
    "plural after a determiner of one": -2.36,
    "plural after a number": 2.13,
    "put": 1.68,
    "rather a noun": -1.35,
    "rather a plural": -1.80,
    "second verb of a clause": -2.63,
    "singular after a number": -1.66,
    "that": 0.51,
    "unknown in -ed": 2.11,
    "unknown in -ing": 0.07,
    "unknown in -s": -2.93,
    "unknown plain form": -3.45,
    "unknown verb before adjective": -1.03,
    "unknown verb before adverb": -1.47,
    "unknown verb before be": -1.43,
    "unknown verb before colon": -0.80,
    "unknown verb before determiner": -1.25,
    "unknown verb before digits": -0.83,
    "unknown verb before end": -0.66,
    "unknown verb before joint": -0.79,
    "unknown verb before of": -1.02,
    "unknown verb before participle": -0.41,
    "unknown verb before place": -0.59,
    "unknown verb before pronoun": -0.57,
    "unknown verb before relative": -0.83,
    "unknown verb before there": -0.38,
    "unknown verb before to": 0.29,
    "unknown verb before verb or noun": -1.01,
    "unknown verb before word": -1.79,
    "verb after a place only": -0.98,
    "verb agrees": 0.39,
    "verb disagrees": -2.15,
    "verb missing": -0.16,
    "verb of saying": 1.82,
    "verb without a subject": -2.57,
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
