"""SHACL validation of every write to semantic memory."""
