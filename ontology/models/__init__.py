"""Learned models as data: graded relation words and sizes, to and from triples."""
