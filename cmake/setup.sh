# Sourced by ./run and ./check: installs missing Debian packages, configures and builds. Silent if there is nothing to
# do, so that a start of a complete tree takes milliseconds.

say() { printf '%s\n' "$*" >&2; }
die() {
  say "$1"
  exit "${2:-1}"
}

# The lines of the given files without comments and blank lines.
lines_of() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$@"; }

# The packages in the given files. A line "PACKAGE unless COMMAND" requires it only if there is no such command.
listed() {
  lines_of "$@" | while read -r package unless command; do
    [ "$unless" = unless ] && command -v "$command" >/dev/null || printf '%s\n' "$package"
  done
}

# Prints those of the given packages that are not installed.
missing_packages() {
  dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    awk -v wanted="$*" '$1 == "installed" { have[$2] = 1 }
      END { n = split(wanted, name, " "); for (i = 1; i <= n; ++i) if (!(name[i] in have)) print name[i] }'
}

# ensure_packages LIST...: the packages named in the files LIST, installed as root or through sudo.
ensure_packages() {
  local wanted missing as_root=() install log
  mapfile -t wanted < <(listed "$@")
  if ! command -v dpkg-query >/dev/null; then
    command -v cmake >/dev/null || die "This is not a Debian system, so packages are not installed automatically. Required: ${wanted[*]}"
    return 0
  fi
  mapfile -t missing < <(missing_packages "${wanted[@]}")
  [ ${#missing[@]} -gt 0 ] || return 0

  install="apt-get install -y --no-install-recommends ${missing[*]}"
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null || ! { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo true; }; }; then
      die "${#missing[@]} packages are missing and only root may install them. Run this as root, then start again:
  apt-get update && $install"
    fi
    as_root=(sudo)
  fi
  say "Installing ${#missing[@]} Debian packages (about a minute) ..."
  log=$(mktemp)
  if ! { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive $install; } >"$log" 2>&1 </dev/null; then
    tail -n 20 "$log" >&2
    rm -f "$log"
    die "The packages could not be installed. Fix the error of apt-get above, or run it by hand:
  ${as_root[*]} apt-get update && ${as_root[*]} $install"
  fi
  rm -f "$log"
}

# configure PRESET FOLDER [cmake argument...]: where FOLDER is not configured for this place yet, or arguments are given.
# Later changes of a CMakeLists.txt are picked up by ninja itself.
configure() {
  local preset=$1 folder=$2 here log
  shift 2
  here="CMAKE_HOME_DIRECTORY:INTERNAL=$PWD"
  if grep -qxF "$here" "$folder/CMakeCache.txt" 2>/dev/null; then
    [ ! -e "$folder/build.ninja" ] || [ $# -gt 0 ] || return 0
  else
    rm -rf "$folder" # what was configured at another place (a copied or moved tree) cannot be reused
  fi
  mkdir -p "$folder"
  log=$folder/configure.log
  cmake --preset "$preset" "$@" >"$log" 2>&1 </dev/null || {
    tail -n 30 "$log" >&2
    die "CMake could not configure $folder (full output: $log)"
  }
}

# build FOLDER [target...]: prints progress only if there is something to do.
build() {
  local folder=$1 steps log jobs watcher status=0
  shift
  log=$folder/build.log
  steps=$(ninja -C "$folder" -n "$@" 2>/dev/null | tail -n 1)
  if [[ $steps = *"Re-running CMake"* ]]; then  # which steps there are shows only afterwards
    ninja -C "$folder" build.ninja >"$log" 2>&1 </dev/null || {
      tail -n 30 "$log" >&2
      die "CMake could not configure $folder again (full output: $log)"
    }
    steps=$(ninja -C "$folder" -n "$@" 2>/dev/null | tail -n 1)
  fi
  [[ $steps != *"no work to do"* ]] || return 0
  steps=$(sed -n 's/^\[[0-9]*\/\([0-9]*\)\].*/\1/p' <<<"$steps")
  jobs=$(nproc)
  if [ "${steps:-0}" -gt 10 ]; then
    say "Building $folder: $steps steps on $jobs cores, about $((steps * 2 / jobs / 60 + 1)) min when nothing is cached ..."
  fi
  if [ -t 2 ]; then
    ninja -C "$folder" "$@" >&2 </dev/null || die "The build of $folder failed, see above."
    return 0
  fi
  : >"$log"
  (
    while sleep 30 >/dev/null 2>&1; do
      say "  $(grep -ao '^\[[0-9]*/[0-9]*\]' "$log" | tail -n 1) $folder"
    done
  ) &
  watcher=$!
  ninja -C "$folder" "$@" >"$log" 2>&1 </dev/null || status=$?
  kill "$watcher" 2>/dev/null
  wait "$watcher" 2>/dev/null
  if [ $status != 0 ]; then
    grep -a -A 40 -m 1 -E '^FAILED|^ninja: error' "$log" >&2 || tail -n 40 "$log" >&2
    die "The build of $folder failed (full output: $log)"
  fi
}
