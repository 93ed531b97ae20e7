#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The slide of Alpe Gera as one rigid body, coarse and short, through the three programs: it slides down, the water holds,
# nothing is gained from nothing.
# usage: test_rigid_slide.sh REPOSITORY BUILD_FOLDER
set -uo pipefail
root=$1
PATH=$2/bin:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { failures=$((failures + 1)); echo "FAILED: $*"; }

# without friction: the 45 degrees of the flank end on a bench of 18 degrees, where its own friction would hold the slab
mesh2particles "$root/data/cases/alpe-gera/alpe-gera.toml" -o "$work/rigid.case" --set slide.kind=rigid --set slide.density=1484 \
  --set resolution.dp=16 --set contact.wall_friction=0 2>"$work/errors" |
  gdesp-run - -o "$work/rigid.run" --threads 1 --t-end 5 2>>"$work/errors" | surge-analyze runup - >"$work/run-up.tsv" 2>>"$work/errors"
codes=("${PIPESTATUS[@]}")
[[ ${codes[*]} == "0 0 0" ]] || fail "exit codes ${codes[*]}: $(tail -n 5 "$work/errors")"
(( $(grep -c 'far bank' "$work/run-up.tsv") >= 10 )) || fail "run-up.tsv has no row for each frame"

surge-analyze slide "$work/rigid.run" --quiet >"$work/slide.tsv" || fail "surge-analyze slide ended with $?"
awk -F'\t' 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  { travel = $column["front_travel[m]"]; z = $column["z[m]"]; if (NR == 2) first = z }
  END { exit !(travel > 15 && travel < 60 && z < first - 5) }' "$work/slide.tsv" || fail "the body did not slide down: $(tail -n 1 "$work/slide.tsv")"

# The body's own energy (motion, height, contacts) falls: the terrain gives nothing, the water takes. The water of the whole lake is no
# measure here: at this spacing its height drifts by centimetres, which is more energy than the slide has.
python3 - "$work/rigid.run/log.ndjson" <<'PYTHON' || fail "energy or mass"
import json, sys
lines = [r for r in map(json.loads, open(sys.argv[1])) if "fluid_kinetic" in r]
body = [r["body_kinetic"] + r["body_potential"] + r["body_elastic"] for r in lines]
moving = max(r["body_kinetic"] for r in lines)
made = max(later - earlier for earlier, later in zip(body, body[1:])) / moving
print(f"body: largest gain of energy {made:.2g} of its largest kinetic energy; particles lost: {lines[-1]['lost_fluid']}; fastest water {max(r['largest_speed'] for r in lines):.3g} m/s")
lake = [sum(v for k, v in r.items() if k in ("fluid_kinetic", "fluid_potential", "fluid_elastic")) for r in lines]
print(f"lake: energy {lake[-1] - lake[0]:.3g} J more than at the start, which lifts its mass by {1000 * (lake[-1] - lake[0]) / 9.81 / lines[0]['fluid_mass']:.2g} mm; lost by the body: {body[0] - body[-1]:.3g} J")
sys.exit(not (moving > 0 and made < 0.01 and lines[-1]["lost_fluid"] == 0 and max(r["largest_speed"] for r in lines) < 40))
PYTHON
echo "$failures failed"
(( failures == 0 ))
