"""OWL ontologies: their axioms, what follows from them and why, in words and as triples."""
