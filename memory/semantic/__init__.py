"""Semantic memory: RDF in named graphs that one process owns."""
