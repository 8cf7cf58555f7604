"""Text and JSON of groundings and of comparisons of tables with layouts."""
