"""Tables of numbers in files: compiled parsers, and the clouds that named columns make."""
