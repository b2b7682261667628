// The same ground with elements of 0.6 m at the face. Mesh with: gmsh fine.geo -3 -o fine.msh
DefineConstant[ face = 0.6 ];
Include "tunnel.geo";
