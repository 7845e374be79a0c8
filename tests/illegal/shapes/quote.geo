PGEOMETRY V5
NPoints 2 NPrims 0
NPointGroups 0 NPrimGroups 0
NPointAttrib 1 NVertexAttrib 0 NPrimAttrib 0 NAttrib 0
PointAttrib
name 1 index 1 "open
