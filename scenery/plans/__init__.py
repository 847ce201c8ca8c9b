"""Plans of other programs as scenes: WKT, GeoJSON, JuPedSim geometry, ROS maps, DXF."""
