"""Rewrite the chunks of a sentence as plain clauses, in stages."""
