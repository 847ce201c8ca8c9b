"""Where one kind of body may go: reachability, stability, regions, and wave fronts over them."""
