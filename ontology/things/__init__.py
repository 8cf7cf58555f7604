"""Things that people name: the taxonomy of kinds, with their usual sizes, and the colour terms."""
