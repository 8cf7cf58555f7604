"""Commands that ground and check."""
