"""File formats that are not scripts: constraint networks and fluents."""
