"""People: where they may go, and the risk of being near them."""
