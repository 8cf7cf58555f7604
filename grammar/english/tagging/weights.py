"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.16       1.92       0.67      -2.43      -1.21      -2.52       1.38       1.11      -0.80
be                    -1.88      -1.80       0.60      -1.38       1.94       2.56          -       0.36          -
by                    -0.81          -      -1.32      -1.22          -       2.49          -       0.25      -0.25
determiner             2.55       2.84      -1.51      -2.33       0.17      -2.65      -1.22      -0.77       0.15
ing                   -0.75       1.34       0.34      -1.44          -       0.91      -0.13          -      -0.34
joint                     -      -0.92      -0.73          -       2.59       0.47       0.47      -0.42      -0.13
modal                 -1.21      -1.30      -0.30       1.35      -0.23      -0.63      -0.75       1.27       0.34
noun                   0.25      -0.81       1.36      -0.49       1.10       0.83       1.25      -1.73      -0.36
of                     1.56       1.08      -0.30      -1.54          -          -          -      -1.18      -0.29
participle             2.12      -0.17       0.29      -0.92      -0.45       1.65          -      -0.09       1.44
place                  0.38          -          -      -0.38          -          -          -          -          -
preposition           -0.06       0.57      -2.03      -1.46      -0.16          -       0.83      -0.37      -1.00
pronoun               -2.47      -1.48       2.27       0.47       0.74       0.86       2.11      -0.36       0.91
relative               0.09      -0.15       0.62       0.33      -0.09          -       0.34       0.87       0.23
start                 -0.11       0.52      -2.86       0.19       0.91       0.22       0.63      -0.53       0.22
subordinate            0.59      -1.13      -0.76      -0.21       0.07       1.64       0.53       1.33      -0.60
to                    -0.91       0.76       2.14       0.59       1.20          -          -      -0.14      -0.08
verb                  -1.22      -1.31       0.29       0.05       0.63      -0.94      -0.39       1.25      -0.28
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -      -2.42       0.96      -0.59       1.80      -0.64       1.75      -0.93       1.02
adverb                -0.48      -1.04          -      -0.65       0.28       2.12       1.59      -0.67       0.61
be                     0.46       1.25      -2.51      -0.51      -0.95      -2.41       2.15      -1.65       1.52
colon                  1.67       1.17      -2.32      -1.84      -0.96       1.24      -0.56      -1.09       1.27
determiner            -0.67      -0.35       1.37       0.76       1.46       0.06       0.55      -0.82      -0.45
digits                 1.57          -      -0.21      -0.81      -0.67          -          -          -          -
end                    0.68       1.60       0.11      -1.07      -0.77       1.19      -0.76      -1.73       1.19
joint                  0.57       2.00      -0.16      -0.93      -0.15       0.91      -0.82      -1.51       1.22
of                     2.49       1.05      -2.38      -1.51      -1.25      -0.43      -0.77       0.41      -0.65
participle                -          -      -0.33       0.20      -0.28      -0.40       0.05       0.60      -0.60
place                 -0.71       0.75       0.98      -0.41       0.76       1.43      -0.59      -2.18       0.75
pronoun               -0.50       1.19       2.59      -1.32      -0.71      -0.45       1.03          -      -0.66
relative              -0.16       0.46      -0.48       0.17       0.80      -0.37          -          -          -
there                 -0.88       0.34       0.42       0.40          -       0.90          -       1.51       1.47
to                    -0.21       0.45       1.53      -1.06       0.20       0.92          -      -0.67          -
verb or noun           1.02      -1.02      -1.83       0.61       1.63      -1.17       1.60      -0.88      -1.45
word                   0.35      -1.40      -0.42      -0.37       2.14      -0.07      -0.13       0.58      -0.79
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.30,
    "-ing before a name": 1.87,
    "-ing before an unknown noun": 0.27,
    "-ing of a known noun": 1.11,
    "-ing of a verb": 1.11,
    "acronym": 0.90,
    "capital within a sentence": 1.31,
    "command before adjective": 1.04,
    "command before adverb": -0.17,
    "command before be": -1.17,
    "command before colon": -1.75,
    "command before determiner": 1.27,
    "command before digits": -0.09,
    "command before end": -0.23,
    "command before joint": -2.93,
    "command before of": -1.14,
    "command before participle": -0.55,
    "command before place": -0.37,
    "command before pronoun": 1.50,
    "command before relative": 0.85,
    "command before there": 1.08,
    "command before to": 0.06,
    "command before verb or noun": 0.61,
    "command like a thing": 0.63,
    "command like a thing without an object": -0.50,
    "command with an object and a place": 2.43,
    "command, comma within a command": -1.45,
    "command, comma within a command, after a subject": -1.28,
    "command, comma within a open": 1.68,
    "command, comma within a open, after a subject": -1.26,
    "command, comma within a statement": -0.50,
    "command, comma within a statement, after a subject": -0.38,
    "command, conjunction within a command": 1.37,
    "command, conjunction within a command, after a subject": 0.40,
    "command, conjunction within a open": 1.30,
    "command, conjunction within a open, after a subject": -1.19,
    "command, conjunction within a statement": -0.38,
    "command, conjunction within a statement, after a subject": 0.29,
    "command, start": 0.19,
    "command, subordinate": -0.09,
    "command, subordinate, after a subject": -0.06,
    "find": 0.90,
    "finite verb after a joint, within a open": -0.20,
    "finite verb after a joint, within a statement": -0.72,
    "finite verb after a modal verb": -0.87,
    "form in -s": 0.64,
    "form in -s of a known noun": 0.37,
    "hardly a noun": 2.98,
    "infinitive": 0.89,
    "infinitive missing": -1.06,
    "known compound begins": 3.14,
    "known compound ends": 3.03,
    "known noun in -ing": -2.87,
    "left over": 0.85,
    "modal may": 2.06,
    "modal might": 2.08,
    "modal need": 1.28,
    "modal will": 1.21,
    "never a plural": 4.16,
    "noun after a plural": -3.15,
    "number after a word": 1.95,
    "object after a transitive verb": 0.80,
    "other command": -0.14,
    "participle like its base": -1.53,
    "participle of a verb": 3.01,
    "past like a noun": 0.75,
    "past of a known noun": 0.55,
    "past of a verb": 1.39,
    "place after a verb of place": 0.57,
    "place after another verb": -1.51,
    "plain form": 1.21,
    "plural after a determiner of one": -1.90,
    "plural after a number": 1.37,
    "put": 1.59,
    "rather a noun": -1.82,
    "rather a plural": -1.76,
    "second verb of a clause": -2.64,
    "singular after a number": -1.30,
    "unknown in -ed": 2.11,
    "unknown in -s": -2.45,
    "unknown plain form": -3.53,
    "unknown verb before adjective": -1.09,
    "unknown verb before adverb": -1.54,
    "unknown verb before be": -1.32,
    "unknown verb before colon": -0.66,
    "unknown verb before determiner": -1.28,
    "unknown verb before digits": -0.96,
    "unknown verb before end": -0.69,
    "unknown verb before joint": -1.08,
    "unknown verb before of": -0.30,
    "unknown verb before participle": -0.96,
    "unknown verb before place": -0.40,
    "unknown verb before pronoun": -0.43,
    "unknown verb before relative": -1.06,
    "unknown verb before there": -0.33,
    "unknown verb before to": -1.07,
    "unknown verb before verb or noun": -0.49,
    "unknown verb before word": -1.34,
    "verb after a place only": -0.79,
    "verb agrees": 0.49,
    "verb disagrees": -2.27,
    "verb missing": -0.26,
    "verb of saying": 1.76,
    "verb without a subject": -2.45,
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
