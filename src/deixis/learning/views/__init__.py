"""Views of things, all that persons and lessons said about them, and the recogniser that is made from them."""
