"""Facts as English sentences, and paraphrases of what was read."""
