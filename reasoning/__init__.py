"""Pure inference over relation graphs: calculi, what follows, similarity, assignment, grounding. No input or output."""
