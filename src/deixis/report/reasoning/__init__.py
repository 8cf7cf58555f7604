"""Text and JSON of answers about ontologies, constraint networks, time and activities."""
