// A torpedo anchor above the seabed: half a meridian plane, which the scene revolves.
// Lengths in m; x is the radius, z up, 0 at the seabed, where the tip is.
// Mesh with: gmsh anchor.geo -2 -o anchor.msh
DefineConstant[ h = 0.075 ]; // size of elements at the tip
D = 0.30;          // diameter
long = 10 * D;     // length of the anchor
DefineConstant[ tip = 1.5 ]; // length of the ellipsoidal tip over D
near = 2 * D;      // radius of the zone that goes with the anchor, and its depth below the tip
far = 12 * D;      // radius of the ground
deep = 25 * D;     // depth of the ground

R = D / 2;
t = tip * D;
top = long + D;

// Meridian of the anchor.
Point(1) = {0, 0, 0};
Point(2) = {R, 0, t};
Point(3) = {R, 0, long};
Point(4) = {0, 0, long};
Point(5) = {0, 0, t};
Ellipse(1) = {1, 5, t > R ? 1 : 2, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
// The moving zone: ground below the seabed, room above it.
Point(10) = {0, 0, -near};
Point(12) = {near, 0, 0};
Point(13) = {near, 0, top};
Point(14) = {0, 0, top};
Line(10) = {1, 10};
Circle(11) = {10, 1, 12};
Line(13) = {12, 13};
Line(14) = {13, 14};
Line(15) = {14, 4};
Line(16) = {1, 12};
// What is stretched.
Point(20) = {0, 0, -deep};
Point(21) = {far, 0, -deep};
Point(22) = {far, 0, 0};
Point(23) = {far, 0, top};
Line(20) = {10, 20};
Line(21) = {20, 21};
Line(22) = {21, 22};
Line(23) = {22, 23};
Line(24) = {23, 13};
Line(25) = {12, 22};

Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {10, 11, -16};
Curve Loop(3) = {16, 13, 14, 15, -3, -2, -1};
Curve Loop(4) = {20, 21, 22, -25, -11};
Curve Loop(5) = {25, 23, 24, -13};
For k In {1:5}
  Plane Surface(k) = {k};
EndFor

// Fine at the tip. Downwards, where soil comes from, elements grow slowly.
Field[1] = MathEval;
Field[1].F = Sprintf("%g + 0.04 * max(0, -z - %g) + 0.12 * max(0, sqrt(x*x+y*y) - %g) + 0.03 * max(0, z - %g)", h, D, D, t);
Field[2] = MathEval;
Field[2].F = "0.4";
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Background Field = 3;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Algorithm = 6;
General.NumThreads = 1; // the same mesh each time

Physical Surface("anchor") = {1};
Physical Surface("near-soil") = {2};
Physical Surface("near-room") = {3};
Physical Surface("far-soil") = {4};
Physical Surface("far-room") = {5};
Physical Curve("tip") = {1};
Physical Curve("shaft") = {2};
Physical Curve("head") = {3};
Physical Curve("bottom") = {21};
Physical Curve("r-max") = {22, 23};
