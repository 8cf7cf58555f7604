"""Point clouds and meshes: the types that perception works on, and readers and writers of their formats."""
