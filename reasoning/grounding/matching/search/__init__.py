"""Search for the best map: exact by branch and bound, and scalable by belief propagation and local search."""
