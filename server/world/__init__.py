"""The simulated zone: state, movement, interest and views. No event loop, no sockets, no clock."""
