"""The robot: one memory and one blackboard over time, on which it sees, is told and shown, learns and checks."""
