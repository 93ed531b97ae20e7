#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Files of other programs: legacy VTK and VTU with names of their own, no spacing, no case.
. "$(dirname "$0")/common.sh"
# A block of water 1 x 1 x 0.5 m, dp = 0.1 m, as another SPH program writes it.
awk 'BEGIN{n=500; print "# vtk DataFile Version 3.0\nfluid\nASCII\nDATASET POLYDATA\nPOINTS " n " float";
  for(k=0;k<5;k++)for(j=0;j<10;j++)for(i=0;i<10;i++)printf "%g %g %g\n",0.05+0.1*i,0.05+0.1*j,0.05+0.1*k;
  print "POINT_DATA " n "\nVECTORS Vel float"; for(i=0;i<n;i++)print "2 0 0";
  print "SCALARS Rhop float 1\nLOOKUP_TABLE default"; for(i=0;i<n;i++)print 1000}' >f.vtk
awk 'BEGIN{n=500; print "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"" n "\" NumberOfCells=\"" n "\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">";
  for(k=0;k<5;k++)for(j=0;j<10;j++)for(i=0;i<10;i++)printf "%g %g %g\n",0.05+0.1*i,0.05+0.1*j,0.05+0.1*k;
  print "</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">"; for(i=0;i<n;i++)print i;
  print "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">"; for(i=1;i<=n;i++)print i;
  print "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">"; for(i=0;i<n;i++)print 1;
  print "</DataArray></Cells><PointData><DataArray type=\"Float32\" Name=\"Vel\" NumberOfComponents=\"3\" format=\"ascii\">"; for(i=0;i<n;i++)print "2 0 0";
  print "</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>"}' >f.vtu

for file in f.vtk f.vtu; do
  check "$file, energy" 0 "$ANALYZE" energy $file --field velocity=Vel --dp 0.1
  near "$(column out 'water_kinetic[J]')" 1000 1e-3 "$file: kinetic energy, 500 kg at 2 m/s"
  check "$file, gauge" 0 "$ANALYZE" gauge $file --field velocity=Vel --dp 0.1 --at a=0.52,0.48
  near "$(column out 'level[m]')" 0.5 0.01 "$file: level"
  check "$file, run-up" 0 "$ANALYZE" runup $file --dp 0.1 --still-water 0.3
  near "$(column out 'run_up[m]')" 0.2 1e-6 "$file: run-up above 0.3 m"
  check "$file without --dp" 3 "$ANALYZE" gauge $file --at a=0.5,0.5
  says err "--dp"
  check "$file without --still-water" 3 "$ANALYZE" runup $file --dp 0.1
  says err "--still-water"
done
check "several files" 0 "$ANALYZE" front f.vtk f.vtu --dp 0.1 --frame-interval 0.5
[ "$(column out 't[s]' | tr '\n' ' ')" = "0 0.5 " ] || fail "times of several files: $(column out 't[s]' | tr '\n' ' ')"
finish
