"""Layouts learned from several tables: the tables, counts over them, and the concept of a layout."""
