"""Learn lessons from groundings, and sizes and words from all lessons."""
