"""What is kept: semantic memory, as RDF in named graphs that one process owns."""
