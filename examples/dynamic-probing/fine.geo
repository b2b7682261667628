// The same ground with elements of 4.5 mm at the cone. Mesh with: gmsh fine.geo -2 -o fine.msh
DefineConstant[ h = 0.0045 ];
Include "probe.geo";
