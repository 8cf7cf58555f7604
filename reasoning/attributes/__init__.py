"""Learn what new adjectives mean from the things that they were used of."""
