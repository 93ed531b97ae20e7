#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tables of a run whose run-up, levels and slide are known exactly (make_run.cpp).
. "$(dirname "$0")/common.sh"
"$MAKE_RUN" v.case v.run 4 21 >records.ndjson || exit 1

check "runup" 0 "$ANALYZE" runup v.run
head -1 out | grep -qP '^t\[s\]\tregion\trun_up\[m\]\tx\[m\]\ty\[m\]\tz\[m\]\tsplash\[m\]\tresolution\[m\]$' || fail "header of runup: $(head -1 out)"
highest=$(awk -F'\t' 'NR>1&&$2=="all"&&$3>m{m=$3}END{print m}' out)
near "$highest" 12.857 4 "highest run-up (dp = 4 m)"
near "$(awk -F'\t' 'NR>1&&$2=="all"&&$1==0{print $3}' out)" 0 1 "run-up of still water"
near "$(awk -F'\t' 'NR>1&&$2=="all"&&$1==0{print $7}' out)" 47 1e-6 "splash: the drop at z = 75 m"
near "$(awk -F'\t' 'NR>1&&$2=="all"&&$1==5{print $4}' out)" 568085.7 8 "x of the highest point, scene coordinates"
near "$(awk -F'\t' 'NR>1&&$2=="far bank"&&$1==15{print $3}' out)" 0 1 "far bank at t = 15 s"
says err "highest run-up"

check "gauge" 0 "$ANALYZE" gauge v.run
near "$(awk -F'\t' '$1==5&&$2=="middle"{print $5}' out)" 2131 0.4 "level at the gauge: 2095 + 30 + 0.15 * 40"
near "$(awk -F'\t' '$1==5&&$2=="middle"{print $7}' out)" 107910 1500 "pressure at z = 25 m: 9810 * 11"
check "arrival" 0 "$ANALYZE" gauge v.run --arrival --threshold 1
# 6 m sin(2 pi t / 20) = 1 m at t = 0.533 s; linear between frames at 0 and 1 s: 1 / 1.854
near "$(awk -F'\t' '$1=="middle"{print $4}' out)" 0.54 0.05 "arrival"

check "profile" 0 "$ANALYZE" profile v.run --section across --time 5 --step 10
near "$(awk -F'\t' '$2==160{print $5}' out)" 2128 0.4 "level at x = 20 m: 2095 + 30 + 3"
near "$(awk -F'\t' '$2==160{print $7}' out)" 2105 1e-3 "bed at x = 20 m"

check "slide" 0 "$ANALYZE" slide v.run
near "$(awk -F'\t' '$1==10{print $2}' out)" 567930 0.5 "x of the slide: 568000 - 100 + 3 * 10"
near "$(awk -F'\t' '$1==10{print $8}' out)" 3.3541 1e-3 "speed of the slide"
near "$(awk -F'\t' '$1==10{print $9}' out)" 30 0.1 "travel of the front"

check "energy" 0 "$ANALYZE" energy v.run
head -1 out | grep -q 'water_kinetic\[J\]' || fail "header of energy"
check "front" 0 "$ANALYZE" front v.run --format csv
head -1 out | grep -q '^t\[s\],x_front\[m\],' || fail "CSV header of front: $(head -1 out)"

check "json" 0 "$ANALYZE" runup v.run --format json --every 10
python3 -c 'import json,sys; rows=json.load(open("out")); assert len(rows)==6 and rows[0]["region"]=="all", rows' || fail "JSON of runup"
check "two times" 0 "$ANALYZE" runup v.run --from 4 --until 6
[ "$(column out 't[s]' | sort -u | tr '\n' ' ')" = "4 5 6 " ] || fail "--from --until: $(column out 't[s]' | tr '\n' ' ')"

# One thread and two print the same bytes.
OMP_NUM_THREADS=1 "$ANALYZE" runup v.run --every 5 >one 2>/dev/null
OMP_NUM_THREADS=2 "$ANALYZE" runup v.run --every 5 >two 2>/dev/null
cmp -s one two || fail "runup depends on the number of threads"
finish
