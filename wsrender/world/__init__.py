"""The geometry of what stands around a robot: distances to shapes, and shapes as triangles."""
