"""What each command does, for Python and the command line alike: one module per verb."""
