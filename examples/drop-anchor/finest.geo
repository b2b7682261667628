// The same with elements of 18.75 mm at the tip. Mesh with: gmsh finest.geo -2 -o finest.msh
DefineConstant[ h = 0.01875 ];
Include "anchor.geo";
