"""The ground that one kind of body may walk on: reachability, stability, regions, and waves."""
