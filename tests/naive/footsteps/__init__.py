"""Steps that begin in a tick, whole arrays at a time; tests hold the kernels to them."""
