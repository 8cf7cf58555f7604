"""Things on the table, and hands: models and their completion, particle filters, and fits to what is seen."""
