"""Answers as text for the terminal and as plain data for JSON."""
