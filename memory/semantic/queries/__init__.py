"""SPARQL over semantic memory: what is admitted, the answers, and the rdflib view."""
