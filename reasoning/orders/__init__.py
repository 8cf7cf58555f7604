"""Facts as orders between edges: closed by bit sets, searched where they leave a choice, explained by paths."""
