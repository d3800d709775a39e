"""What was asked for, and where it is kept: settings and run folders."""
