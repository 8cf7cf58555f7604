"""Time: fluents whose ends are known within bounds, the simple temporal network under them, and their implications."""
