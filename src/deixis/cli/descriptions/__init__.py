"""Commands on descriptions and words."""
