"""From what is seen to a scene: boxes in a stated frame, seen from a stated viewpoint."""
