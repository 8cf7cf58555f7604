"""RDF terms and triples: the vocabulary of the project, literals, Skolem IRIs, and an index over triples."""
