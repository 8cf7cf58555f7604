"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.14       2.07       0.84      -2.63      -1.20      -2.70       1.60       1.02      -0.56
be                    -2.04      -1.84       0.61      -1.74       1.97       2.92          -       0.33      -0.16
by                    -0.87          -      -1.37      -1.14          -       2.69          -       0.11      -0.11
determiner             2.67       2.95      -1.43      -2.64       0.24      -2.53      -1.38      -0.67       0.25
ing                   -0.90       1.52       0.12      -0.56       0.12       0.84      -0.25      -0.26      -0.29
joint                 -0.09      -0.70      -0.60      -0.31       3.18       0.45       0.54      -0.09       0.62
modal                 -1.47      -1.01      -0.28       1.61      -0.40      -0.69      -0.96       1.10       0.34
noun                   0.09      -0.81       1.35      -0.74       1.15       0.67       1.10      -1.84      -0.27
of                     1.60       1.10      -0.27      -1.72          -          -          -      -1.38      -0.25
participle             2.00      -0.28       0.58      -1.26      -0.30       1.49          -      -0.06       1.63
place                  0.41          -          -      -0.41          -          -          -          -          -
preposition           -0.08       0.58      -2.06      -1.82       0.18      -0.14       0.95      -0.33      -0.81
pronoun               -2.87      -1.85       2.16       0.22       0.60       0.91       1.84      -0.46       0.28
relative              -0.75      -0.28       1.07      -0.16       0.22          -       0.31       1.10      -0.05
start                  0.12      -0.11      -2.49       0.23       0.98       0.53       0.87      -0.55      -0.23
subordinate            0.50      -0.99      -0.79      -0.41       0.13       1.70       0.71       1.54      -0.43
to                    -1.22       1.08       2.11       1.04       1.21          -          -      -0.07      -0.07
verb                  -1.35      -1.06      -0.06       0.05       0.62      -0.63      -0.41       1.21      -0.09
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.20      -2.58       0.61      -0.22       2.48      -0.73       1.20      -0.66       0.73
adverb                -0.60      -1.14       0.45      -0.58       0.07       1.93       1.81      -0.45       0.43
be                     0.74       1.56      -2.35      -0.44      -0.66      -2.24       2.60      -1.04       1.47
colon                  1.77       1.06      -2.43      -1.93      -0.88       1.20      -0.61      -0.63       0.91
determiner            -0.74      -0.32       1.27       0.76       1.46      -0.22       0.36      -0.74      -0.51
digits                 1.53          -      -0.33      -0.55      -0.75          -          -          -          -
end                    0.81       1.54       0.11      -1.36      -0.79       1.10      -0.71      -1.51       1.26
joint                  0.82       1.89          -      -0.95      -0.33       0.82      -1.02      -1.41       0.99
of                     1.70       1.04      -0.88      -1.83      -1.46      -0.94      -0.85       0.22      -0.45
participle             0.12          -      -0.20       0.06      -0.22      -0.44          -       0.66      -0.66
place                 -0.83       0.75       0.88      -0.52       0.64       1.00      -0.67      -1.99       0.52
pronoun               -0.30       1.39       2.96      -1.00      -0.40      -0.37       1.57       0.12      -0.20
relative               0.45       0.35      -0.54       0.35       0.83      -0.37          -          -          -
there                 -0.62       0.17       0.28       0.47          -       0.93          -       1.04       1.29
to                    -0.16       0.52       1.36      -1.08       0.05       0.77          -      -0.62          -
verb or noun           0.92      -1.18      -1.60       0.27       1.48      -1.55       1.16      -0.39      -0.79
word                   0.41      -1.68      -0.40      -0.33       2.13      -0.15      -0.14       0.27      -1.13
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.42,
    "-ing before a name": 2.04,
    "-ing before an unknown noun": 0.05,
    "-ing of a known noun": 1.26,
    "-ing of a verb": 1.40,
    "acronym": 0.90,
    "capital within a sentence": 1.19,
    "command before adjective": 0.63,
    "command before adverb": -0.18,
    "command before be": -1.39,
    "command before colon": -1.70,
    "command before determiner": 1.39,
    "command before digits": -0.14,
    "command before end": 0.11,
    "command before joint": -2.54,
    "command before of": -2.03,
    "command before participle": -0.33,
    "command before place": -0.33,
    "command before pronoun": 1.36,
    "command before relative": 1.09,
    "command before there": 1.01,
    "command before verb or noun": 0.58,
    "command like a thing": 0.60,
    "command like a thing without an object": -0.62,
    "command with an object and a place": 2.07,
    "command, comma within a command": -1.53,
    "command, comma within a command, after a subject": -1.76,
    "command, comma within a open": 1.97,
    "command, comma within a open, after a subject": -1.19,
    "command, comma within a statement": -0.58,
    "command, comma within a statement, after a subject": -0.50,
    "command, conjunction within a command": 1.18,
    "command, conjunction within a command, after a subject": 0.58,
    "command, conjunction within a open": 1.40,
    "command, conjunction within a open, after a subject": -1.20,
    "command, conjunction within a statement": -0.30,
    "command, conjunction within a statement, after a subject": 0.47,
    "command, start": 0.23,
    "command, subordinate": -0.29,
    "command, subordinate, after a subject": -0.21,
    "find": 1.08,
    "finite verb after a joint, within a command": 0.73,
    "finite verb after a joint, within a open": -0.40,
    "finite verb after a joint, within a statement": -0.86,
    "finite verb after a modal verb": -0.82,
    "form in -s": 0.74,
    "form in -s of a known noun": 0.19,
    "hardly a noun": 2.75,
    "infinitive": 0.85,
    "infinitive missing": -0.89,
    "known compound begins": 3.02,
    "known compound ends": 3.14,
    "known noun in -ing": -2.52,
    "left over": 0.89,
    "modal can": -0.15,
    "modal may": 2.16,
    "modal might": 1.44,
    "modal need": 1.46,
    "modal will": 1.57,
    "never a plural": 3.26,
    "noun after a plural": -3.16,
    "number after a word": 2.31,
    "object after a transitive verb": 1.05,
    "other command": -0.07,
    "participle like its base": -1.46,
    "participle of a verb": 2.88,
    "past like a noun": 0.93,
    "past of a known noun": 0.54,
    "past of a verb": 1.65,
    "place after a verb of place": 0.54,
    "place after another verb": -1.94,
    "plain form": 1.63,
    "plain form of a known noun": 0.07,
    "plural after a determiner of one": -2.22,
    "plural after a number": 1.19,
    "put": 1.37,
    "rather a noun": -1.38,
    "rather a plural": -1.80,
    "second verb of a clause": -2.65,
    "singular after a number": -1.71,
    "that": 0.46,
    "unknown in -ed": 2.17,
    "unknown in -ing": 0.34,
    "unknown in -s": -2.56,
    "unknown plain form": -3.59,
    "unknown verb before adjective": -1.05,
    "unknown verb before adverb": -1.63,
    "unknown verb before be": -1.46,
    "unknown verb before colon": -0.73,
    "unknown verb before determiner": -1.46,
    "unknown verb before digits": -0.93,
    "unknown verb before end": -0.33,
    "unknown verb before joint": -1.17,
    "unknown verb before of": -1.17,
    "unknown verb before participle": -0.84,
    "unknown verb before place": -0.53,
    "unknown verb before pronoun": -0.63,
    "unknown verb before relative": -0.71,
    "unknown verb before there": -0.36,
    "unknown verb before to": 0.06,
    "unknown verb before verb or noun": -1.00,
    "unknown verb before word": -2.27,
    "verb after a place only": -0.85,
    "verb agrees": 0.60,
    "verb disagrees": -2.09,
    "verb missing": -0.22,
    "verb of saying": 1.81,
    "verb without a subject": -2.42,
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
