#!/bin/sh
# Process 1 of the User-Mode Linux guest of run-in-vcan.sh. Root is the host's file system, read-only (hostfs). Puts a
# writable layer in memory above it, creates vcan0 and vcan1, runs the command, leaves its status, switches off.
PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
export PATH
run=$VCAN_RUN
root=$run/root

switch_off() { exec perl -e 'syscall(169, 0xfee1dead, 672274793, 0x4321fedc, 0)'; } # reboot(RB_POWER_OFF)
cancel() {
  echo "run-in-vcan: $*"
  switch_off
}

mount -t proc proc /proc || cancel "no proc"
while read -r module; do
  insmod "$VCAN_UML/$module" || cancel "cannot load $module"
done < "$VCAN_UML/order"
mount -t tmpfs layer "$run/layer" || cancel "no tmpfs"
mkdir "$run/layer/upper" "$run/layer/work"
mount -t overlay -o "lowerdir=/,upperdir=$run/layer/upper,workdir=$run/layer/work" overlay "$root" || cancel "no overlay"
mount -t proc proc "$root/proc"
mount -t sysfs sys "$root/sys"
mount -t devtmpfs dev "$root/dev"
mkdir -p "$root/dev/pts" "$root/dev/shm"
mount -t devpts pts "$root/dev/pts"
mount -t tmpfs shm "$root/dev/shm"
ln -sf /proc/self/fd "$root/dev/fd"
# Writes below io/ go through to the host.
mount -t hostfs -o "$run/io" io "$root$run/io" || cancel "no hostfs"
chroot "$root" /bin/sh "$(dirname "$0")/guest.sh"
sync
switch_off
