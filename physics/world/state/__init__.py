"""What a world consists of: its records in three blocks of memory, views of them, and courses."""
