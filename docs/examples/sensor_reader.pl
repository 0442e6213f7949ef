#!/usr/bin/perl
# Prints the records of a running cellmirror, one a line:
#   sequence robot online|offline state joint=position ... tcp x y z     ROBOT <id> send_on
#   sequence range sensor DISTANCE|nothing|blind|doubt [object]          SET_USSPAR active
#   sequence ranges PART/PARTS sensor=DISTANCE|nothing|blind|doubt ...   SET_USSPAR sendmode 1
#   sequence camera NAME tracks FRAME|free mirrored|simulated pan P tilt T distance D fovy F   CAM_ONLINE
#   sequence proximity touching N warning N of TESTED pairs: a|b=DISTANCE|touching ...
#   sequence event NUMBER CHANGE a b DISTANCE
#   sequence tissue NUMBER KIND robot|- object|- part|- VALUE at x y z
#   sequence barrier NAME interrupted|free|doubt COUNT object|-
#
#   perl sensor_reader.pl --count 10
#
# A record that was read is gone from the queue: there is one reader. SPDX-License-Identifier: Apache-2.0
use strict;
use warnings;
use Getopt::Long;

use constant { MESSAGE_TYPE => 5, MAX_MESSAGE => 8192, MSG_NOERROR => 010000 };
# Places in a record: docs/messages.md
use constant { PAYLOAD => 40, WORLD_TCP => 176, JOINTS => 232, JOINT_BYTES => 112, JOINT_POSITION => 72 };
use constant { RANGE_BYTES => 296, RANGES => 48, RANGE_ENTRY_BYTES => 112 };
use constant { PAIRS => 88, PAIR_BYTES => 376, EVENT_BYTES => 320, CAMERA_BYTES => 384, TISSUE_BYTES => 280, BARRIER_BYTES => 248 };

my $usage = <<'END';
usage: sensor_reader.pl [--count N] [--timeout SECONDS] [--key KEY]
Prints records as they come: N of them (default: without end), waiting at most SECONDS (default: for ever) for each.
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
my @changes = qw(entered_warning touched parted left_warning);
my @deeds = qw(grip release slip clip cut coagulate tear bleed bleed_end limit);

# The words of one kind of record behind its sequence; nothing for a record of another length.
sub robot {
    my ($record) = @_;
    return if length($record) < JOINTS;
    my ($id, $online, $state, $joints) = unpack('Z64 C C S<', substr($record, PAYLOAD));
    return if length($record) != JOINTS + $joints * JOINT_BYTES;
    my @words = ($id, $online ? 'online' : 'offline', $states[$state] // 'unknown');
    for my $i (0 .. $joints - 1) {
        my $joint = substr($record, JOINTS + $i * JOINT_BYTES, JOINT_BYTES);
        push @words, sprintf('%s=%.6f', unpack('Z64', $joint), unpack('d<', substr($joint, JOINT_POSITION)));
    }
    return (@words, 'tcp', map { sprintf '%.6f', $_ } unpack('d<3', substr($record, WORLD_TCP)));
}

# Flags: 1 something is seen, 2 in the blind zone, 4 in doubt.
sub reading {
    my ($distance, $flags) = @_;
    return 'doubt' if $flags & 4;
    return !($flags & 1) ? 'nothing' : ($flags & 2) ? 'blind' : sprintf('%.6f', $distance);
}

sub range {
    my ($record) = @_;
    return if length($record) != RANGE_BYTES;
    # distance, range, blind zone, half angle, point, flags
    my ($id, $object, $distance, @more) = unpack('Z64 Z128 d<7 L<', substr($record, PAYLOAD));
    return ('range', $id, reading($distance, $more[6]), $object eq '' ? () : $object);
}

sub ranges {
    my ($record) = @_;
    return if length($record) < RANGES;
    my ($part, $parts, $count) = unpack('S<3', substr($record, PAYLOAD));
    return if length($record) != RANGES + $count * RANGE_ENTRY_BYTES;
    my @words = ('ranges', "$part/$parts");
    for my $i (0 .. $count - 1) {
        # distance, range, point, flags
        my ($id, $distance, @more) =
          unpack('Z64 d<5 L<', substr($record, RANGES + $i * RANGE_ENTRY_BYTES, RANGE_ENTRY_BYTES));
        push @words, "$id=" . reading($distance, $more[4]);
    }
    return @words;
}

# Flags: 1 it tracks, 2 its head is mirrored.
sub camera {
    my ($record) = @_;
    return if length($record) != CAMERA_BYTES;
    # pose, mount, pan, tilt, focal distance, fovy, flags
    my ($id, $tracks, @more) = unpack('Z64 Z128 d<18 L<', substr($record, PAYLOAD));
    my $flags = $more[18];
    my @words = ('camera', $id, ($flags & 1) ? ('tracks', $tracks) : 'free', ($flags & 2) ? 'mirrored' : 'simulated');
    my @numbers = map { sprintf '%.6f', $_ } @more[14 .. 17];
    return (@words, 'pan', $numbers[0], 'tilt', $numbers[1], 'distance', $numbers[2], 'fovy', $numbers[3]);
}

sub proximity {
    my ($record) = @_;
    return if length($record) < PAIRS;
    # check, warning distance, computed after, tested, touching, within warning, doubts, found, pairs
    my (undef, undef, undef, $tested, $touching, $warning, undef, undef, $count) =
      unpack('Q< d< d< L<5 S<', substr($record, PAYLOAD));
    return if length($record) != PAIRS + $count * PAIR_BYTES;
    my @words = ('proximity', 'touching', $touching, 'warning', $warning, 'of', $tested, 'pairs:');
    for my $i (0 .. $count - 1) {
        # distance, depth, points, normal, closing speed, time to contact, flags
        my ($body_a, $body_b, @more) = unpack('Z128 Z128 d<13 L<', substr($record, PAIRS + $i * PAIR_BYTES, PAIR_BYTES));
        push @words, "$body_a|$body_b=" . (($more[13] & 1) ? 'touching' : sprintf('%.6f', $more[0]));
    }
    return @words;
}

sub event {
    my ($record) = @_;
    return if length($record) != EVENT_BYTES;
    my ($event, $change, $distance, $body_a, $body_b) = unpack('Q< C x7 d< Z128 Z128', substr($record, PAYLOAD));
    return ('event', $event, $changes[$change] // 'unknown', $body_a, $body_b, sprintf('%.6f', $distance));
}

sub tissue {
    my ($record) = @_;
    return if length($record) != TISSUE_BYTES;
    # event, kind, limit, value, place, texts
    my ($event, $kind, undef, $value, @more) = unpack('Q< C C x6 d< d<3 Z64 Z64 Z64', substr($record, PAYLOAD));
    my @texts = map { $_ eq '' ? '-' : $_ } @more[3 .. 5];
    return ('tissue', $event, $deeds[$kind] // 'unknown', @texts, sprintf('%.6f', $value), 'at',
        map { sprintf '%.6f', $_ } @more[0 .. 2]);
}

# Flags: 1 interrupted, 2 doubtful.
sub barrier {
    my ($record) = @_;
    return if length($record) != BARRIER_BYTES;
    my ($id, $object, $interruptions, $flags) = unpack('Z64 Z128 Q< L<', substr($record, PAYLOAD));
    my $state = ($flags & 2) ? 'doubt' : ($flags & 1) ? 'interrupted' : 'free';
    return ('barrier', $id, $state, $interruptions, $object eq '' ? '-' : $object);
}

my %kinds = (1 => \&robot, 2 => \&range, 3 => \&ranges, 4 => \&camera, 5 => \&proximity, 6 => \&event, 7 => \&tissue,
    8 => \&barrier);
for (my $printed = 0; $count == 0 || $printed < $count;) {
    my $message;
    alarm($timeout);
    defined msgrcv($queue, $message, MAX_MESSAGE, MESSAGE_TYPE, MSG_NOERROR)
      or do { print STDERR "sensor_reader.pl: $!\n"; exit 1 };
    my (undef, $record) = unpack('l! a*', $message);
    next if length($record) < PAYLOAD;
    # Header: magic, version, kind, length, reserved, sequence.
    my ($magic, $version, $kind, $length, undef, $sequence) = unpack('a4 S< S< L< L< Q<', $record);
    next if $magic ne 'CMIR' || $version != 1 || $length != length($record) || !$kinds{$kind};
    my @words = $kinds{$kind}->($record);
    next if !@words;
    print "$sequence @words\n";
    ++$printed;
}
