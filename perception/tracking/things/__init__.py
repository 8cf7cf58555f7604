"""Things on the table: their models, particle filters, likeness, and fits to what is seen."""
