"""Models learned from all lessons: relation words, and sizes of kinds of things."""
