"""File formats other than scripts: calculi, constraint networks and fluents."""
