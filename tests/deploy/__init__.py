"""Files that are shipped to watch a world with other programs."""
