"""Views of things, all that persons and lessons said of them, and the recogniser that is made from them."""
