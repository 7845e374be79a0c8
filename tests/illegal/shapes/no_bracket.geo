PGEOMETRY V5
NPoints 2 NPrims 0
NPointGroups 0 NPrimGroups 0
NPointAttrib 1 NVertexAttrib 0 NPrimAttrib 0 NAttrib 0
PointAttrib
width 1 float 1
0 0 0 1 1
0 0 0 1 1
