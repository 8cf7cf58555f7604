"""Point clouds: the type that perception works on, and every format that it is read from."""
