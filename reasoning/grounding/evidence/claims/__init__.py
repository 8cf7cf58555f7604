"""Evidence of claims: places, sizes, orders, distances, arrangements and directions."""
