#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# mesh2particles as a user meets it: what it prints, how it ends, what it leaves behind. Usage: run.sh PROGRAM CASES
set -u
program=$1
cases=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }

# expect CODE WORDS command...: exit code, and the words in stderr
expect() {
  code=$1 words=$2
  shift 2
  "$@" > out.txt 2> err.txt
  got=$?
  [ "$got" -eq "$code" ] || fail "exit $got instead of $code: $* ($(tail -n 1 err.txt))"
  grep -qF -- "$words" err.txt || fail "no \"$words\" in the message of: $* ($(cat err.txt))"
}

# refuse WORDS scene-name: exit 3, one line on stderr with the words, nothing on stdout, no output left behind
refuse() {
  words=$1 name=$2
  before=$(ls -A | sort)
  "$program" "$name.toml" -o "$name.case" > .out 2> .err
  got=$?
  [ "$got" -eq 3 ] || fail "$name: exit $got instead of 3 ($(cat .err))"
  grep -qF -- "$words" .err || fail "$name: no \"$words\" in \"$(cat .err)\""
  [ "$(grep -c . .err)" -eq 1 ] || fail "$name: more than one line of message: $(cat .err)"
  [ -s .out ] && fail "$name: something on stdout"
  rm -f .out .err
  [ "$(ls -A | sort)" = "$before" ] || fail "$name: something was left behind: $(ls -A)"
}

tank='[[wall]]
tank = {lower = [0, 0, 0], upper = [0.4, 0.2, 0.3]}
open = ["top"]
[[fluid.fill]]
box = {lower = [0, 0, 0], upper = [0.4, 0.2, 0.2]}'
printf '%s\n' '[resolution]' 'dp = 0.02' "$tank" > tank.toml

# A good scene: a record on stdout, the case's files, the summary on stderr.
expect 0 "2000 particles" "$program" tank.toml
grep -q '"record":"case"' out.txt || fail "no case record: $(cat out.txt)"
grep -q "\"path\":\"$(pwd -P)/tank.case\"" out.txt || fail "the path is not absolute: $(cat out.txt)"
grep -q '"fluid":2000' out.txt || fail "count: $(cat out.txt)"
[ "$(grep -c . out.txt)" -eq 1 ] || fail "more than one line on stdout"
for part in case.toml fluid.vtp boundary.vtp walls.vtp boundary.vdb; do [ -s tank.case/$part ] || fail "tank.case/$part is missing"; done

# An existing case is not overwritten without --force, and survives the attempt.
sum=$(cksum tank.case/fluid.vtp)
expect 2 "--force" "$program" tank.toml
[ "$(cksum tank.case/fluid.vtp)" = "$sum" ] || fail "the existing case was touched"
expect 0 "16000 particles" "$program" tank.toml --force --set resolution.dp=0.01

# Two runs give the same bytes.
"$program" tank.toml -o a.case -q > /dev/null && "$program" tank.toml -o b.case -q > /dev/null
for part in fluid.vtp boundary.vtp walls.vtp; do cmp -s a.case/$part b.case/$part || fail "$part differs between two runs"; done
rm -rf a.case b.case tank.case

# Usage.
expect 2 "did you mean --force" "$program" tank.toml --forse
expect 2 "no input" "$program"
expect 2 "expected a name ending in" "$program" tank.toml --preview picture.jpeg
"$program" --help | grep -q "Example:" || fail "--help has no example"
"$program" --version | grep -q . || fail "--version is empty"

# Bad input: one clear message, exit 3, nothing left behind.
refuse "tank2.toml" tank2
printf '%s\n' '[resolution]' 'dq = 0.02' "$tank" > typo.toml
refuse "did you mean" typo
printf '%s\n' '[resolution]' 'dp = 0.02' "$tank" '[terrain]' 'files = ["missing.asc"]' > missing.toml
refuse "missing.asc" missing
printf 'OFF\n5 4 0\n0.1 0.1 0.2\n0.2 0.1 0.2\n0.2 0.15 0.2\n0.1 0.15 0.2\n0.15 0.12 0.25\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n' > open.off
printf '%s\n' '[resolution]' 'dp = 0.02' "$tank" '[[slide]]' 'mesh = "open.off"' 'diameter = 0.01' > open.toml
refuse "is open: the hole around" open
awk 'BEGIN {print "ncols 11\nnrows 11\nxllcenter 0\nyllcenter 0\ncellsize 10"; for (j = 0; j < 11; ++j) {s = ""; for (i = 0; i < 11; ++i) s = s 5 + ((i-5)^2 + (j-5)^2) / 5 " "; print s}}' > bowl.asc
printf '%s\n' '[resolution]' 'dp = 2' '[terrain]' 'files = ["bowl.asc"]' '[[fluid.fill]]' 'level = 3' > dry.toml
refuse "is below the bed; the lowest ground lies at 5.0" dry
printf '%s\n' '[resolution]' 'dp = 2' '[terrain]' 'files = ["bowl.asc"]' '[[fluid.fill]]' 'level = 9' 'seed = [500, 500]' > away.toml
refuse "outside the domain" away
printf 'solid x\nfacet' > cut.stl
printf '%s\n' '[resolution]' 'dp = 0.02' "$tank" '[[wall]]' 'mesh = "cut.stl"' > cut.toml
refuse "cut.stl" cut
expect 3 "banana" "$program" tank.toml --set resolution.dp=banana
[ -e tank.case ] && fail "a refused --set left a case"

# A folder that cannot be written to.
if [ "$(id -u)" -ne 0 ]; then
  mkdir locked && chmod a-w locked
  expect 5 "locked" "$program" tank.toml -o locked/tank.case
fi

# More particles than there is memory for: a word, and nothing left behind. (The address sanitizer bears no limit.)
if ! ldd "$program" | grep -q libasan; then
  (ulimit -v 700000; OMP_NUM_THREADS=1 expect 5 "twice the resolution.dp" "$program" tank.toml -o large.case --set resolution.dp=0.0008; exit "$failures") || failures=$((failures + 1))
  [ -z "$(ls -d large* 2> /dev/null)" ] || fail "left behind: $(ls -d large*)"
fi

# --check: usable 0, refused 3, one record a file; no case is made.
"$program" --check bowl.asc > out.txt 2> err.txt || fail "--check of a good raster"
grep -q '"verdict":"usable"' out.txt || fail "--check: $(cat out.txt)"
"$program" --check bowl.asc cut.stl > out.txt 2> err.txt
[ $? -eq 3 ] || fail "--check of a cut mesh must end with 3"
[ "$(grep -c '"record":"check"' out.txt)" -eq 2 ] || fail "--check: one record a file"

# --explain builds nothing.
"$program" tank.toml --explain > out.txt 2> err.txt || fail "--explain"
grep -q "fluid particles   2000" out.txt && grep -q "^expected  *[0-9].* steps, about" out.txt || fail "--explain: $(cat out.txt)"
[ -e tank.case ] && fail "--explain made a case"

# A slide that settles under gravity: the record says how far it fell; the next run finds it at rest.
printf '%s\n' '[resolution]' 'dp = 0.02' '[[wall]]' 'tank = {lower = [0, 0, 0], upper = [0.2, 0.1, 0.2]}' 'open = ["top"]' '[[slide]]' \
  'box = {lower = [0, 0, 0], upper = [0.1, 0.1, 0.1]}' 'diameter = 0.015' 'diameter_half_width = 0.003' 'relaxation = "gravity"' > bed.toml
expect 0 "settled under gravity for" "$program" bed.toml
grep -q '"bed_porosity":0\.[34]' out.txt || fail "no porosity of the bed: $(cat out.txt)"
"$program" bed.toml --explain > out.txt 2> err.txt || fail "--explain of a slide that settles"
grep -q "settles under gravity" out.txt || fail "--explain does not say that the slide settles: $(cat out.txt)"

# Every case of the repository that is small builds at a coarse size.
for name in hydrostatic dam-break two-phase-dam-break; do
  expect 0 "particles" "$program" "$cases/$name/$name.toml" -o $name.case --set resolution.dp=0.02 -v
done
expect 0 "grains" "$program" "$cases/alpe-gera/alpe-gera.toml" -o alpe-gera.case --set resolution.dp=32 --set slide.diameter=16 --preview alpe.vtp
[ -s alpe.vtp ] || fail "no preview"

[ "$failures" -eq 0 ] && echo "mesh2particles: all as expected"
[ "$failures" -eq 0 ]
