"""The live robot: what happens before it as a story, its senses, and what it learns from them, on one blackboard."""
