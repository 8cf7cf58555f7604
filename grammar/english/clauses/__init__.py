"""Chunks as clauses: joints, plain word order, syntax trees and places."""
