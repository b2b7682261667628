// Half of a circular tunnel whose face is supported: ground, lined bore behind the face, room above
// the ground. Lengths in m; x across from the plane of symmetry, y along, away from the bore, z up,
// 0 at the ground's surface. Mesh with: gmsh tunnel.geo -3 -o tunnel.msh
SetFactory("OpenCASCADE");
DefineConstant[ face = 1.2, far = 6 ]; // size of elements at the face and far away
D = 10;        // diameter
cover = 10;    // of soil above the crown
bore = 3 * D;  // length of the lined bore behind the face
ahead = 25;    // ground ahead of the face
aside = 30;    // ground beside the plane of symmetry
below = 6;     // ground below the invert
over = 1.5;    // empty room above the surface, where soil may rise

axis = -(cover + D / 2);
base = axis - D / 2 - below;

Box(1) = {0, -bore, base, aside, bore + ahead, -base};
Box(2) = {0, -bore, 0, aside, bore + ahead, over};
Cylinder(3) = {0, -bore, axis, 0, bore, 0, D / 2, 2 * Pi};
half() = BooleanIntersection{ Volume{3}; Delete; }{ Volume{1}; };
parts() = BooleanFragments{ Volume{1, 2}; Delete; }{ Volume{half()}; Delete; };

e = 1e-3;
bore_() = Volume In BoundingBox{-e, -bore - e, axis - D / 2 - e, D / 2 + e, e, axis + D / 2 + e};
room_() = Volume In BoundingBox{-e, -bore - e, -e, aside + e, ahead + e, over + e};
soil_() = Volume{:};
soil_() -= bore_();
soil_() -= room_();
Physical Volume("soil") = {soil_()};
Physical Volume("bore") = {bore_()};
Physical Volume("room") = {room_()};

face_() = Surface In BoundingBox{-e, -e, axis - D / 2 - e, D / 2 + e, e, axis + D / 2 + e};
end_() = Surface In BoundingBox{-e, -bore - e, axis - D / 2 - e, D / 2 + e, -bore + e, axis + D / 2 + e};
all_() = Boundary{ Volume{bore_()}; };
middle_() = Surface In BoundingBox{-e, -bore - e, axis - D / 2 - e, e, e, axis + D / 2 + e};
lining_() = Abs(all_());
lining_() -= face_();
lining_() -= end_();
lining_() -= middle_();
Physical Surface("face") = {face_()};
Physical Surface("wall") = {end_()};
Physical Surface("lining") = {lining_()};
Physical Surface("symmetry") = {Surface In BoundingBox{-e, -bore - e, base - e, e, ahead + e, over + e}};
Physical Surface("base") = {Surface In BoundingBox{-e, -bore - e, base - e, aside + e, ahead + e, base + e}};
side_() = {Surface In BoundingBox{aside - e, -bore - e, base - e, aside + e, ahead + e, over + e}};
back_() = {Surface In BoundingBox{-e, -bore - e, base - e, aside + e, -bore + e, over + e}};
back_() -= end_();
front_() = {Surface In BoundingBox{-e, ahead - e, base - e, aside + e, ahead + e, over + e}};
Physical Surface("sides") = {side_(), back_(), front_()};
Physical Surface("surface") = {Surface In BoundingBox{-e, -bore - e, -e, aside + e, ahead + e, e}};

// Fine where soil moves: ahead of the face and above it up to the surface, and in the bore, which
// costs nothing while it is empty.
Field[1] = Box;
Field[1].VIn = face; Field[1].VOut = far;
Field[1].XMin = 0; Field[1].XMax = 0.8 * D;
Field[1].YMin = -0.5 * D; Field[1].YMax = 1.3 * D;
Field[1].ZMin = axis - 0.5 * D; Field[1].ZMax = over;
Field[1].Thickness = D;
Field[2] = Constant;
Field[2].VIn = 1.2 * face; Field[2].VOut = far;
Field[2].VolumesList = {bore_()};
Field[2].IncludeBoundary = 1;
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Background Field = 3;
General.NumThreads = 1; // the same mesh each time
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Algorithm3D = 10; // HXT: its shortest altitudes are the longest
Mesh.OptimizeThreshold = 0.6;
Mesh.Optimize = 1;
Mesh.OptimizeNetgen = 1;
