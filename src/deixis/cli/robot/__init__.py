"""Commands that run the robot, the demo and the experiments."""
