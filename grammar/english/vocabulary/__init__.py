"""Words that the reader of English knows: closed classes, relation words, adjectives, verbs, special nouns."""
