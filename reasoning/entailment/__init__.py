"""Entailment: what a script implies, why, why not, and its contradictions."""
