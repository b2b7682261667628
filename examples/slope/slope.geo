// A slope of 2:1 in plane strain, with empty elements where the soil may flow.
// Lengths in m; z is up. Mesh with: gmsh slope.geo -3 -o slope.msh
H = 5;          // height of the slope
crest = 6;      // width of the crest
under = 2.5;    // depth of the ground below the toe
room = 12;      // length beyond the toe
over = 1;       // empty elements above the crest
width = 0.5;    // of the slice that is computed
h = 0.5;        // size of elements

toe = crest + 2 * H;
end = toe + room;

Point(1) = {0, 0, -under, h};
Point(2) = {end, 0, -under, h};
Point(3) = {end, 0, 0, h};
Point(4) = {toe, 0, 0, h};
Point(5) = {crest, 0, H, h};
Point(6) = {0, 0, H, h};
Point(7) = {0, 0, H + over, h};
Point(8) = {crest, 0, H + over, h};
Point(9) = {end, 0, 0.6 * H, h};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {6, 7};
Line(8) = {7, 8};
Line(9) = {8, 9};
Line(10) = {9, 3};

Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {-5, -4, -3, -10, -9, -8, -7};
Plane Surface(2) = {2};

soil[] = Extrude {0, width, 0} { Surface{1}; Layers{1}; };
air[] = Extrude {0, width, 0} { Surface{2}; Layers{1}; };

Physical Volume("soil") = {soil[1]};
Physical Volume("room") = {air[1]};
Physical Surface("base") = {soil[2]};
Physical Surface("ends") = {soil[3], soil[7], air[5], air[8]};
Physical Surface("front") = {1, 2};
Physical Surface("back") = {soil[0], air[0]};
