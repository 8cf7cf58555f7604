"""Follow the things on a table through a stream of clouds: where each thing is, since when, and which ones are gone."""
