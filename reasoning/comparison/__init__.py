"""Compares a table with a layout: what is wrong with it, and which layout it is most like."""
