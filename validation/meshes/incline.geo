// A base and the room above it for a block that slides along it. Lengths in m.
// Mesh with: gmsh incline.geo -3 -o incline.msh
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.1 ]; // size of elements
length = 2.1;
width = 0.2;
base = 0.1;
height = 0.4;
Box(1) = {0, 0, 0, length, width, base};
Box(2) = {0, 0, base, length, width, height - base};
BooleanFragments{ Volume{1, 2}; Delete; }{}
e = 1e-6;
Physical Volume("base") = {1};
Physical Volume("room") = {2};
Physical Surface("x-min") = {Surface In BoundingBox{-e, -e, -e, e, width + e, height + e}};
Physical Surface("x-max") = {Surface In BoundingBox{length - e, -e, -e, length + e, width + e, height + e}};
Physical Surface("y-min") = {Surface In BoundingBox{-e, -e, -e, length + e, e, height + e}};
Physical Surface("y-max") = {Surface In BoundingBox{-e, width - e, -e, length + e, width + e, height + e}};
Physical Surface("z-min") = {Surface In BoundingBox{-e, -e, -e, length + e, width + e, e}};
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
Mesh.Algorithm3D = 10; // HXT
Mesh.OptimizeThreshold = 0.6;
Mesh.Optimize = 1;
Mesh.OptimizeNetgen = 1;
General.NumThreads = 1; // the same mesh each time
