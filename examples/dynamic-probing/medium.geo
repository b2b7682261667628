// The same ground with smaller elements at the cone. Mesh with: gmsh medium.geo -2 -o medium.msh
DefineConstant[ h = 0.009 ];
Include "probe.geo";
