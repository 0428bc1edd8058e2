MeshVersionFormatted 2
Dimension 3
SolAtVertices 1
3 1 2 3
0.5 1 2 3 1 0 1 0 0 1
SolAtTriangles
2
1 1
7
8
End
