"""Which question to ask where a description leaves several groundings, and what an answer rules out."""
