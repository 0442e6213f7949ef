#!/bin/bash
# run-in-vcan.sh [--timeout S] COMMAND [ARG...]
#
# Runs COMMAND where the interfaces vcan0 and vcan1 exist and are up, with the exit status of COMMAND:
#   1. on this machine's own kernel, in a network namespace of its own, where that kernel has vcan;
#   2. otherwise in User-Mode Linux, a Linux kernel that runs as an ordinary program. Debian's package user-mode-linux is
#      downloaded and unpacked into ${CELLMIRROR_VCAN_CACHE:-$XDG_CACHE_HOME/cellmirror-vcan}, not installed. The guest sees
#      this machine's files; what it writes vanishes. Output is shown when the guest has ended.
# Status 77: neither is possible here (the reason is told); 124: longer than --timeout (default 120 s).
set -u
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
PATH=$PATH:/usr/sbin:/sbin
limit=120
if [ "${1-}" = --timeout ]; then limit=$2; shift 2; fi
[ $# -gt 0 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }

skip() { echo "skipped: no vcan: $*" >&2; exit 77; }

# 1. The machine's own kernel.
modprobe -q vcan 2>/dev/null
setup='ip link set lo up; for i in vcan0 vcan1; do ip link add dev "$i" type vcan && ip link set "$i" mtu 72 up || exit 99; done'
for spaces in "unshare --net" "unshare --map-root-user --net"; do
  if $spaces sh -c "$setup" >/dev/null 2>&1; then
    exec timeout --kill-after=5 "$limit" $spaces sh -c "$setup; exec \"\$@\"" sh "$@"
  fi
done

# 2. User-Mode Linux.
[ "$(uname -m)" = x86_64 ] || skip "User-Mode Linux is for x86_64"
for tool in apt-get dpkg-deb modprobe perl unshare ip; do
  command -v "$tool" >/dev/null || skip "$tool is missing (apt packages: kmod perl-base iproute2)"
done
cache=${CELLMIRROR_VCAN_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/cellmirror-vcan}
mkdir -p "$cache" || skip "cannot make $cache"
cache=$(readlink -f "$cache")

prepare() (
  set -e
  work=$(mktemp -d "$cache/prepare.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  cd "$work"
  chmod 755 .
  timeout 300 apt-get -q download user-mode-linux >apt.log 2>&1 || { cat apt.log >&2; exit 1; }
  dpkg-deb -x user-mode-linux_*.deb root
  mkdir uml
  mv root/usr/bin/linux.uml uml/linux
  mkdir -p uml/lib
  mv root/usr/lib/uml/modules uml/lib/modules
  version=$(ls uml/lib/modules)
  [ -s "uml/lib/modules/$version/modules.dep" ] || depmod -b uml "$version"
  for module in overlay can-raw vcan; do
    modprobe -d "$work/uml" -S "$version" --show-depends "$module"
  done | sed -n "s|^insmod $work/uml/\([^ ]*\).*|\1|p" | awk '!seen[$0]++' > uml/order
  [ -s uml/order ]
  rm -rf "$cache/uml"
  mv uml "$cache/uml"
)
exec 9>"$cache/lock"
flock -w 400 9 || skip "another preparation holds $cache/lock"
[ -s "$cache/uml/order" ] || prepare || skip "cannot fetch user-mode-linux (run apt-get update, check the network)"
exec 9>&-

run=$(mktemp -d "$cache/run.XXXXXX") || skip "cannot make a folder in $cache"
guest=
clean() {
  # The guest is a process group of its own: what is ended is only what was started here.
  [ -z "$guest" ] || kill -KILL -- "-$guest" 2>/dev/null
  rm -rf "$run"
}
trap clean EXIT
trap 'exit 143' TERM INT HUP
mkdir "$run/io" "$run/layer" "$run/root"
printf '%s\0' "$PWD" "$@" > "$run/command"
env -0 > "$run/environment"
: > "$run/io/stdout"; : > "$run/io/stderr"
set -m
TMPDIR=/dev/shm "$cache/uml/linux" mem=384M root=/dev/root rootfstype=hostfs rootflags=/ ro init="$here/vcan/init.sh" \
  uml_dir="$run" umid=guest con=null con0=null,fd:1 ssl=null quiet VCAN_RUN="$run" VCAN_UML="$cache/uml" \
  </dev/null >"$run/console" 2>&1 &
guest=$!
set +m
waited=0
while kill -0 "$guest" 2>/dev/null && [ "$waited" -lt $((limit * 10)) ]; do sleep 0.1; waited=$((waited + 1)); done
late=
kill -0 "$guest" 2>/dev/null && late=yes
kill -KILL -- "-$guest" 2>/dev/null
wait "$guest" 2>/dev/null
guest=
cat "$run/io/stdout"
cat "$run/io/stderr" >&2
[ -z "$late" ] || { echo "run-in-vcan: stopped after $limit s" >&2; exit 124; }
status=$(cat "$run/io/status" 2>/dev/null)
[ -n "$status" ] || { tail -20 "$run/console" >&2; skip "the guest kernel ended without a status"; }
exit "$status"
