"""The shape of a zone for all bodies: surfaces to stand on, layers of cells, barriers."""
