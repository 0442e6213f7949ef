# Runs a command in a guest kernel, for run-in-vcan.sh.

run=
guest=
clean() {
  # The guest is a process group of its own: what is ended is only what was started here.
  [ -z "$guest" ] || kill -KILL -- "-$guest" 2>/dev/null
  [ -z "$run" ] || rm -rf "$run"
}

# run_guest ENGINE COMMAND...: ends this program with the command's status; returns with the cause in $reason where the
# guest's kernel ended without one.
run_guest() {
  local engine=$1 waited=0 longest=$limit late= status
  shift
  [ "$engine" != qemu ] || longest=$((limit * 8))
  run=$(mktemp -d "$cache/run.XXXXXX") || { reason="cannot make a folder in $cache"; return; }
  trap clean EXIT
  trap 'exit 143' TERM INT HUP
  mkdir "$run/io" "$run/layer" "$run/root"
  printf '%s\0' "$PWD" "$@" > "$run/command"
  env -0 > "$run/environment"
  : > "$run/io/stdout"; : > "$run/io/stderr"
  set -m
  "start_$engine" </dev/null >"$run/console" 2>&1 &
  guest=$!
  set +m
  while kill -0 "$guest" 2>/dev/null && [ "$waited" -lt $((longest * 10)) ]; do sleep 0.1; waited=$((waited + 1)); done
  ! kill -0 "$guest" 2>/dev/null || late=yes
  kill -KILL -- "-$guest" 2>/dev/null
  wait "$guest" 2>/dev/null
  guest=
  status=$(cat "$run/io/status" 2>/dev/null)
  if [ -z "$status" ] && [ -z "$late" ]; then
    tail -20 "$run/console" >&2
    reason="the guest kernel ended without a status: $(tr -d '\r' < "$run/console" | grep -am1 -E 'panic|run-in-vcan:|qemu-system' | cut -c1-200)"
    rm -rf "$run"
    return
  fi
  cat "$run/io/stdout"
  cat "$run/io/stderr" >&2
  [ -z "$late" ] || { tail -5 "$run/console" >&2; echo "run-in-vcan: stopped after $longest s" >&2; exit 124; }
  exit "$status"
}

start_uml() {
  TMPDIR=/dev/shm exec "$cache/uml/linux" mem=384M root=/dev/root rootfstype=hostfs rootflags=/ ro init="$here/vcan/uml_init.sh" \
    uml_dir="$run" umid=guest con=null con0=null,fd:1 ssl=null quiet VCAN_RUN="$run" VCAN_UML="$cache/uml"
}

start_qemu() {
  exec qemu-system-x86_64 -machine q35 -accel tcg -cpu max -m 768 -display none -nodefaults -no-user-config -no-reboot \
    -serial stdio -kernel "$cache/qemu/kernel" -initrd "$cache/qemu/first" \
    -append "console=ttyS0 quiet panic=-1 reboot=t mitigations=off tsc=reliable VCAN_RUN=$run VCAN_HERE=$here/vcan" \
    -fsdev local,id=lower,path=/,security_model=none,readonly=on,multidevs=remap -device virtio-9p-pci,fsdev=lower,mount_tag=lower \
    -fsdev local,id=io,path="$run/io",security_model=none,multidevs=remap -device virtio-9p-pci,fsdev=io,mount_tag=io
}
