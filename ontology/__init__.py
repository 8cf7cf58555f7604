"""What can be said: the OWL TBox, the names of relations and kinds of things, and the relation graph.

This is the lowest room. It knows no other one, and every other one meets in its types.
"""
