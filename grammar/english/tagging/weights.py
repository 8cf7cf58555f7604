"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations

_AFTER = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective                 -       2.22       0.99      -2.81      -1.52      -2.62       1.50       1.01      -0.48
be                    -1.95      -1.80       0.59      -1.89       1.81       2.78          -       0.32      -0.13
by                    -1.54          -      -0.45      -0.70          -       2.24          -       0.12      -0.12
determiner             2.63       3.02      -1.46      -2.40          -      -2.72      -1.07      -0.70       0.25
ing                   -0.83       1.48          -      -1.09       0.08       0.88      -0.49          -      -0.26
joint                 -0.09      -0.84      -0.60      -0.11       2.78       0.45       0.72      -0.05       0.42
modal                 -1.48      -1.00          -       1.46      -0.63      -0.74      -0.71       1.13       0.29
noun                      -      -0.85       1.38      -0.69       1.03       0.56       1.30      -1.40      -0.16
of                     1.30       1.09      -0.27      -1.58          -          -          -      -1.36      -0.31
participle             2.15      -0.46       0.36      -1.09      -0.32       1.42          -      -0.24       1.85
place                  0.52          -          -      -0.52          -          -          -          -          -
preposition           -0.66          -      -1.31      -2.21       1.55          -       0.91      -0.48      -1.32
pronoun               -2.84      -1.83       2.89       0.20       0.45       0.89       1.86      -0.50       0.48
relative              -0.47      -0.57       1.28       0.20       0.42          -       0.26       1.16       0.06
start                  0.18          -      -2.79       0.26       0.92       0.58       0.79      -0.65      -0.37
subordinate            0.31      -0.72      -0.34      -0.46      -0.08       1.36       0.64       1.22       0.48
to                    -1.01       0.09       2.13       0.76       0.39          -          -      -0.10      -0.08
verb                  -1.31      -1.06          -       0.55       0.57      -0.57      -0.22       1.20          -
"""
"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""

_BEFORE = """
                       noun  adjective     finite       base participle        ing      modal determiner    pronoun
adjective              0.13      -2.76       0.82      -0.28       2.62      -0.54       1.19      -0.43       0.49
adverb                -0.81      -1.27       0.39      -0.35       0.09       1.74       1.52      -0.40       0.39
be                     0.65       1.07      -2.41      -0.54      -0.68      -2.13       2.37      -1.56       1.06
colon                  2.01       1.09      -2.06      -1.52      -1.01       1.32      -0.45      -0.14       0.66
determiner            -0.90      -0.60       1.61       0.78       1.58          -       0.41      -0.46      -0.24
digits                 1.68          -       0.26      -1.31      -0.44          -          -          -          -
end                    0.89       1.45      -0.11      -1.16      -0.48       1.28      -0.61      -1.36       1.29
joint                  0.89       1.60          -      -0.89      -0.15       1.13      -1.09      -1.18       1.31
of                     1.69       1.10      -1.12      -1.58      -1.66      -0.65      -0.88       0.19      -0.47
participle             0.07          -      -0.28       0.12      -0.15      -0.46          -       0.73      -0.73
place                 -0.86       0.73       1.28      -0.55       0.94       1.08      -0.75      -1.65       0.47
pronoun               -0.38       1.37       3.04      -0.99      -0.30      -0.32       1.72      -0.06      -0.07
relative               0.43       0.33      -0.44       0.27       0.94      -0.32          -          -          -
there                 -0.62       0.09       0.29       0.17          -       0.94          -       0.99       1.00
to                        -       0.09       1.08      -1.03       0.75       0.77          -          -          -
verb or noun           0.75      -1.57      -1.91       0.25       1.40      -1.50       0.92      -0.21      -0.79
word                   0.33      -1.81      -0.64      -0.41       2.16      -0.07      -0.28       0.11      -1.18
"""
"""Class of a word (columns) before the kind of the word after it (rows)."""

_SINGLE = {
    "-ing before a known noun": -1.52,
    "-ing before a name": 1.93,
    "-ing before an unknown noun": 0.10,
    "-ing of a known noun": 1.15,
    "-ing of a verb": 1.29,
    "acronym": 0.87,
    "capital within a sentence": 1.47,
    "command before adjective": 0.90,
    "command before adverb": -0.38,
    "command before be": -1.51,
    "command before colon": -2.12,
    "command before determiner": 1.39,
    "command before digits": -1.01,
    "command before joint": -2.89,
    "command before of": -1.65,
    "command before participle": -0.53,
    "command before place": -0.45,
    "command before pronoun": 1.46,
    "command before relative": 1.04,
    "command before there": 1.07,
    "command before to": 0.09,
    "command before verb or noun": 0.91,
    "command before word": -0.38,
    "command like a thing": 0.38,
    "command like a thing without an object": -0.61,
    "command with an object and a place": 2.30,
    "command, comma within a command": -1.32,
    "command, comma within a command, after a subject": -1.79,
    "command, comma within a open": 1.73,
    "command, comma within a open, after a subject": -1.28,
    "command, comma within a statement": -0.81,
    "command, comma within a statement, after a subject": -0.63,
    "command, conjunction within a command": 0.89,
    "command, conjunction within a command, after a subject": 0.47,
    "command, conjunction within a open": 1.35,
    "command, conjunction within a open, after a subject": -0.96,
    "command, conjunction within a statement": -0.38,
    "command, conjunction within a statement, after a subject": 0.61,
    "command, start": 0.26,
    "command, subordinate": -0.46,
    "find": 1.09,
    "finite verb after a joint, within a command": 0.64,
    "finite verb after a joint, within a open": -0.54,
    "finite verb after a joint, within a statement": -0.98,
    "finite verb after a modal verb": -0.48,
    "form in -s": 0.94,
    "form in -s of a known noun": 0.07,
    "hardly a noun": 2.75,
    "infinitive": 0.91,
    "infinitive missing": -0.85,
    "known compound begins": 3.36,
    "known compound ends": 3.16,
    "known noun in -ing": -2.63,
    "left over": 0.78,
    "modal can": -0.34,
    "modal may": 1.95,
    "modal might": 1.52,
    "modal need": 1.53,
    "modal will": 1.29,
    "never a plural": 3.12,
    "noun after a plural": -3.03,
    "object after a transitive verb": 0.76,
    "participle like its base": -1.50,
    "participle of a verb": 2.52,
    "past like a noun": 0.76,
    "past of a known noun": 0.69,
    "past of a verb": 1.60,
    "place after a verb of place": 0.62,
    "place after another verb": -1.61,
    "plain form": 1.44,
    "plain form of a known noun": 0.16,
    "plural after a determiner of one": -2.34,
    "plural after a number": 2.21,
    "put": 1.32,
    "rather a noun": -1.16,
    "rather a plural": -1.50,
    "second verb of a clause": -2.28,
    "singular after a number": -1.81,
    "that": 0.61,
    "unknown in -ed": 2.15,
    "unknown in -ing": 0.07,
    "unknown in -s": -3.08,
    "unknown plain form": -3.49,
    "unknown verb before adjective": -1.00,
    "unknown verb before adverb": -1.70,
    "unknown verb before be": -1.06,
    "unknown verb before colon": -0.65,
    "unknown verb before determiner": -1.37,
    "unknown verb before digits": -0.71,
    "unknown verb before end": -0.91,
    "unknown verb before joint": -0.74,
    "unknown verb before of": -1.01,
    "unknown verb before participle": -0.62,
    "unknown verb before place": -0.95,
    "unknown verb before pronoun": -0.66,
    "unknown verb before relative": -0.73,
    "unknown verb before there": -0.33,
    "unknown verb before to": 0.26,
    "unknown verb before verb or noun": -0.75,
    "unknown verb before word": -1.67,
    "verb after a place only": -0.86,
    "verb agrees": 0.45,
    "verb disagrees": -2.22,
    "verb missing": -0.27,
    "verb of saying": 1.48,
    "verb without a subject": -2.35,
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
