"""SHACL guards every write to semantic memory."""
