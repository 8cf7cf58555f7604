"""Find which object of a scene a description refers to, with a probability for each object."""
