#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# scripts/demo end to end, very coarse and short: table, pictures, exit codes.
# usage: test_demo.sh REPOSITORY BUILD_FOLDER
set -uo pipefail
root=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { failures=$((failures + 1)); echo "FAILED: $*"; }
demo() { "$root/scripts/demo" --no-build --build-dir "$build" --output "$work/out" "$@" >"$work/stdout" 2>"$work/stderr"; }

demo --set resolution.dp=20 --set slide.diameter=14 --t-end 1 || fail "the demo ended with $?: $(tail -n 5 "$work/stderr")"
head -n 1 "$work/stdout" | grep -q '\[s\]' || fail "stdout starts with no table head: $(head -n 1 "$work/stdout")"
(( $(wc -l <"$work/stdout") >= 2 )) || fail "the table has no row"
cmp -s "$work/stdout" "$work/out/demo/run-up.tsv" || fail "stdout and run-up.tsv differ"
for picture in run-up scene; do
  file=$work/out/demo/$picture.png
  [[ $(head -c 8 "$file" 2>/dev/null | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] || fail "$picture.png is no PNG"
  (( $(stat -c %s "$file" 2>/dev/null || echo 0) > 2000 )) || fail "$picture.png is empty"
done
for series in fluid grains; do
  [[ -s $work/out/alpe-gera.run/$series.pvd ]] || fail "no $series.pvd"
done

demo --set resolution.dpp=60
code=$?
(( code == 3 )) || fail "a mistyped key ended with $code, not 3"
grep -q 'resolution.dp' "$work/stderr" || fail "a mistyped key is not named: $(tail -n 3 "$work/stderr")"
[[ ! -e $work/out/demo/scene.png ]] || fail "pictures of the run before were left"

demo --no-such-option
(( $? == 2 )) || fail "a wrong option did not end with 2"
echo "$failures failed"
(( failures == 0 ))
