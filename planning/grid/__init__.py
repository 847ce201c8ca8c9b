"""The grid that movement is checked against: clearances, cells of points, walking bodies."""
