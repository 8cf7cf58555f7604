"""The words of a sentence as chunks: noun phrases, verb groups, prepositions and joints."""
