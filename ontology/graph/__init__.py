"""The relation graph: facts and claims, what a script or a scene makes of them, and its export."""
