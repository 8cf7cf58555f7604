"""Fit graded models of relation words and sizes to examples."""
