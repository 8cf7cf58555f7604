"""Scoreboard: every engine over the same generated tables and photographs, with intervals and paired tests."""
