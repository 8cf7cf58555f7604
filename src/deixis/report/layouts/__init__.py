"""Text and JSON of answers about layouts."""
