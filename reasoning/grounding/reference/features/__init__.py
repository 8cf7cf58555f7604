"""Features of objects for the words of a description: nouns, properties and relations in a room."""
