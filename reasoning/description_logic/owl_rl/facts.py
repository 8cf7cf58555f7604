"""Facts as indexed triples of integers, and joins of the patterns of a rule with them.

In a pattern, a number from 0 on is a term, and a negative one is a variable.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deixis.ontology.rdf.triple_index import TermIndex

Fact = tuple[int, int, int]
Atom = tuple[int, int, int]
Binding = dict[int, int]


class FactIndex(TermIndex[int]):
    """An index of facts that joins the patterns of a rule with them."""

    def __contains__(self, fact: Fact) -> bool:
        subject, predicate, obj = fact
        return obj in self.objects(subject, predicate)

    def matches(self, atom: Atom) -> Iterator[Fact]:
        """Yield the facts that match a pattern, in which each variable matches anything.

        Parameters
        ----------
        atom
            Pattern of three numbers; negative ones are variables.

        Yields
        ------
        tuple of int
            Fact as numbers of subject, predicate and object.
        """
        s, p, o = atom
        for predicate in (p,) if p >= 0 else tuple(self._objects):
            if predicate not in self._objects:
                continue
            if s >= 0 and o >= 0:
                if o in self._objects[predicate].get(s, ()):
                    yield s, predicate, o
            elif s >= 0:
                yield from ((s, predicate, y) for y in tuple(self._objects[predicate].get(s, ())))
            elif o >= 0:
                yield from ((x, predicate, o) for x in tuple(self._subjects[predicate].get(o, ())))
            else:
                yield from [(x, predicate, y) for x, ys in self._objects[predicate].items() for y in ys]

    def solutions(self, atoms: Sequence[Atom], binding: Binding, found: dict[Atom, Fact]) -> Iterator[Binding]:
        """Yield the bindings under which every pattern is a fact.

        Parameters
        ----------
        atoms
            Patterns; a variable has the same value in all of them.
        binding
            Values of variables that are known before.
        found
            Facts by pattern; it is changed in place, and has those of the binding that was yielded last.

        Yields
        ------
        dict
            Number by variable.
        """
        if not atoms:
            yield binding
            return
        atom = max(atoms, key=lambda a: sum(v >= 0 or v in binding for v in a))
        rest = [other for other in atoms if other is not atom]
        for fact in self.matches(substituted(atom, binding)):
            bound = unified(atom, fact, binding)
            if bound is not None:
                found[atom] = fact
                yield from self.solutions(rest, bound, found)


def substituted(atom: Atom, binding: Binding) -> Atom:
    """Return a pattern with its variables replaced by their values.

    Parameters
    ----------
    atom
        Pattern of three numbers; negative ones are variables.
    binding
        Number by variable.

    Returns
    -------
    tuple of int
        The pattern; variables without a value stay.
    """
    s, p, o = atom
    return binding.get(s, s), binding.get(p, p), binding.get(o, o)


def unified(atom: Atom, fact: Fact, binding: Binding) -> Binding | None:
    """Return the binding extended so that the pattern equals the fact, or None if that is impossible.

    Parameters
    ----------
    atom
        Pattern of three numbers; negative ones are variables.
    fact
        Numbers of subject, predicate and object.
    binding
        Number by variable, known before; it is not changed.

    Returns
    -------
    dict or None
        Number by variable.
    """
    bound = dict(binding)
    for want, have in zip(atom, fact, strict=True):
        if want >= 0:
            if want != have:
                return None
        elif bound.setdefault(want, have) != have:
            return None
    return bound


def copy_of(head: Atom, atom: Atom) -> Atom | None:
    """Return the conclusion from one fact as a copy of its parts: place 0, 1 or 2 of the fact as -1, -2 or -3.

    The result is None if matching the pattern needs more than its predicate and object.

    Parameters
    ----------
    head
        Pattern of the conclusion.
    atom
        Pattern of the only premise.

    Returns
    -------
    tuple of int or None
        Number or place of subject, predicate and object.
    """
    s, p, o = atom
    if s >= 0 or p < 0 or s == o:
        return None
    place = {s: -1, o: -3} if o < 0 else {s: -1}
    a, b, c = head
    return place.get(a, a), place.get(b, b), place.get(c, c)


def copied(copy: Atom, fact: Fact) -> Fact:
    """Return the fact that a copy makes from another fact.

    Parameters
    ----------
    copy
        Numbers and places from :func:`copy_of`.
    fact
        The fact that matches the premise.

    Returns
    -------
    tuple of int
        The conclusion.
    """
    a, b, c = copy
    return fact[~a] if a < 0 else a, fact[~b] if b < 0 else b, fact[~c] if c < 0 else c
