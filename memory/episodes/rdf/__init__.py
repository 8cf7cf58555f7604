"""Fluents as RDF, and the check of changes by SHACL."""
