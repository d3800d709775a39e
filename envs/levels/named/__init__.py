"""The named levels, as text files."""
