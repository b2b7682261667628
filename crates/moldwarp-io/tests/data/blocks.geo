// Two touching blocks, the fixture of the Gmsh reader. Each of the four files beside it is
//   gmsh -3 blocks.geo -format msh22|msh41 [-bin] -o blocks-22|41-ascii|binary.msh

SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 0.5, 1, 1};
Coherence;

Physical Volume("soft clay", 10) = {1};
Physical Volume("Kies ø", 20) = {2};
Physical Surface("x-min", 1) = {1};
Physical Surface("between", 2) = {2};
Physical Surface("also x-min", 7) = {1};
Physical Surface(9) = {-7}; // no name, turned round: its triangles are written with the sign
Physical Curve("edge") = {1};
Physical Point("corner") = {1};

Mesh.MeshSizeMin = 0.6;
Mesh.MeshSizeMax = 0.6;
