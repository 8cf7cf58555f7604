"""Questions about then and now, in English: where things were, what was taken away, what was shown first."""
