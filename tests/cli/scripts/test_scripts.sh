#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The scripts' own habits: help, wrong options, packages on machines of several kinds, failures told clearly.
# usage: test_scripts.sh REPOSITORY. Nothing is installed: apt-get and dpkg-query are stand-ins in a temporary folder.
set -uo pipefail
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0 checks=0
status='' out='' err=''

run() {  # run COMMAND...: leaves status, out, err
  "$@" >"$work/out" 2>"$work/err" </dev/null
  status=$?
  out=$(<"$work/out") err=$(<"$work/err")
}
check() {  # check DESCRIPTION CONDITION...
  local description=$1
  shift
  checks=$((checks + 1))
  if ! "$@"; then
    failures=$((failures + 1))
    printf 'FAILED: %s\n  exit status: %s\n  stdout: %.300s\n  stderr: %.600s\n' "$description" "$status" "$out" "$err"
  fi
}
is() { [[ $1 == "$2" ]]; }
has() { [[ $1 == *"$2"* ]]; }
lacks() { [[ $1 != *"$2"* ]]; }

# A folder of stand-ins: dpkg-query knows the packages listed in $work/installed; apt-get writes down its call,
# fails when $work/apt-fails is there, and else "installs" what it is asked for.
mkdir "$work/bin"
cat >"$work/bin/dpkg-query" <<END
#!/bin/bash
while read -r package; do echo "installed \$package"; done <$work/installed
END
cat >"$work/bin/apt-get" <<END
#!/bin/bash
echo "apt-get \$*" >>$work/calls
echo "dlstatus:1:50.0:words" >&3
echo "pmstatus:ninja-build:80.0:words" >&3
if [[ -e $work/apt-fails && " \$* " == *" install "* ]]; then echo "E: no such mirror"; exit 100; fi
for word in "\$@"; do echo "\$word" >>$work/installed; done
END
printf '#!/bin/bash\n' >"$work/bin/dpkg"
chmod +x "$work"/bin/*
everything() { sed -e 's/#.*//' -e 's/ *$//' -e '/^$/d' "$root/scripts/packages.txt"; }
library() { PATH=$work/bin:$PATH bash -c ". '$root/scripts/lib.sh'; $1" scripts/trial; }

# ---- help and wrong options
for name in build test demo format bench; do
  run "$root/scripts/$name" --help
  check "$name --help ends with 0" is "$status" 0
  check "$name --help has a usage line" has "$out" "usage: scripts/$name"
  check "$name --help ends with an example" has "${out##*$'\n'}" "example: scripts/$name"
  check "$name --help is silent on stderr" is "$err" ""
  run "$root/scripts/$name" --no-such-option
  check "$name: a wrong option ends with 2" is "$status" 2
  check "$name: a wrong option is named" has "$err" "'--no-such-option'"
  check "$name: a wrong option leaves stdout empty" is "$out" ""
done
for name in tradeoff paper-figures; do
  run "$root/scripts/$name" --help
  check "$name --help ends with 0" is "$status" 0
  check "$name --help ends with an example" has "${out##*$'\n'}" "example: scripts/$name"
  run "$root/scripts/$name" --no-such-option
  check "$name: a wrong option ends with 2" is "$status" 2
  check "$name: a wrong option is named" has "$err" "--no-such-option"
done
run "$root/scripts/tradeoff" --case nothing
check "tradeoff: a case that it does not chart ends with 2" is "$status" 2
run "$root/scripts/paper-figures" fig99
check "paper-figures: an unknown figure is answered by the list" has "$err" "there are fig7"
run "$root/scripts/build" --build-dir
check "an option without its value ends with 2" is "$status" 2
check "an option without its value is named" has "$err" "--build-dir needs a value"
run "$root/scripts/test" -L units
check "a wrong tier ends with 2" is "$status" 2
check "a wrong tier is answered by the list" has "$err" "unknown tier 'units'; there are: unit verification"
check ".ci/run calls scripts/test and nothing else" \
  is "$(grep -v '^#' "$root/.ci/run")" 'exec "$(dirname "${BASH_SOURCE[0]}")/../scripts/test"'

# ---- packages
check "no package is listed twice" is "$(everything | sort | uniq -d)" ""
check "package names are names" is "$(everything | grep -vE '^[a-z0-9][a-z0-9+.-]+$')" ""
everything >"$work/installed"
run library "install_packages '$work/logs'"
check "all there: success" is "$status" 0
check "all there: apt-get is not called" is "$(cat "$work/calls" 2>/dev/null)" ""

everything | grep -vx -e ninja-build -e f3d >"$work/installed"
run library missing_packages
check "what is missing" is "$out" "$(printf 'ninja-build\nf3d')"
if (( EUID == 0 )); then
  run library "install_packages '$work/logs'"
  check "missing packages are installed" is "$status" 0
  check "only the missing ones" has "$(cat "$work/calls")" "install --yes --no-install-recommends ninja-build f3d"
  check "after an update of the lists" has "$(cat "$work/calls")" " update"
  check "with progress" has "$err" "download 50 %"
  everything | grep -vx ninja-build >"$work/installed"
  touch "$work/apt-fails"
  run library "install_packages '$work/logs'"
  check "a failed installation ends with 1" is "$status" 1
  check "a failed installation shows apt's words" has "$err" "E: no such mirror"
  check "a failed installation names packages and log" has "$err" "could not install: ninja-build"
  chmod -R a+rX "$work"
  mkdir "$work/no-sudo" && ln -s "$(command -v bash)" "$(command -v sed)" "$(command -v grep)" "$(command -v tr)" \
    "$(command -v dirname)" "$(command -v basename)" "$work"/bin/* "$work/no-sudo"
  run setpriv --reuid=65534 --clear-groups env PATH="$work/no-sudo" bash -c \
    ". '$root/scripts/lib.sh'; install_packages '$work/logs'" scripts/trial
  if lacks "$err" "Permission denied"; then
    check "neither root nor sudo: ends with 1" is "$status" 1
    check "neither root nor sudo: the command to type" has "$err" "apt-get install --no-install-recommends ninja-build"
  fi
fi
mkdir "$work/bare" && ln -s "$(command -v bash)" "$(command -v dirname)" "$(command -v basename)" "$work/bare"
run env PATH="$work/bare" bash -c ". '$root/scripts/lib.sh'; install_packages '$work/logs'" scripts/trial
check "no Debian: ends with 1" is "$status" 1
check "no Debian: what to do" has "$err" "--no-install"

# ---- configuring and building
mkdir -p "$work/elsewhere" && touch "$work/elsewhere/build.ninja"
echo "CMAKE_HOME_DIRECTORY:INTERNAL=/another/tree" >"$work/elsewhere/CMakeCache.txt"
run library "configured '$work/elsewhere'"
check "a build folder of another tree is not taken for this one's" is "$status" 1
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$root" >"$work/elsewhere/CMakeCache.txt"
run library "configured '$work/elsewhere'"
check "this tree's build folder is known again" is "$status" 0
run library build_jobs
check "at least one compiler at once" test "$out" -ge 1
check "no more compilers than cores" test "$out" -le "$(nproc)"

mkdir "$work/tiny"
cat >"$work/tiny/build.ninja" <<'END'
rule make
  command = echo made > $out
rule break
  command = echo the reason; exit 1
build good: make
build bad: break
END
run library "build '$work/tiny' good"
check "a build succeeds" is "$status" 0
check "a build is announced" has "$err" "==> building"
run library "build '$work/tiny' good"
check "a second build has nothing to do" has "$err" "up to date"
run library "quiet=yes; build '$work/tiny' good"
check "--quiet says nothing when there is nothing to do" is "$err" ""
run library "build '$work/tiny' bad"
check "a broken build ends with 1" is "$status" 1
check "a broken build shows why" has "$err" "the reason"
check "a broken build names its log" has "$err" "$work/tiny/logs/build.log"

echo "$checks checks, $failures failed"
(( failures == 0 ))
