#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until 0.5 --every 0.1s --contacts -o run.h5
nsd-cat --vtk all run.h5 >run.vtkhdf     # ParaView 6.1; grains instead of all: 5.12
nsd-export -o paraview/ run.h5           # any ParaView: open paraview/grains.pvd
nsd-export --last --part surfaces -o surfaces.vtp run.h5
grep -c '<DataSet ' paraview/grains.pvd
ls run.vtkhdf surfaces.vtp paraview/*.pvd
