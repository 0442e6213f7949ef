#!/bin/busybox sh
# Process 1 of the QEMU guest of run-in-vcan.sh. Its root is a file system in memory. Mounts the host's files read-only (9p),
# puts a writable layer in memory above them, runs the command, leaves its status, switches off.
b=/bin/busybox
run=$VCAN_RUN
root=/root

switch_off() { $b sync; $b reboot -f; } # QEMU ends at a reset (-no-reboot)
cancel() {
  echo "run-in-vcan: $*"
  switch_off
}
files="trans=virtio,version=9p2000.L,msize=262144"

$b mount -t devtmpfs dev /dev
$b mount -t proc proc /proc
while read -r module; do
  $b insmod "/modules/$module" || cancel "cannot load $module"
done < /order
$b mount -t 9p -o "ro,cache=loose,$files" lower /lower || cancel "the host's files cannot be seen"
$b mount -t tmpfs layer /layer || cancel "no tmpfs"
$b mkdir /layer/upper /layer/work
$b mount -t overlay -o "lowerdir=/lower,upperdir=/layer/upper,workdir=/layer/work" overlay $root || cancel "no overlay"
for kind in proc sysfs:sys devtmpfs:dev; do
  $b mount -t "${kind%:*}" "${kind%:*}" "$root/${kind#*:}"
done
$b mkdir -p $root/dev/pts $root/dev/shm
$b mount -t devpts pts $root/dev/pts
$b mount -t tmpfs shm $root/dev/shm
$b ln -sf /proc/self/fd $root/dev/fd
# Writes below io/ go through to the host.
$b mount -t 9p -o "cache=none,$files" io "$root$run/io" || cancel "the folder of the output cannot be seen"
$b chroot $root /bin/sh "$VCAN_HERE/guest.sh"
switch_off
