// The same with elements of 37.5 mm at the tip. Mesh with: gmsh fine.geo -2 -o fine.msh
DefineConstant[ h = 0.0375 ];
Include "anchor.geo";
