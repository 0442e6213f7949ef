#!/usr/bin/perl
# Reads a force as a program of 1999 does: float32 values at the beginning of the memory, and nothing else.
#
#   perl force_reader_1999.pl 1313 4     four values of the TCP force: x y z [N], torque [Nm]
#   perl force_reader_1999.pl 1401 7     force x y z [N] of a haptic device and four joint torques [Nm]
#
# The values are each whole, but may be of two neighbouring writes. SPDX-License-Identifier: Apache-2.0
use strict;
use warnings;

if (@ARGV != 2 || $ARGV[1] !~ /^[1-9]\d?$/) { print STDERR "usage: force_reader_1999.pl KEY COUNT\n"; exit 2 }
my ($key, $count) = @ARGV;
$key = $key =~ /^0/ ? oct $key : int $key;
my $memory = shmget($key, 0, 0) // do { print STDERR "force_reader_1999.pl: no gateway is running: $!\n"; exit 1 };
my $bytes;
shmread($memory, $bytes, 0, 4 * $count) or do { print STDERR "force_reader_1999.pl: $!\n"; exit 1 };
print join(' ', map { sprintf '%.3f', $_ } unpack('f<*', $bytes)), "\n";
