"""The shape of a zone, whatever the body: surfaces to stand on, layers of cells, barriers."""
