MeshVersionFormatted 2
Dimension 2
SolAtVertices
2
1 3
1 0.5 2
1.D0 0 1e-9
End
