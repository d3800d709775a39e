"""What each moving body does next, and which of them is first."""
