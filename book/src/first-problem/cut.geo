// A vertical cut in clay, in plane strain. Lengths in m; z is up and 0 at the surface.
// Mesh with: gmsh cut.geo -3 -o cut.msh
H = 3;       // depth of the cut
behind = 6;  // ground behind the face, which is at x = 0
ahead = 4;   // width of the cut
below = 3;   // ground below the cut
slice = 0.5; // thickness that is computed
h = 0.5;     // size of elements

Point(1) = {-behind, 0, 0, h};
Point(2) = {-behind, 0, -H - below, h};
Point(3) = {ahead, 0, -H - below, h};
Point(4) = {ahead, 0, -H, h};
Point(5) = {0, 0, -H, h};
Point(6) = {0, 0, 0, h};
Point(7) = {ahead, 0, 0, h};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6}; // the face
Line(6) = {6, 1};
Line(7) = {4, 7};
Line(8) = {7, 6};

Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {-4, 7, 8, -5};
Plane Surface(2) = {2};

// Extruding gives the opposite surface, the volume, and a surface for each line of the loop.
ground[] = Extrude {0, slice, 0} { Surface{1}; Layers{1}; };
cut[] = Extrude {0, slice, 0} { Surface{2}; Layers{1}; };

Physical Volume("ground") = {ground[1]};
Physical Volume("cut") = {cut[1]};
Physical Surface("base") = {ground[3]};
Physical Surface("ends") = {ground[2], ground[4], cut[3]};
Physical Surface("front") = {1, 2};
Physical Surface("back") = {ground[0], cut[0]};
