// The same ground with elements half as large at the cone. Mesh with: gmsh fine.geo -2 -o fine.msh
DefineConstant[ h = 0.0045 ];
Include "probe.geo";
