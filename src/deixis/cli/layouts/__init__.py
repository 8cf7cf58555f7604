"""Commands on layouts."""
