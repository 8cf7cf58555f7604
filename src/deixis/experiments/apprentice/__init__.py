"""The experiment of the apprentice: a robot is shown things and told layouts, and then checks further tables."""
