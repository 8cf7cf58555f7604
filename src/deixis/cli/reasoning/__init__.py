"""Commands that reason."""
