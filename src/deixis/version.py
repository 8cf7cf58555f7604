"""Version of Deixis, as it is recorded in files."""

VERSION = "0.2.0"
