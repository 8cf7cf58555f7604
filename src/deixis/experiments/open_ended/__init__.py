"""Open-ended learning: learners are taught kind after kind by a simulated teacher, until they learn no more."""
