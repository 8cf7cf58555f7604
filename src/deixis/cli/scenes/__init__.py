"""Commands on scenes and perception."""
