"""From facts to a picture: boxes that satisfy every fact, or the proof that there are none."""
