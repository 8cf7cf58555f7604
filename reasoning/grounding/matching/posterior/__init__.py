"""Probabilities of matches: sums over all maps, by enumeration, permanents, or Markov chains."""
