"""Looks at the whole table: what is on it at first, and corrections by further looks."""
