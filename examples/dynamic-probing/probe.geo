// A light dynamic probe, its cone just in the ground: half a meridian plane, which the scene revolves.
// Lengths in m; x is the radius, z up, 0 at the ground's surface, where the cone's shoulder is.
// Mesh with: gmsh probe.geo -2 -o probe.msh
DefineConstant[ h = 0.013 ]; // size of elements at the cone
D = 0.0357;        // diameter, of the cone and of the rod
apex = 90;         // angle of the cone, degrees: assumed, the standard light probe's
long = 1;          // length of the rod: assumed
near = 2 * D;      // radius of the ground that goes with the cone, about its tip
far = 15 * D;      // radius of the ground
deep = 30 * D;     // depth of the ground: the probe goes down by about a third of it

R = D / 2;
tip = -R / Tan(apex * Pi / 360);

// Meridian of the probe.
Point(1) = {0, 0, tip};
Point(2) = {R, 0, 0};
Point(3) = {R, 0, long};
Point(4) = {0, 0, long};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
// The moving zone, round below so that the mesh is not flattened at an edge.
side = Sqrt(near * near - tip * tip);
Point(10) = {0, 0, tip - near};
Point(11) = {side, 0, 0};
Line(10) = {1, 10};
Circle(11) = {10, 1, 11};
Line(12) = {11, 2};
// What is stretched: ground, and beside the rod room for the ground that comes up.
Point(20) = {0, 0, -deep};
Point(21) = {far, 0, -deep};
Point(22) = {far, 0, 0};
Point(23) = {far, 0, long};
Line(20) = {10, 20};
Line(21) = {20, 21};
Line(22) = {21, 22};
Line(23) = {22, 23};
Line(24) = {23, 3};
Line(25) = {11, 22};

Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {10, 11, 12, -1};
Curve Loop(3) = {20, 21, 22, -25, -11};
Curve Loop(4) = {25, 23, 24, -2, -12};
For k In {1:4}
  Plane Surface(k) = {k};
EndFor

// Fine at the cone. Downwards, where soil comes from, elements grow slowly. Inside the probe they need
// not be fine. The first ones at the axis are larger: they are thin wedges, which make for small steps.
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (1 + 0.6 * max(0, 1 - x / %g)) + 0.04 * max(0, -z - %g) + 0.2 * max(0, x - %g) + 0.04 * max(0, z)", h, 1.5 * h, 2 * R, 1.5 * R);
Field[2] = MathEval;
Field[2].F = "0.1";
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Field[4] = Restrict;
Field[4].InField = 3;
Field[4].SurfacesList = {2, 3, 4};
Field[5] = MathEval;
Field[5].F = Sprintf("%g + 0.04 * max(0, z)", Min(2 * h, R));
Field[6] = Restrict;
Field[6].InField = 5;
Field[6].SurfacesList = {1};
Field[6].CurvesList = {3, 4};
Field[6].IncludeBoundary = 0;
Field[7] = Min;
Field[7].FieldsList = {4, 6};
Background Field = 7;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Algorithm = 6;
General.NumThreads = 1; // the same mesh each time

Physical Surface("cone") = {1};
Physical Surface("near-soil") = {2};
Physical Surface("far-soil") = {3};
Physical Surface("room") = {4};
Physical Curve("tip") = {1};
Physical Curve("shaft") = {2};
Physical Curve("head") = {3};
Physical Curve("bottom") = {21};
Physical Curve("r-max") = {22, 23};
