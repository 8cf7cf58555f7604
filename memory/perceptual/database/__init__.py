"""The LevelDB of the perceptual memory: its folder and versions, keys and values, and the shared handle on it."""
