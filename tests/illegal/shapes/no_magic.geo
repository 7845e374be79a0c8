NPoints 2
