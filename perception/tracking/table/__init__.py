"""Table at rest: the reference with which each frame is compared, the outline of the table, and its colours."""
