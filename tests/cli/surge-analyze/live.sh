#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Records on standard input: followed while they come, unknown ones ignored, a failure passed on, ends kept clean.
. "$(dirname "$0")/common.sh"
"$MAKE_RUN" v.case v.run 8 5 >records.ndjson || exit 1

check "records" 0 "$ANALYZE" runup - <records.ndjson
from_records=$(cat out)
check "folder" 0 "$ANALYZE" runup v.run
[ "$from_records" = "$(cat out)" ] || fail "records and folder give different tables"

# Rows appear while the producer still runs.
mkfifo pipe
"$ANALYZE" runup - <pipe >live.tsv 2>/dev/null &
reader=$!
exec 3>pipe
head -2 records.ndjson >&3
for _ in $(seq 100); do
  [ "$(awk -F'\t' 'NR>1' live.tsv 2>/dev/null | wc -l)" -ge 2 ] && break
  sleep 0.1
done
[ "$(awk 'NR>1' live.tsv | wc -l)" -ge 2 ] || fail "no row while the producer runs"
tail -1 records.ndjson >&3
exec 3>&-
wait "$reader" || fail "reader's exit code $?"

{ head -2 records.ndjson; echo '{"record":"weather","sunny":true}'; echo; sed -n 3p records.ndjson; tail -1 records.ndjson; } >mixed
check "unknown records" 0 "$ANALYZE" runup - <mixed
[ "$(column out 't[s]' | sort -u | wc -l)" = 3 ] || fail "unknown records disturb"

{ head -2 records.ndjson; echo '{"record":"failed","message":"step 7: particle 3 is not finite"}'; } >failed
check "failed run" 4 "$ANALYZE" runup - --plot p.svg <failed
[ "$(column out 't[s]' | sort -u | wc -l)" = 2 ] || fail "the table of a failed run is not finished"
says err "particle 3 is not finite"
[ -s p.svg ] || fail "the plot of a failed run is missing"

# A producer that is killed says no last word: the table of what it left, a warning, and exit code 4.
head -3 records.ndjson >killed
check "killed producer" 4 "$ANALYZE" runup - --plot k.svg <killed
[ "$(column out 't[s]' | sort -u | wc -l)" = 3 ] || fail "the table of a killed run is not finished"
says err "it was killed"
[ -s k.svg ] || fail "the plot of a killed run is missing"
{ cat killed; echo '{"record":"interrupted","t":2}'; } >interrupted
check "interrupted producer" 0 "$ANALYZE" runup - <interrupted

check "nothing" 3 "$ANALYZE" runup - </dev/null
says err "without a frame record"
check "failed at once" 4 "$ANALYZE" runup - <<<'{"record":"failed","message":"no memory"}'
check "no record" 3 "$ANALYZE" runup - <<<'hello'
says err "line 1"

# A reader that goes away ends the tool quietly.
( "$ANALYZE" profile v.run 2>closed.err; echo $? >code ) | head -1 >/dev/null
[ "$(cat code)" = 0 ] || fail "closed pipe: exit code $(cat code)"
[ -s closed.err ] && { fail "closed pipe is not quiet:"; cat closed.err >&2; }

# A signal ends it cleanly: JSON closed, exit code 130.
mkfifo pipe2
"$ANALYZE" runup - --format json <pipe2 >int.json 2>/dev/null &
reader=$!
exec 3>pipe2
head -2 records.ndjson >&3
for _ in $(seq 100); do grep -q region int.json 2>/dev/null && break; sleep 0.1; done
kill -TERM "$reader"
code=0; wait "$reader" || code=$?
exec 3>&-
[ "$code" = 130 ] || fail "interrupted: exit code $code"
python3 -c 'import json; json.load(open("int.json"))' || fail "interrupted: JSON not closed"
finish
