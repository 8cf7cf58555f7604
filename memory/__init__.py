"""What is kept: semantic memory, perceptual memory and episodes. Nothing is kept yet; this room is still empty."""
