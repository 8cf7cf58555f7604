"""Open-ended learners of categories: each starts without any, and is taught and corrected one view at a time."""
