"""Code that several tests use: `from helpers.processes import run_program`."""
