#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes valley.asc and dam.obj from the terrain of SPHERA's Alpe Gera tutorial (see README.md): a triangulated surface given
# as an OBJ file. Needs gdal-bin (gdal_grid, gdal_translate). Usage: make_inputs.sh TERRAIN.obj
set -eu
[ $# -eq 1 ] && [ -r "$1" ] || { echo "usage: $0 TERRAIN.obj" >&2; exit 2; }
terrain=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
{ echo x,y,z; awk '$1 == "v" {printf "%s,%s,%s\n", $2, $3, $4}' "$terrain"; } > valley.csv
cat > valley.vrt <<'VRT'
<OGRVRTDataSource><OGRVRTLayer name="valley"><SrcDataSource>valley.csv</SrcDataSource><GeometryType>wkbPoint</GeometryType>
<GeometryField encoding="PointFromColumns" x="x" y="y" z="z"/></OGRVRTLayer></OGRVRTDataSource>
VRT
# Linear interpolation between the points on a 30 m grid around the upper lake; outside the data: -9999.
gdal_grid -q -a linear:radius=0:nodata=-9999 -txe 71925 73965 -tye 34725 37425 -outsize 68 90 -of GTiff -ot Float32 -l valley valley.vrt valley.tif
gdal_translate -q -of AAIGrid -co DECIMAL_PRECISION=1 -a_nodata -9999 valley.tif valley.asc
cp valley.asc "$here/valley.asc"
# The dam: a prism on the tutorial's polygon edge (its upstream face), 50 m thick, crest at 2128 m.
awk 'BEGIN {
  n = split("72260 35222 72500 35150 72780 35070 73040 35153.9", p, " ");
  print "# Dam of Alpe Gera, simplified: vertical faces, crest 2128 m";
  for (side = 0; side < 2; ++side) for (level = 0; level < 2; ++level)
    for (i = 1; i <= n; i += 2) printf "v %.1f %.1f %.1f\n", p[i], p[i+1] - 50 * side, level ? 2128 : 1900;
  m = n / 2;                                  # upstream bottom 1..m, top m+1..2m, downstream bottom 2m+1..3m, top 3m+1..4m
  for (i = 1; i < m; ++i) {
    printf "f %d %d %d %d\n", i + 1, i, m + i, m + i + 1;                          # upstream
    printf "f %d %d %d %d\n", 2*m + i, 2*m + i + 1, 3*m + i + 1, 3*m + i;          # downstream
    printf "f %d %d %d %d\n", m + i + 1, m + i, 3*m + i, 3*m + i + 1;              # crest
    printf "f %d %d %d %d\n", i, i + 1, 2*m + i + 1, 2*m + i;                      # base
  }
  printf "f %d %d %d %d\n", 1, 2*m + 1, 3*m + 1, m + 1;                            # ends
  printf "f %d %d %d %d\n", m, 2*m, 4*m, 3*m;
}' > "$here/dam.obj"
