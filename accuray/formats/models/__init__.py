"""Models: files that hold meshes with materials, and may hold cameras and lights; one module or package per format."""
