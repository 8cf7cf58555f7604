"""Find which thing a person points at, from the joints of the body."""
