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
# Binary legacy VTK with the names and the big-endian order of DualSPHysics' PartVTK, and VTP as ParaView saves it (appended, base64)
# with the names of SPHinXsys.
python3 - <<'END'
import base64, struct
n = 500
points = [c for k in range(5) for j in range(10) for i in range(10) for c in (0.05 + 0.1 * i, 0.05 + 0.1 * j, 0.05 + 0.1 * k)]
pack = lambda kind, values: struct.pack(">%d%s" % (len(values), kind), *values)
with open("dual.vtk", "wb") as f:
    f.write(b"# vtk DataFile Version 3.0\nvtk output\nBINARY\nDATASET POLYDATA\nPOINTS %d float\n" % n + pack("f", points))
    f.write(b"\nVERTICES %d %d\n" % (n, 2 * n) + pack("i", [v for i in range(n) for v in (1, i)]))
    f.write(b"\nPOINT_DATA %d\nSCALARS Idp unsigned_int\nLOOKUP_TABLE default\n" % n + pack("I", range(n)))
    f.write(b"\nVECTORS Vel float\n" + pack("f", [2.0, 0.0, 0.0] * n))
    f.write(b"\nSCALARS Rhop float\nLOOKUP_TABLE default\n" + pack("f", [1000.0] * n) + b"\n")
blocks, offset, data = [], 0, ""
def block(kind, values):
    global offset, data
    raw = struct.pack("<%d%s" % (len(values), kind), *values)
    text = (base64.b64encode(struct.pack("<I", len(raw)) + raw)).decode()
    here, offset, data = offset, offset + len(text), data + text
    return here
array = lambda kind, name, width, at: '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="appended" offset="%d"/>' % (kind, name, width, at)
p = array("Float32", "Position", 3, block("f", points))
v = array("Float32", "Velocity", 3, block("f", [2.0, 0.0, 0.0] * n))
i = array("UInt32", "OriginalID", 1, block("I", range(n)))
with open("sphinxsys.vtp", "w") as f:
    f.write('<?xml version="1.0"?>\n<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData><Piece NumberOfPoints="%d" '
            'NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0"><Points>%s</Points><PointData>%s%s</PointData></Piece>'
            '</PolyData><AppendedData encoding="base64">_%s</AppendedData></VTKFile>\n' % (n, p, v, i, data))
END
for file in "dual.vtk --field velocity=Vel --field density=Rhop" "sphinxsys.vtp --field velocity=Velocity"; do
  # shellcheck disable=SC2086
  check "$file, energy" 0 "$ANALYZE" energy $file --dp 0.1
  near "$(column out 'water_kinetic[J]')" 1000 1e-3 "$file: kinetic energy, 500 kg at 2 m/s"
  # shellcheck disable=SC2086
  check "$file, front" 0 "$ANALYZE" front $file --dp 0.1
  near "$(column out 'x_tip[m]')" 1 1e-5 "$file: front"
done
check "a field that is not there" 3 "$ANALYZE" energy dual.vtk --field velocity=Velocity --dp 0.1
says err "Velocity"

check "several files" 0 "$ANALYZE" front f.vtk f.vtu --dp 0.1 --frame-interval 0.5
[ "$(column out 't[s]' | tr '\n' ' ')" = "0 0.5 " ] || fail "times of several files: $(column out 't[s]' | tr '\n' ' ')"
finish
