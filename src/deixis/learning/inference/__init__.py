"""Inference from learned layouts: statements about them that follow without being stated, as triples."""
