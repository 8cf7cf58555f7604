"""The version of Deixis, for what it writes."""

VERSION = "0.1.0"
