"""Ordered stores of keys and values, in memory and in a LevelDB on disk, and an index of intervals in them."""
