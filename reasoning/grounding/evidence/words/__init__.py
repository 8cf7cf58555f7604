"""Meanings of relation words: features of a pair of boxes, and the degree to which a word describes the pair."""
