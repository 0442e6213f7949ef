#!/usr/bin/perl
# Prints the robot-parameter records of a running cellmirror (ROBOT <id> send_on), one a line:
#   sequence robot online|offline state joint=position ... tcp x y z
#
#   perl sensor_reader.pl --count 10
#
# A record that was read is gone from the queue: there is one reader. SPDX-License-Identifier: Apache-2.0
use strict;
use warnings;
use Getopt::Long;

use constant { MESSAGE_TYPE => 5, MAX_MESSAGE => 8192, MSG_NOERROR => 010000, KIND_ROBOT => 1 };
# Places in a record: docs/messages.md
use constant { ID => 40, WORLD_TCP => 176, JOINTS => 232, JOINT_BYTES => 112, JOINT_POSITION => 72 };

my $usage = <<'END';
usage: sensor_reader.pl [--count N] [--timeout SECONDS] [--key KEY]
Prints robot-parameter records as they come: N of them (default: without end), waiting at most SECONDS (default: for
ever) for each.
END

my ($count, $timeout, $key, $help) = (0, 0, '1990', 0);
GetOptions('count=i' => \$count, 'timeout=i' => \$timeout, 'key=s' => \$key, 'help' => \$help)
  or do { print STDERR $usage; exit 2 };
if ($help) { print $usage; exit 0 }
if (@ARGV) { print STDERR $usage; exit 2 }
$key = $key =~ /^0/ ? oct($key) : int($key);

my $queue = msgget($key, 0);
if (!defined $queue) { print STDERR "sensor_reader.pl: no gateway is running: $!\n"; exit 1 }
$SIG{ALRM} = sub { print STDERR "sensor_reader.pl: no record in time\n"; exit 1 };
$| = 1;

my @states = qw(none fresh stale lost invalid);
for (my $printed = 0; $count == 0 || $printed < $count;) {
    my $message;
    alarm($timeout);
    defined msgrcv($queue, $message, MAX_MESSAGE, MESSAGE_TYPE, MSG_NOERROR)
      or do { print STDERR "sensor_reader.pl: $!\n"; exit 1 };
    my (undef, $record) = unpack('l! a*', $message);
    next if length($record) < JOINTS;
    # Header: magic, version, kind, length, reserved, sequence.
    my ($magic, $version, $kind, $length, undef, $sequence) = unpack('a4 S< S< L< L< Q<', $record);
    next if $magic ne 'CMIR' || $version != 1 || $kind != KIND_ROBOT || $length != length($record);
    my ($id, $online, $state, $joints) = unpack('Z64 C C S<', substr($record, ID));
    next if $length != JOINTS + $joints * JOINT_BYTES;
    my @line = ($sequence, $id, $online ? 'online' : 'offline', $states[$state] // 'unknown');
    for my $i (0 .. $joints - 1) {
        my $joint = substr($record, JOINTS + $i * JOINT_BYTES, JOINT_BYTES);
        push @line, sprintf('%s=%.6f', unpack('Z64', $joint), unpack('d<', substr($joint, JOINT_POSITION)));
    }
    push @line, 'tcp', map { sprintf '%.6f', $_ } unpack('d<3', substr($record, WORLD_TCP));
    print "@line\n";
    ++$printed;
}
