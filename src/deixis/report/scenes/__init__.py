"""Text and JSON of answers about scenes."""
