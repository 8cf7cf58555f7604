"""SPARQL over semantic memory: checks of queries, their execution, answers, and the rdflib view."""
