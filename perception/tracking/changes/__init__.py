"""Changes of a table in a frame: what rests, moves or is in a hand, what arrives, and which thing a pixel shows."""
