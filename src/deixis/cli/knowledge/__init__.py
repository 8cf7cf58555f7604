"""Commands on the memory, and queries."""
