// The same as fine.geo with a blunt tip, 0.5 D long. Mesh with: gmsh blunt.geo -2 -o blunt.msh
DefineConstant[ h = 0.0375 ];
DefineConstant[ tip = 0.5 ];
Include "anchor.geo";
