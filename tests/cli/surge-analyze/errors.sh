#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What goes wrong is said in one message, with the right exit code, and leaves nothing behind.
. "$(dirname "$0")/common.sh"
"$MAKE_RUN" v.case v.run 8 3 >/dev/null || exit 1

check "no command" 2 "$ANALYZE"
check "unknown command" 2 "$ANALYZE" runnup v.run
says err "did you mean runup"
check "unknown option" 2 "$ANALYZE" runup v.run --formt csv
says err "did you mean --format"
check "wrong format" 2 "$ANALYZE" runup v.run --format xml
says err "tsv, csv, json"
check "no run" 2 "$ANALYZE" runup
check "missing file" 3 "$ANALYZE" runup lake.run
says err "lake.run"
says err "no such file"
check "no frames" 3 "$ANALYZE" runup v.case
check "empty time range" 3 "$ANALYZE" runup v.run --from 100
check "wrong plot" 2 "$ANALYZE" runup v.run --plot p.jpg
says err ".svg, .png or .pdf"
check "plot where no folder can be" 5 "$ANALYZE" runup v.run --plot v.case/case.toml/p.svg
check "wrong field" 2 "$ANALYZE" runup v.run --field velocity
check "wrong dp" 2 "$ANALYZE" runup v.run --dp -1
check "unknown region" 2 "$ANALYZE" runup v.run --region north
says err "far bank"
check "unknown section" 2 "$ANALYZE" profile v.run --section nort
says err "across"
check "no gauges where they say" 2 "$ANALYZE" gauge v.run --at abc
check "no dp in a foreign file" 3 "$ANALYZE" runup v.case/walls.vtp
printf '# garbage\n' >garbage.vtp
check "garbage" 3 "$ANALYZE" runup garbage.vtp --dp 1
says err "garbage.vtp"
check "two runs to converge" 2 "$ANALYZE" converge v.run v.run
check "compare one table" 2 "$ANALYZE" compare a.tsv --y z
check "compare a missing table" 3 "$ANALYZE" compare a.tsv b.tsv --y z
check "render without a name" 2 "$ANALYZE" render v.run
check "map without output" 2 "$ANALYZE" map v.run
[ "$(find . -type f ! -path './v.*' ! -name out ! -name err ! -name garbage.vtp | wc -l)" = 0 ] || fail "left behind: $(ls)"

for command in $("$ANALYZE" --help | awk '/^Commands:/{on=1;next}/^$/{on=0}on{print $1}'); do
  check "$command --help" 0 "$ANALYZE" "$command" --help
  says out "Example:"
  [ "$(head -1 out | cut -d' ' -f2)" = "$command" ] || fail "$command --help begins with: $(head -1 out)"
done
check "--version" 0 "$ANALYZE" --version
finish
