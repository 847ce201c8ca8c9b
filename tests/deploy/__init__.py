"""What is shipped to watch a world with other programs."""
