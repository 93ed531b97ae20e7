# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by the tests of surge-analyze: ANALYZE and MAKE_RUN name the programs, work is a folder of this test's own.
set -u
ANALYZE=$1 MAKE_RUN=$2
work=$(mktemp -d "${TMPDIR:-/tmp}/surge-analyze.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}

# check WHAT CODE COMMAND...: runs the command with stdout in out and stderr in err, compares the exit code.
check() {
  local what=$1 wanted=$2 code=0
  shift 2
  "$@" >out 2>err || code=$?
  [ "$code" = "$wanted" ] || { fail "$what: exit code $code, expected $wanted"; head -5 err >&2; }
}

# says FILE TEXT: the file holds the text.
says() { grep -qF -- "$2" "$1" || { fail "\"$2\" is not in $1:"; head -5 "$1" >&2; }; }
# column FILE NAME: a column of a TSV without its header.
column() { awk -F'\t' -v name="$2" 'NR==1{for(i=1;i<=NF;i++)if($i==name)c=i;next}{print $c}' "$1"; }
# near VALUE WANTED TOLERANCE WHAT
near() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN{exit !(a!=""&&a-b<=t&&b-a<=t)}' || fail "$4: $1, expected $2 +- $3"; }

finish() {
  [ "$failures" = 0 ] && echo "all checks passed" && exit 0
  echo "$failures checks failed" >&2
  exit 1
}
