#!/bin/bash
# boot.sh ROOT CGROUP: boots the Debian in the folder ROOT: its systemd is process 1 of namespaces of its own, without a
# network but loopback, and ends with this script's caller. CGROUP: a folder of the cgroup2 file system for its groups.
set -eu
root=$1 cgroup=$2
mkdir "$cgroup"
echo $$ >"$cgroup/cgroup.procs"
export root
exec unshare --mount --ipc --pid --uts --net --cgroup --fork --kill-child bash -euc '
  mount --make-rprivate /
  mount --bind "$root" "$root"
  cd "$root"
  mount -t proc proc proc
  mount -t sysfs -o ro sysfs sys
  mount -t cgroup2 cgroup2 sys/fs/cgroup
  mount -t tmpfs -o mode=755 tmpfs run
  mount -t tmpfs -o mode=1777 tmpfs tmp
  mount -t tmpfs -o mode=755 tmpfs dev
  mkdir dev/shm dev/pts
  mount -t tmpfs -o mode=1777 tmpfs dev/shm
  mount -t devpts -o newinstance,ptmxmode=0666,mode=620 devpts dev/pts
  ln -s pts/ptmx dev/ptmx
  for name in null zero full random urandom tty; do touch "dev/$name"; mount --bind "/dev/$name" "dev/$name"; done
  ln -s /proc/self/fd dev/fd
  mkdir -p .before
  pivot_root . .before
  ip link set lo up
  umount --lazy /.before
  exec env -i container=other PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 /lib/systemd/systemd --system --show-status=false --unit=multi-user.target
'
