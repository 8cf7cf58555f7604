"""Decide the consistency of a network by backtracking search over tractable relations, with learned nogoods."""
