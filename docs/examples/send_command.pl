#!/usr/bin/perl
# Sends one SCRIPT command to a running cellmirror and waits for its answer, with nothing but msgsnd and msgrcv.
#
#   perl send_command.pl 'ROBACT PUMA_762'
#
# Exit status: 0 done, 1 refused or failed, 2 wrong usage. SPDX-License-Identifier: Apache-2.0
use strict;
use warnings;
use Getopt::Long;
use Time::HiRes qw(setitimer ITIMER_REAL);
use Errno qw(EIDRM ENOENT);

use constant { MESSAGE_TYPE => 5, MAX_MESSAGE => 8192, IPC_NOWAIT => 04000, MSG_NOERROR => 010000 };

my $usage = <<'END';
usage: send_command.pl [--timeout SECONDS] [--script-key KEY] [--reply-key KEY] COMMAND
Sends one SCRIPT command to the gateway and prints its answer: done, or refused and why.
END

my ($timeout, $script_key, $reply_key, $help) = (5, '2351', '2352', 0);
GetOptions('timeout=f' => \$timeout, 'script-key=s' => \$script_key, 'reply-key=s' => \$reply_key, 'help' => \$help)
  or do { print STDERR $usage; exit 2 };
if ($help) { print $usage; exit 0 }
if (@ARGV != 1 || $timeout <= 0) { print STDERR $usage; exit 2 }
# oct() reads 0x...; a plain decimal number is one already.
($script_key, $reply_key) = map { /^0/ ? oct : int } $script_key, $reply_key;

sub failed {
    my ($what) = @_;
    my $why = $!{ENOENT} ? 'no gateway is running' : $!{EIDRM} ? 'the gateway ended before it answered' : "$what: $!";
    print STDERR "send_command.pl: $why\n";
    exit 1;
}

my $queue = msgget($script_key, 0) // failed('the queue of commands');
my $replies = msgget($reply_key, 0) // failed('the queue of replies');

# Any number from 1 to 2147483647 that nobody else uses now. A process is alone with its own.
my $tag = $$;
my $reply;
# A reply to an earlier process of this number could still be there.
1 while msgrcv($replies, $reply, MAX_MESSAGE, $tag, IPC_NOWAIT | MSG_NOERROR);

# Neither call has a time-out of its own: a timer ends them, and goes on, in case it came just before the wait.
$SIG{ALRM} = sub {
    print STDERR "send_command.pl: no answer in time; the command may still be executed\n";
    exit 1;
};
setitimer(ITIMER_REAL, $timeout, 0.1);
# A message is a native long, its type, and then the text.
msgsnd($queue, pack('l! a*', MESSAGE_TYPE, "\@$tag $ARGV[0]"), 0) or failed('sending');
msgrcv($replies, $reply, MAX_MESSAGE, $tag, MSG_NOERROR) // failed('receiving');
setitimer(ITIMER_REAL, 0);
my (undef, $text) = unpack('l! a*', $reply);
print "$text\n";
exit($text =~ /^done/ ? 0 : 1);
