"""Reference code: films, plots, tests and the twins of the client use it, the server never."""
