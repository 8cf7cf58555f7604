"""Clauses as facts: which things they are about, and what each clause commits the writer to."""
