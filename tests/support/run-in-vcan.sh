#!/bin/bash
# run-in-vcan.sh [--timeout S] [--engine own|uml|qemu] COMMAND [ARG...]
#
# Runs COMMAND where the interfaces vcan0 and vcan1 exist and are up, with the exit status of COMMAND:
#   own   this machine's own kernel, in a network namespace of its own, where that kernel has vcan;
#   uml   User-Mode Linux, a Linux kernel that runs as an ordinary program, at the speed of this machine. It cannot restore
#         the state of processors with AMX: its kernel panics there;
#   qemu  Debian's kernel in QEMU (package qemu-system-x86), emulated and slower, on every processor.
# Without --engine the first that works is taken, and a guest kernel that ends without a status is followed by the next.
# Debian's packages of the kernels are downloaded and unpacked into
# ${CELLMIRROR_VCAN_CACHE:-$XDG_CACHE_HOME/cellmirror-vcan}, not installed. The guest sees this machine's files; what it
# writes vanishes. Output is shown when the guest has ended.
# Status 77: none is possible here (the reason of each is told); 124: longer than --timeout (default 120 s; QEMU gets eight
# times that, for its speed).
set -u
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
PATH=$PATH:/usr/sbin:/sbin
limit=120
engines=
while [ $# -gt 0 ]; do
  case $1 in
    --timeout) limit=$2; shift 2 ;;
    --engine) engines=$2; shift 2 ;;
    *) break ;;
  esac
done
[ $# -gt 0 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }

skip() { echo "skipped: no vcan: $*" >&2; exit 77; }

. "$here/vcan/own.sh"
. "$here/vcan/guest_kernels.sh"
. "$here/vcan/guest_run.sh"

if [ -z "$engines" ]; then
  engines="own uml qemu"
  ! grep -qw amx_tile /proc/cpuinfo || engines="own qemu"
fi
reasons=
for engine in $engines; do
  reason=
  if [ "$engine" = own ]; then
    own_kernel "$@"   # does not return where it can run the command
  elif prepare_guest "$engine"; then
    run_guest "$engine" "$@"
  fi
  reasons="$reasons${reasons:+; }$engine: $reason"
done
skip "$reasons"
