"""The vocabulary of the project: the OWL TBox, relation words, kinds of things, and the relation graph.

This is the lowest package: it imports none of the others, and all others exchange its types.
"""
