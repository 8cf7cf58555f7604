"""The experiment of the apprentice: a robot learns things and layouts from a teacher, and checks further tables."""
