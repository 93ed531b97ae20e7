#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run_tool() seen from outside. Usage: test_probe.sh PROBE
set -u
probe=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

# expect WHAT FOUND DUE
expect() {
  [[ "$2" == "$3" ]] && return
  echo "FAILED: $1: found '$2', expected '$3'"
  failures=$((failures + 1))
}
# expect_in WHAT TEXT PART
expect_in() {
  [[ "$2" == *"$3"* ]] && return
  echo "FAILED: $1: no '$3' in '$2'"
  failures=$((failures + 1))
}

# exit code and message of each kind of failure
while read -r what code message; do
  text=$("$probe" "$what" 2>&1 >/dev/null)
  expect "exit code of $what" $? "$code"
  expect "message of $what" "$text" "cli_probe: error: $message"
done <<'END'
usage 2 no such option
input 3 lake.toml:3: dp
numerical 4 step 12
resource 5 no room
memory 5 out of memory
unexpected 5 unexpected: odd
END
expect "plain run" "$("$probe" && echo 0)" $'done\n0'

# a closed pipe downstream ends the tool quietly, whether it writes records or a table
for what in records table; do
  { "$probe" "$what" 2>"$folder/err"; echo $? >"$folder/rc"; } | head -n 2 >"$folder/out"
  expect "exit code of $what into a closed pipe" "$(cat "$folder/rc")" 0
  expect "stderr of $what into a closed pipe" "$(cat "$folder/err")" ""
  expect "lines of $what that arrived" "$(wc -l <"$folder/out")" 2
done

# a full disk is not quiet
if [[ -c /dev/full ]]; then
  for what in records table; do
    text=$("$probe" "$what" 2>&1 >/dev/full)
    expect "exit code of $what onto a full disk" $? 5
    expect_in "message of $what onto a full disk" "$text" "standard output cannot be written"
  done
fi

# a standard stream that is closed is not quiet either, and no file takes its place
for what in records table; do
  text=$("$probe" "$what" 2>&1 >&-)
  expect "exit code of $what into nothing" $? 5
  expect_in "message of $what into nothing" "$text" "standard output cannot be written"
done
(cd "$folder" && exec "$probe" file >&-)
expect "exit code with a file and no standard output" $? 5
expect "the file" "$(cat "$folder/file")" "its own"
"$probe" read <&- >/dev/null 2>&1
expect "exit code without standard input" $? 0
"$probe" input 2>&- >/dev/null
expect "exit code without standard error" $? 3

# SIGINT, SIGTERM, SIGHUP (the terminal goes away): the tool finishes its step, says so, and ends with 130; also while it waits for records
for signal in INT TERM HUP; do
  for what in signal read; do
    mkfifo "$folder/in"
    "$probe" "$what" <"$folder/in" 2>"$folder/err" >/dev/null &
    pid=$!
    exec 9>"$folder/in"
    for _ in $(seq 200); do grep -q waiting "$folder/err" && break; sleep 0.02; done
    sleep 0.05
    # a background job of a script starts with SIGINT ignored only until the tool installs its own handler
    kill -"$signal" "$pid"
    wait "$pid"
    expect "exit code of $what after SIG$signal" $? 130
    exec 9>&-
    rm "$folder/in"
    [[ $what == signal ]] && expect_in "last words after SIG$signal" "$(cat "$folder/err")" "checkpoint written"
  done
done

# under nohup(1) a terminal that goes away is no reason to end
(trap '' HUP; exec "$probe" signal 2>"$folder/err") &
pid=$!
for _ in $(seq 200); do grep -q waiting "$folder/err" && break; sleep 0.02; done
kill -HUP "$pid"; sleep 0.2
expect "after SIGHUP under nohup" "$(cat "$folder/err")" "cli_probe: waiting"
kill -TERM "$pid"; wait "$pid"
expect "exit code of what nohup kept" $? 130

# records from a pipe
expect "records from a pipe" "$(printf '{"a":1}\n\n{"b":2}\n' | "$probe" read 2>/dev/null)" '{"record":"done","count":2}'
text=$(printf '{"a":1}\ngarbage\n' | "$probe" read 2>&1 >/dev/null)
expect "exit code after garbage" $? 3
expect_in "message after garbage" "$text" 'line 2: found "garbage"'

# the bar, drawn on a terminal only
if ! script -qec true /dev/null </dev/null >/dev/null 2>&1; then
  echo "no pseudo-terminal can be had here (script, /dev/pts): the bar on a terminal was not looked at"
else
  text=$(script -qec "$probe bar" /dev/null </dev/null | tr -d '\n')
  expect_in "bar on a terminal" "$text" "filling ["
  expect_in "bar on a terminal" "$text" " %  t = 1.5 s  ETA "
  expect_in "message above the bar" "$text" $'\r\e[Kcli_probe: warning: in between'
  expect_in "end of the bar" "$text" "filling: done in 00:0"
fi
expect "nothing drawn into a file" "$("$probe" bar 2>&1 | grep -c $'\r')" 0

((failures == 0)) && echo "all as expected"
exit $((failures > 0))
