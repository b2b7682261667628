// Soil column, z up. Mesh it with
//   gmsh -3 column.geo -o column.msh
// The column.msh beside this file was made so by Gmsh 4.15.2.

width = 0.1;  // m
height = 1;   // m
size = 0.05;  // element edge, m

SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, width, width, height};

// A box's faces come as x-min, x-max, y-min, y-max, z-min, z-max.
Physical Volume("soil") = {1};
Physical Surface("x-min") = {1};
Physical Surface("x-max") = {2};
Physical Surface("y-min") = {3};
Physical Surface("y-max") = {4};
Physical Surface("bottom") = {5};
Physical Surface("top") = {6};

Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
// The smallest altitude, which sets the time step, comes out as 0.0175 m. MeshAdapt (1) gives
// 0.0198 m, but puts most nodes on a regular grid.
Mesh.Algorithm = 6;    // front-Delaunay on the faces
Mesh.Algorithm3D = 10; // HXT, a Delaunay method, inside
Mesh.Optimize = 1;
Mesh.MaxNumThreads1D = 1; // the same mesh on every machine
Mesh.MaxNumThreads2D = 1;
Mesh.MaxNumThreads3D = 1;
Mesh.MshFileVersion = 4.1;
