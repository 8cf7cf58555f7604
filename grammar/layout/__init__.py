"""The layout language: its words, parser, error messages and canonical form."""
