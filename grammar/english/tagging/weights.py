"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.12       2.12       0.90      -2.83      -1.42      -2.94       1.49       1.23      -0.41
be                    -2.07      -2.06       0.72      -1.86       1.77       3.21          -       0.31          -
by                    -1.83          -      -0.82      -1.47          -       2.15          -       0.06      -0.06
determiner             2.65       2.82      -1.45      -2.78          -      -2.48      -1.06      -0.60       0.17
ing                   -0.74       1.47       0.05      -0.75      -0.16       0.93      -0.21      -0.18      -0.27
joint                     -      -0.89      -0.83      -0.11       3.16       0.61       0.47      -0.12       0.23
modal                 -1.42      -1.35      -0.37       1.64      -0.39      -0.65      -0.99       1.29       0.29
noun                   0.13      -0.96       1.16      -0.73       1.15       0.69       1.14      -1.51      -0.22
of                     1.35       1.16      -0.27      -1.59          -          -          -      -1.23          -
participle             2.19      -0.85       0.42      -1.02      -0.56       1.56          -      -0.16       1.67
place                  0.36          -          -      -0.36          -          -          -          -          -
preposition           -0.63       0.94      -1.27      -2.19          -      -0.60       1.14      -0.17      -0.69
pronoun               -2.71      -1.84       2.73       0.44       0.48       1.08       2.08      -0.40       0.23
relative              -0.66      -0.27       1.05       0.17       0.16          -       0.19       1.13          -
start                  0.24      -0.49      -2.27       0.34       0.76       0.73       1.01      -0.73      -0.46
subordinate            0.66      -1.24      -0.61      -0.26          -       1.81       0.54       1.38      -0.30
to                    -1.12       0.71       2.05       0.68       1.09          -          -      -0.09          -
verb                  -1.18      -1.17       0.20       0.13       0.70      -0.39      -0.26       1.27       0.14
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective             -0.17      -2.47       0.65      -0.26       2.48      -0.66       1.32      -0.55       0.66
adverb                -0.80      -1.06       0.36      -0.58       0.08       1.78       1.39      -0.58       0.64
be                     0.65       1.07      -2.17      -0.41      -0.94      -2.15       2.32      -1.60       1.12
colon                  1.56       0.74      -2.16      -2.14      -0.89       1.22      -0.63      -0.06       0.68
determiner            -1.02      -0.36       1.27       0.96       1.77      -0.15       0.68      -0.54      -0.42
digits                 1.73          -       0.09      -1.21      -0.58          -          -          -          -
end                    0.79       1.60      -0.10      -1.17      -0.68       1.21      -0.48      -1.34       1.30
joint                  0.67       1.83      -0.26      -0.87      -0.34       0.74      -1.29      -1.25       1.34
of                     1.46       1.06      -0.89      -1.62      -1.55      -0.79      -0.88       0.13      -0.45
participle             0.09          -      -0.30       0.12      -0.15      -0.37          -       0.69      -0.69
place                 -0.78       0.87       1.05      -0.33       0.70       1.17      -0.74      -1.77       0.58
pronoun               -0.43       1.27       2.32      -1.04      -0.29      -0.32       1.89       0.08      -0.16
relative               0.18       0.25      -0.58       0.29       0.91      -0.36          -          -          -
there                 -0.89       0.12       0.25       0.46          -       0.93          -       0.94       1.17
to                    -0.30       0.46       0.95      -1.10       0.26       0.66          -          -          -
verb or noun           0.90      -1.41      -1.76       0.25       1.21      -1.61       1.14      -0.14      -0.78
word                   0.38      -1.70      -0.46      -0.24       1.95          -      -0.25       0.15      -1.16
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.57,
    "-ing before a name": 1.96,
    "-ing before an unknown noun": -0.13,
    "-ing of a known noun": 1.12,
    "-ing of a verb": 1.25,
    "acronym": 0.89,
    "capital within a sentence": 1.16,
    "command before adjective": 0.89,
    "command before adverb": -0.23,
    "command before be": -1.10,
    "command before colon": -1.81,
    "command before determiner": 1.27,
    "command before digits": -1.01,
    "command before end": 0.31,
    "command before joint": -2.77,
    "command before of": -2.08,
    "command before participle": -0.33,
    "command before place": -0.25,
    "command before pronoun": 1.31,
    "command before relative": 0.85,
    "command before there": 1.14,
    "command before to": 0.09,
    "command before verb or noun": 0.70,
    "command before word": -0.13,
    "command like a thing": 0.55,
    "command like a thing without an object": -0.55,
    "command with an object and a place": 2.04,
    "command, comma within a command": -1.54,
    "command, comma within a command, after a subject": -1.77,
    "command, comma within a open": 1.64,
    "command, comma within a open, after a subject": -1.38,
    "command, comma within a statement": -0.84,
    "command, comma within a statement, after a subject": -0.59,
    "command, conjunction within a command": 0.69,
    "command, conjunction within a command, after a subject": 0.29,
    "command, conjunction within a open": 1.46,
    "command, conjunction within a open, after a subject": -1.30,
    "command, conjunction within a statement": -0.18,
    "command, conjunction within a statement, after a subject": 0.26,
    "command, start": 0.34,
    "command, subordinate": -0.28,
    "command, subordinate, after a subject": 0.32,
    "find": 1.10,
    "finite verb after a joint, within a command": 0.85,
    "finite verb after a joint, within a open": -0.17,
    "finite verb after a joint, within a statement": -0.78,
    "finite verb after a modal verb": -0.88,
    "form in -s": 0.79,
    "form in -s of a known noun": 0.52,
    "hardly a noun": 2.90,
    "infinitive": 0.86,
    "infinitive missing": -0.87,
    "known compound begins": 3.87,
    "known compound ends": 3.09,
    "known noun in -ing": -2.66,
    "left over": 0.88,
    "modal may": 2.43,
    "modal might": 1.39,
    "modal need": 1.31,
    "modal will": 1.48,
    "never a plural": 3.70,
    "noun after a plural": -3.19,
    "object after a transitive verb": 0.91,
    "other command": -0.10,
    "participle like its base": -1.42,
    "participle of a verb": 2.85,
    "past like a noun": 0.54,
    "past of a known noun": 0.39,
    "past of a verb": 1.52,
    "place after a verb of place": 0.66,
    "place after another verb": -1.73,
    "plain form": 1.48,
    "plural after a determiner of one": -2.29,
    "plural after a number": 2.27,
    "put": 1.39,
    "rather a noun": -1.44,
    "rather a plural": -1.78,
    "second verb of a clause": -2.64,
    "singular after a number": -1.69,
    "that": 0.58,
    "unknown in -ed": 2.34,
    "unknown in -ing": 0.17,
    "unknown in -s": -2.89,
    "unknown plain form": -3.74,
    "unknown verb before adjective": -1.16,
    "unknown verb before adverb": -1.56,
    "unknown verb before be": -1.18,
    "unknown verb before colon": -0.80,
    "unknown verb before determiner": -1.30,
    "unknown verb before digits": -0.61,
    "unknown verb before end": -0.79,
    "unknown verb before joint": -0.89,
    "unknown verb before of": -0.87,
    "unknown verb before participle": -0.76,
    "unknown verb before place": -0.53,
    "unknown verb before pronoun": -0.48,
    "unknown verb before relative": -0.62,
    "unknown verb before there": -0.43,
    "unknown verb before to": 0.40,
    "unknown verb before verb or noun": -1.03,
    "unknown verb before word": -1.81,
    "verb after a place only": -0.93,
    "verb agrees": 0.51,
    "verb disagrees": -2.07,
    "verb missing": -0.12,
    "verb of saying": 1.65,
    "verb without a subject": -2.58,
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
