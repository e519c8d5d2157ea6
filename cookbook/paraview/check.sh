#!/usr/bin/env bash
[ "$(grep -c '<DataSet ' paraview/grains.pvd)" = 5 ] && h5ls run.vtkhdf/VTKHDF >/dev/null && [ -s surfaces.vtp ]
