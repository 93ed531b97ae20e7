#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Maps that a GIS opens in place, surfaces, plots, the report; comparison, convergence, trade-off.
. "$(dirname "$0")/common.sh"
"$MAKE_RUN" v.case v.run 8 5 >/dev/null || exit 1
valid_json() { python3 -m json.tool "$1" >/dev/null || fail "$1 is no JSON"; }

check "map" 0 "$ANALYZE" map v.run -o maps/v --plot maps/v.png  # both make the folder
if command -v gdalinfo >/dev/null; then
  gdalinfo -stats maps/v_level_max.tif >info || fail "GDAL does not open the map"
  says info "NoData Value=-9999"
  grep -q "Origin = (567848" info || fail "map is not in place: $(grep Origin info)"
  near "$(sed -n 's/.*STATISTICS_MAXIMUM=//p' info)" 2137.9 8 "highest level"
fi
# A cell of the map, by GDAL at its place on the ground, and the line's place and height.
if command -v gdallocationinfo >/dev/null; then
  at() { gdallocationinfo -valonly -geoloc "maps/v_$1.tif" "$2" "$3"; }
  near "$(at level_max 568040 5120080)" 2131 4 "level at x = 40 m, t = 5 s: 2095 + 30 + 6 (dp = 8 m)"
  near "$(at depth_max 568004 5120080)" 28.6 4 "depth at x = 4 m: 30.6 - 2"
  near "$(at arrival 568068 5120080)" 5 1e-6 "arrival on the far bank: the frame at 5 s"
  [ "$(at level_max 568130 5120080)" = -9999 ] || fail "dry ground has a level: $(at level_max 568130 5120080)"
fi
if command -v ogrinfo >/dev/null; then
  ogrinfo -al -so maps/v_run_up_line.geojson >info || fail "GDAL does not open the run-up line"
  says info "Line String"
  awk -F'[(, )]+' '/^Extent/{exit !($2>567900&&$2<567960&&$5>568060&&$5<568100)}' info || fail "run-up line is not in place: $(grep Extent info)"
fi
valid_json maps/v_run_up_line.geojson
grep -q '567\|568' maps/v_run_up_line.geojson || fail "run-up line is not in the terrain's coordinates"
check "ESRI ASCII" 0 "$ANALYZE" map v.run -o maps/a --ascii --cell 16 --plot maps/a.png
says maps/a_arrival.asc "cellsize     16"
if command -v gdalinfo >/dev/null; then
  gdalinfo maps/a_level_max.asc >info || fail "GDAL does not open the ESRI ASCII map"
  grep -q "Origin = (567840" info || fail "ESRI ASCII map is not in place: $(grep Origin info)"
fi
[ -s maps/a.png ] || fail "no plot of the map"

check "surface" 0 "$ANALYZE" surface v.run -o s --vdb --every 4
[ -s s/surface_00001.vtp ] && [ -s s/surface_00001.vdb ] || fail "surface files missing"
near "$(column out 'volume[m3]' | head -1)" 288000 60000 "volume of the lake (dp = 8 m: four layers)"

for kind in svg png pdf; do
  check "plot $kind" 0 "$ANALYZE" runup v.run --plot p.$kind
  [ "$(stat -c %s p.$kind)" -gt 3000 ] || fail "p.$kind is too small"
done
python3 -c 'import xml.dom.minidom as m; m.parse("p.svg")' || fail "SVG is not well-formed"

check "report" 0 "$ANALYZE" report v.run -o r.html
says r.html "Run-up"
says r.html "How to reproduce"
grep -qE '(src|href)="https?:' r.html && fail "the report needs the network"
grep -q 'data:image/svg' r.html || fail "the report has no figures"

printf 't[s],x[m]\n0,0\n1,1\n2,2\n' >ours.csv
printf '# source\ntime,place,low,high\n0.5,0.4,0.3,0.6\n1.5,1.6,1.55,1.7\n9,9,8,10\n' >reference.csv
check "compare" 0 "$ANALYZE" compare ours.csv reference.csv --y x --ref-x time --ref-y place --low low --high high --plot c.svg
near "$(column out points)" 2 0 "points"
near "$(column out rms)" 0.1 1e-6 "RMS"
near "$(column out bias)" 0 1e-6 "bias"
near "$(column out 'inside_band[%]')" 50 1e-6 "inside the band"
"$ANALYZE" front v.run 2>/dev/null | "$ANALYZE" compare - reference.csv --y x_tip --ref-x time --ref-y place >out 2>err || fail "compare from a pipe"

"$ANALYZE" front v.run --quiet >f.tsv
check "plot" 0 "$ANALYZE" plot f.tsv f.tsv --x t --y x_front --y x_tip --label one --label two --reference ours.csv --ref-x t --ref-y x --plot o.svg
[ "$(column out curve | sed -n 2p)" = "one, x_tip" ] || fail "curves of plot: $(column out curve | tr '\n' ' ')"
[ "$(awk 'END{print NR}' out)" = 6 ] || fail "plot draws $(awk 'END{print NR - 1}' out) curves"
check "plot by a column" 0 "$ANALYZE" plot ours.csv --x t --y x --by 't[s]' --points --plot o.pdf
[ "$(column out curve | head -1)" = "t = 0" ] || fail "curves by a column: $(column out curve | tr '\n' ' ')"
check "plot without a column" 3 "$ANALYZE" plot ours.csv --x t --y nothing --plot o.svg
check "plot without --plot" 2 "$ANALYZE" plot ours.csv --x t --y x

printf 'dp,value\n4,1.16\n2,1.04\n1,1.01\n' >runs.csv
check "converge" 0 "$ANALYZE" converge --table runs.csv --value value --plot g.svg
near "$(column out order)" 2 1e-3 "order"
near "$(column out extrapolated)" 1 1e-3 "extrapolated"
printf 'dp,value\n4,1.1\n2,1.3\n1,1.2\n' >bad.csv
check "converge refuses" 4 "$ANALYZE" converge --table bad.csv --value value
says out "oscillating"
says err "do not converge"

printf 'name\terror[%%]\tcost[s/s]\tgroup\nA\t1\t10\tus\nB\t5\t20\tthem\nC\t8\t2\tthem\n' >points.tsv
check "tradeoff" 0 "$ANALYZE" tradeoff --points points.tsv --plot t.svg
[ "$(column out pareto | tr '\n' ' ')" = "yes no yes " ] || fail "Pareto front: $(column out pareto | tr '\n' ' ')"

# Runs of three resolutions: the run-up of the middle run is 12.3 of 12.857 m at most one spacing off.
for dp in 16 4; do "$MAKE_RUN" v$dp.case v$dp.run $dp 5 >/dev/null || exit 1; done
printf '{"status":"done","wall_seconds":30,"t":20,"score":7e4,"device":"cpu","device_name":"test"}' >v4.run/run.json
check "tradeoff of a run" 0 "$ANALYZE" tradeoff v4.run --quantity 'runup:far bank' --reference 12.857 --points points.tsv
near "$(column out 'cost[s/s]' | head -1)" 1.5 1e-6 "cost"
near "$(column out 'error[%]' | head -1)" 0 32 "error of the run-up at dp = 4 m"
check "tradeoff without cost" 3 "$ANALYZE" tradeoff v.run --reference 12.857
code=0
"$ANALYZE" converge v16.run v.run v4.run --quantity level:middle >out 2>err || code=$?
{ [ "$code" = 0 ] && grep -q monotone out; } || { [ "$code" = 4 ] && grep -qE 'oscillating|diverging' out; } || fail "converge of runs: exit code $code"
near "$(column out finest)" 2131 0.4 "finest level"

if [ -n "${DISPLAY:-}" ] || command -v xvfb-run >/dev/null; then
  check "render" 0 "$ANALYZE" render v.run -o r.png --size 400,300 --time 5
  [ "$(head -c 4 r.png | tail -c 3)" = PNG ] || fail "no picture"
fi
finish
