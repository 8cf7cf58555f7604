"""Text and JSON of answers about descriptions and words."""
