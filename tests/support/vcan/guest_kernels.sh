# Fetches and unpacks the kernels of run-in-vcan.sh's guests, once: $cache/uml and $cache/qemu.

cache=${CELLMIRROR_VCAN_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/cellmirror-vcan}

# prepare_guest ENGINE: false, with the cause in $reason, where the engine cannot run here.
prepare_guest() {
  local needs="apt-get dpkg-deb modprobe depmod perl unshare ip" tool version
  [ "$1" != qemu ] || needs="$needs cpio qemu-system-x86_64"
  [ "$(uname -m)" = x86_64 ] || { reason="this engine is for x86_64"; return 1; }
  for tool in $needs; do
    command -v "$tool" >/dev/null || { reason="$tool is missing (apt packages: kmod perl-base iproute2 cpio qemu-system-x86)"; return 1; }
  done
  mkdir -p "$cache" || { reason="cannot make $cache"; return 1; }
  cache=$(readlink -f "$cache")
  exec 9>"$cache/lock"
  flock -w 400 9 || { reason="another preparation holds $cache/lock"; return 1; }
  # A newer version of these files unpacks the kernels again.
  version=$(cat "$here/vcan/guest_kernels.sh" "$here/vcan/qemu_init.sh" | cksum)
  if [ "$(cat "$cache/$1/ready" 2>/dev/null)" != "$version" ] && ! "unpack_$1"; then
    reason="its kernel cannot be fetched (run apt-get update, check the network)"
    exec 9>&-
    return 1
  fi
  exec 9>&-
}

# download PACKAGE: its file is unpacked into ./root.
download() {
  local folder
  timeout 300 apt-get -q download "$1" >apt.log 2>&1 || { cat apt.log >&2; return 1; }
  mkdir -p root
  dpkg-deb -x "$1"_*.deb root
  # Packages of a merged /usr have their files below it.
  for folder in bin lib; do
    [ -e "root/$folder" ] || [ ! -d "root/usr/$folder" ] || ln -s "usr/$folder" "root/$folder"
  done
}

# list_modules ROOT VERSION MODULE...: the files to load, in their order.
list_modules() {
  local root=$1 version=$2 module
  shift 2
  [ -s "$root/lib/modules/$version/modules.dep" ] || depmod -b "$root" "$version"
  for module; do
    modprobe -d "$root" -S "$version" --show-depends "$module"
  done | sed -n "s|^insmod $root/\([^ ]*\).*|\1|p" | awk '!seen[$0]++'
}

unpack_uml() (
  set -e
  work=$(mktemp -d "$cache/prepare.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  cd "$work"
  chmod 755 .
  download user-mode-linux
  mkdir -p uml/lib
  mv root/usr/bin/linux.uml uml/linux
  mv root/usr/lib/uml/modules uml/lib/modules
  list_modules "$work/uml" "$(ls uml/lib/modules)" overlay can-raw vcan > uml/order
  [ -s uml/order ]
  echo "$version" > uml/ready
  rm -rf "$cache/uml"
  mv uml "$cache/uml"
)

# The kernel, and a first file system in memory: a shell (busybox), the modules, and the program that mounts the host's files.
unpack_qemu() (
  set -e
  work=$(mktemp -d "$cache/prepare.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  cd "$work"
  chmod 755 .
  kernel=$(apt-cache depends --important linux-image-amd64 | sed -n 's/^ *Depends: *//p' | head -1)
  [ -n "$kernel" ]
  download "$kernel"
  download busybox-static
  modules=$(ls root/lib/modules)
  mkdir -p qemu first/bin first/dev first/proc first/lower first/layer first/root
  cp root/boot/vmlinuz-* qemu/kernel
  cp root/bin/busybox first/bin/busybox
  list_modules "$work/root" "$modules" virtio_pci virtio_console 9p 9pnet_virtio overlay can-raw vcan > order
  grep -q vcan order
  mkdir first/modules
  while read -r module; do
    cp "root/$module" first/modules/
    basename "$module"
  done < order > first/order
  cp "$here/vcan/qemu_init.sh" first/init
  chmod 755 first/init
  (cd first && find . | cpio -o -H newc -R 0:0 --quiet) > qemu/first
  echo "$version" > qemu/ready
  rm -rf "$cache/qemu"
  mv qemu "$cache/qemu"
)
