"""Text and JSON of answers from the memory."""
