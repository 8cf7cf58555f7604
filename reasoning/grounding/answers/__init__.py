"""The answer of a grounding: matches, alternatives, groups, interchangeable objects, and sensitivity to each fact."""
