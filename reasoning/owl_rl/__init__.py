"""The rules of OWL 2 RL, applied to facts until nothing new follows."""
