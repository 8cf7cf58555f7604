"""English as a second language of scripts: sentences to facts with their spans, and back."""
