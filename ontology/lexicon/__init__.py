"""Everyday nouns and adjectives: synonyms, kinds, usual sizes, and how well a noun fits a label."""
