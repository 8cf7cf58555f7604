"""Open-ended learning: a simulated teacher teaches learners kind after kind, until they learn no more."""
