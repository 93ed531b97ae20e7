# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by the scripts of this folder: messages, packages, configuring, building. Sourced, not run.
# shellcheck shell=bash
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
script=scripts/$(basename "$0")
programs=(mesh2particles gdesp-run surge-analyze)
quiet=no

# ---- messages: all to stderr, so that stdout stays for results -------------------------------------------------

announce() { printf '==> %s\n' "$*" >&2; }           # something is being done
say() { [[ $quiet == yes ]] || announce "$@"; }        # nothing had to be done, or it is done
warn() { printf '%s: warning: %s\n' "$script" "$*" >&2; }
die() { printf '%s: %s\n' "$script" "$*" >&2; exit 1; }
usage_error() { printf "%s: %s\nTry '%s --help'.\n" "$script" "$*" "$script" >&2; exit 2; }

# The value of an option that needs one: option_value NAME "$@" (the words that follow the option).
option_value() {
  [[ $# -ge 2 && -n $2 ]] || usage_error "$1 needs a value"
  printf '%s' "$2"
}

progress_last=-100
# One line of progress: redrawn in place on a terminal, a line every 20 s elsewhere.
progress() {
  if [[ -t 2 ]]; then
    printf '\r\033[K    %s' "$*" >&2
  elif (( SECONDS - progress_last >= 20 )); then
    printf '    %s\n' "$*" >&2
    progress_last=$SECONDS
  fi
}
progress_end() { if [[ -t 2 ]]; then printf '\r\033[K' >&2; fi; progress_last=-100; }

# mm:ss of a number of seconds.
clock() { printf '%d:%02d' $(($1 / 60)) $(($1 % 60)); }

# ---- packages --------------------------------------------------------------------------------------------------

wanted_packages() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$root/scripts/packages.txt"; }

missing_packages() {
  local wanted installed
  wanted=$(wanted_packages)
  # shellcheck disable=SC2086  # one word a package
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p') || true
  grep -vxF -f <(printf '%s\n' "${installed:-none}") <<<"$wanted" || true
}

# Runs a command as root: directly, or through sudo.
as_root() { if (( EUID == 0 )); then "$@"; else sudo "$@"; fi; }

# Progress from apt's status lines: dlstatus:item:percent:text and pmstatus:package:percent:text.
apt_progress() {
  local kind what percent _
  while IFS=: read -r kind what percent _; do
    case $kind in
      dlstatus) progress "download ${percent%.*} %" ;;
      pmstatus) progress "install ${percent%.*} %  $what" ;;
    esac
  done
  progress_end
}

# apt LOG ARGUMENT...: apt-get, its words into the log. The status pipe is opened inside sudo, which would close
# it, and is not stdout, which apt would make non-blocking under the feet of the packages' own scripts.
apt() {
  # shellcheck disable=SC2016
  as_root env DEBIAN_FRONTEND=noninteractive LC_ALL=C bash -c 'exec apt-get -o DPkg::Lock::Timeout=600 \
    -o Acquire::Retries=5 -o Dpkg::Use-Pty=0 -o APT::Status-Fd=3 "$@" 3>&1 >>"$0" 2>&1' "$@" | apt_progress
}

# Installs what scripts/packages.txt names and the machine lacks. Says nothing and needs no network otherwise.
install_packages() {
  local log=$1/packages.log missing list started=$SECONDS
  command -v apt-get >/dev/null ||
    die "this is no Debian system (no apt-get). Install the equivalents of scripts/packages.txt, then use --no-install."
  missing=$(missing_packages)
  [[ -n $missing ]] || { say "packages: all $(wanted_packages | wc -l) there"; return 0; }
  list=$(tr '\n' ' ' <<<"$missing")
  if (( EUID != 0 )) && ! { command -v sudo && sudo true; } >/dev/null; then
    die "packages are missing, and installing them needs root (sudo is absent or refused). As root, run:
  apt-get update && apt-get install --no-install-recommends $list"
  fi
  announce "packages: installing $(wc -l <<<"$missing") and what they need (about 600 MB to download, 3 GB on disk when none is there)"
  mkdir -p "$1"
  : >"$log"
  [[ -z $(dpkg --audit 2>/dev/null) ]] || as_root dpkg --configure -a >>"$log" 2>&1 || true  # an installation cut short
  apt "$log" update || warn "apt-get update did not succeed fully; trying to install all the same (see $log)"
  # shellcheck disable=SC2086
  apt "$log" install --yes --no-install-recommends $missing || {
    tail -n 15 "$log" >&2
    die "apt-get could not install: $list
Is the network there, and is this Debian 12? The whole log: $log"
  }
  missing=$(missing_packages)
  [[ -z $missing ]] || die "still missing after apt-get install: $(tr '\n' ' ' <<<"$missing") (log: $log)"
  say "packages: installed in $(clock $((SECONDS - started)))"
}

# ---- configure and build ---------------------------------------------------------------------------------------

# Compilers at once: one a core, but 2 GB of free memory each (the geometry files need that much).
build_jobs() {
  local cores memory limit
  cores=$(nproc)
  memory=$(awk '/^MemAvailable:/ {print int($2 / 1024)}' /proc/meminfo 2>/dev/null || true)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || true)
  [[ $limit =~ ^[0-9]+$ ]] && (( limit / 1048576 < ${memory:-1000000000} )) && memory=$((limit / 1048576))
  local by_memory=$(( ${memory:-2048} / 2048 ))
  (( by_memory >= 1 )) || by_memory=1
  echo $(( cores < by_memory ? cores : by_memory ))
}

# Does the folder hold a build of this very tree?
configured() {
  [[ -f $1/build.ninja && -f $1/CMakeCache.txt ]] &&
    [[ $(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$1/CMakeCache.txt") == "$root" ]]
}

# configure BUILD_DIR [CMAKE_ARGUMENT...]
configure() {
  local dir=$1 log=$1/logs/configure.log fresh=()
  shift
  [[ ! -f $dir/CMakeCache.txt ]] || fresh=(--fresh)
  command -v cmake >/dev/null || die "cmake is missing (drop --no-install, or install the packages in scripts/packages.txt)"
  announce "configuring in $dir"
  mkdir -p "$dir/logs"
  if ! (cd "$root" && cmake --preset release -B "$dir" "${fresh[@]}" "$@") >"$log" 2>&1; then
    rm -f "$dir/CMakeCache.txt"
    sed -n '/CMake Error/,$p' "$log" | head -n 25 >&2
    die "configuring failed; the whole log: $log"
  fi
  [[ $quiet == yes ]] || sed -n 's/^-- \(CUDA back end: .*\)/    \1/p' "$log" >&2
}

ninja_progress() {
  local line started=$SECONDS left announced=no
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\ (.*) && $line != *"Re-checking glob"* ]]; then
      local done_=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} what=${BASH_REMATCH[3]##*/}
      if [[ $announced == no ]]; then
        announce "building, $1 at once"
        announced=yes
      fi
      left=$(( (SECONDS - started) * (all - done_) / (done_ > 0 ? done_ : 1) ))
      progress "$(printf '%3d %%  %d of %d, about %s left  %s' $((100 * done_ / all)) "$done_" "$all" "$(clock $left)" "$what")"
    fi
    printf '%s\n' "$line"
  done
  progress_end
}

# build BUILD_DIR [TARGET...]
build() {
  local dir=$1 log=$1/logs/build.log jobs started=$SECONDS
  shift
  jobs=$(build_jobs)
  mkdir -p "$dir/logs"
  if ! ninja -C "$dir" -j "$jobs" "$@" 2>&1 | ninja_progress "$jobs" >"$log"; then
    if grep -q '^FAILED:' "$log"; then
      sed -n '/^FAILED:/,$p' "$log" | grep -v '^/usr.*c++ .* -c ' | head -n 40 >&2
    else
      tail -n 20 "$log" >&2
    fi
    die "the build failed; the whole log: $log"
  fi
  if grep -q '^ninja: no work to do' "$log"; then say "build: up to date"; else say "built in $(clock $((SECONDS - started)))"; fi
}
