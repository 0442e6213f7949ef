#!/bin/sh
# Inside the guest's root: interfaces, environment and folder of the caller, then the command.
ip link set lo up
for interface in vcan0 vcan1; do
  ip link add dev "$interface" type vcan && ip link set "$interface" mtu 72 up || exit 1
done
# The command and its environment are lists of NUL-terminated words: perl reads them without losing a byte.
perl -e '
  my $run = shift;
  local $/;
  open(my $e, "<", "$run/environment") or die; my $env = <$e>;
  %ENV = map { /^([^=]+)=(.*)$/s ? ($1 => $2) : () } split(/\0/, $env);
  open(my $c, "<", "$run/command") or die; my ($folder, @command) = split(/\0/, <$c>, -1);
  pop @command;
  chdir($folder) or die "$folder: $!";
  open(STDIN, "<", "/dev/null"); open(STDOUT, ">>", "$run/io/stdout"); open(STDERR, ">>", "$run/io/stderr");
  my $status = system { $command[0] } @command;
  $status = $status == -1 ? 127 : $status & 127 ? 128 + ($status & 127) : $status >> 8;
  open(my $s, ">", "$run/io/status"); print $s "$status\n"; close($s);
' "$VCAN_RUN"
