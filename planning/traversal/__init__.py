"""Where one kind of body may go: links it can follow, edges it must respect, regions, waves."""
