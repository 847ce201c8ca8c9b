"""What joins a zone and those who serve its viewers: inputs go up, frames come down."""
