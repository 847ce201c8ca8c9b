"""A link joins a zone and the servers of its viewers: inputs go up, frames come down."""
