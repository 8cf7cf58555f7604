"""From text to a relation graph: the layout language, and everything that reads or writes it."""
