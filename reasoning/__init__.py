"""Pure inference over relation graphs: entailment, consistency, time, similarity and grounding. No input or output."""
