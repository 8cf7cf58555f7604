"""Turn sensor data and files into scenes: boxes in a known frame, seen from a known viewpoint."""
