#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The three programs in one pipeline, cut at each end: exit codes, and what is left on disk.
# usage: pipeline.sh SURGE_ANALYZE MAKE_RUN MESH2PARTICLES GDESP_RUN
. "$(dirname "$0")/common.sh"
MESH=$3 RUN=$4
cat >dam.toml <<'END'
dimensions = 2
[resolution]
dp = 0.02
[[fluid.fill]]
box = {lower = [0.0, 0.0, 0.0], upper = [0.4, 0.0, 0.3]}
[[wall]]
tank = {lower = [0.0, 0.0, 0.0], upper = [1.2, 0.0, 0.5]}
[time]
end = 0.2
output_interval = 0.02
END
set -o pipefail

"$MESH" dam.toml -o a.case 2>mesh.err | "$RUN" - -o a.run 2>run.err | "$ANALYZE" front - >a.tsv 2>analyze.err
[ "${PIPESTATUS[*]}" = "0 0 0" ] || fail "whole pipeline: exit codes ${PIPESTATUS[*]}"
[ "$(awk 'END{print NR}' a.tsv)" = 12 ] || fail "whole pipeline: $(awk 'END{print NR}' a.tsv) lines, expected a header and 11 frames"

# Downstream goes away after three lines: nobody complains, and the run can be taken up from its checkpoint.
"$RUN" a.case -o b.run --t-end 20 2>run.err | "$ANALYZE" front - 2>analyze.err | head -3 >b.tsv
codes=("${PIPESTATUS[@]}")
[ "${codes[*]}" = "0 0 0" ] || fail "reader gone: exit codes ${codes[*]}"
[ -s analyze.err ] && { fail "reader gone: surge-analyze is not quiet:"; cat analyze.err >&2; }
[ "$(wc -l <b.tsv)" = 3 ] || fail "reader gone: $(wc -l <b.tsv) lines came through"
ls b.run/checkpoints/*.state >/dev/null 2>&1 || fail "reader gone: no checkpoint"

# surge-analyze is killed: the solver ends quietly.
mkfifo pipe
"$ANALYZE" front - <pipe >c.tsv 2>/dev/null &
reader=$!
"$RUN" a.case -o c.run --t-end 20 >pipe 2>run.err &
writer=$!
for _ in $(seq 200); do [ "$(wc -l <c.tsv)" -ge 3 ] && break; sleep 0.05; done
kill -KILL "$reader"
wait "$reader" 2>/dev/null
code=0; wait "$writer" || code=$?
[ "$code" = 0 ] || fail "surge-analyze killed: exit code $code of gdesp-run"

# The solver is killed: surge-analyze finishes its table and says so.
mkfifo pipe2
"$ANALYZE" front - <pipe2 >d.tsv 2>d.err &
reader=$!
"$RUN" a.case -o d.run --t-end 20 >pipe2 2>run.err &
writer=$!
for _ in $(seq 200); do [ "$(wc -l <d.tsv)" -ge 3 ] && break; sleep 0.05; done
kill -KILL "$writer"
wait "$writer" 2>/dev/null
code=0; wait "$reader" || code=$?
[ "$code" = 4 ] || fail "gdesp-run killed: exit code $code of surge-analyze"
says d.err "it was killed"
awk -F'\t' 'NF!=7{exit 1}' d.tsv || fail "gdesp-run killed: a line of the table is cut"

# The solver is interrupted: it writes a checkpoint and says so; surge-analyze ends as after a run.
mkfifo pipe3
"$ANALYZE" front - <pipe3 >e.tsv 2>/dev/null &
reader=$!
"$RUN" a.case -o e.run --t-end 20 >pipe3 2>run.err &
writer=$!
for _ in $(seq 200); do [ "$(wc -l <e.tsv)" -ge 3 ] && break; sleep 0.05; done
kill -TERM "$writer"
code=0; wait "$writer" || code=$?
[ "$code" = 130 ] || fail "gdesp-run interrupted: its exit code $code"
code=0; wait "$reader" || code=$?
[ "$code" = 0 ] || fail "gdesp-run interrupted: exit code $code of surge-analyze"

# The first of the three fails: each of the others says that nothing came.
"$MESH" nothing.toml -o f.case 2>mesh.err | "$RUN" - -o f.run 2>run.err | "$ANALYZE" front - >f.tsv 2>analyze.err
[ "${PIPESTATUS[*]}" = "3 3 3" ] || fail "missing scene: exit codes ${PIPESTATUS[*]}"
finish
