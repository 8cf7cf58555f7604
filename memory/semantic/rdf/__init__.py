"""RDF in the semantic store: named graphs, contributions of lessons, changes, packaged triples and files."""
