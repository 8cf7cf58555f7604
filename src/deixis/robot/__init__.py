"""The robot: one memory and one blackboard over time. It sees, hears, learns and checks tables."""
