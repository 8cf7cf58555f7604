"""Evidence of what single things are like: their labels, sizes and colours."""
