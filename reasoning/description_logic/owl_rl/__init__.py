"""OWL 2 RL: rules, facts and data values, and the materialisation of all that follows, with derivations."""
