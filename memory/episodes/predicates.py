"""Predicates of the situations that a robot's modules write to the blackboard, and that questions are answered from."""

from __future__ import annotations

AT, IS_A, SAID, POINTED_AT = "at", "isA", "said", "pointedAt"
"""Predicates of situations: the box of a thing, its category, what a person said, and what a person pointed at."""

CALLED, NOT_CALLED = "called", "notCalled"
"""Predicates of the names that a person gives to a tracked thing, and of those that the person denies."""

NAMED = frozenset({IS_A, CALLED})
"""Predicates of the statements with which a person shows a thing."""

EXPECTED, SAME_AS, CONTRADICTED = "expected", "sameAs", "contradicted"
"""Predicates of objects that a person said are there: the words, the thing that it turned out to be, and the reason why
it is no longer expected."""

PUT, MOVED, TOOK = "put", "moved", "took"
"""Predicates of what a person did: put a new thing down, moved a thing to another place, and took a thing away."""

LAYOUT, FAULT = "layout", "fault"
"""Predicates of what a robot concludes about the table: the name of its layout, and a mistake in words."""

SAYS = "says"
"""Predicate of what the robot says."""

ACTS = frozenset({PUT, MOVED, TOOK})
"""Predicates whose subject is the person who changed the place of the object."""
