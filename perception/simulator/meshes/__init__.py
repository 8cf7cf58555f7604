"""Meshes of tableware by kind and size, made from solids of revolution and sheets, and ray casting against them."""
