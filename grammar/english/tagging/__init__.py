"""Decide the class of each word of a sentence: noun, verb, adjective, participle or function word."""
