"""The grid that movement is checked against: clearances, lookups of cells, walking step by step."""
