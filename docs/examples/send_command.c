/*
 * Sends one SCRIPT command to a running cellmirror and waits for its answer.
 *
 *   cc -o send_command send_command.c
 *   ./send_command 'ROBACT PUMA_762'
 *
 * Exit status: 0 done, 1 refused or failed, 2 wrong usage. SPDX-License-Identifier: Apache-2.0
 */
#define _XOPEN_SOURCE 700
#define _DEFAULT_SOURCE /* MSG_NOERROR */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/time.h>
#include <unistd.h>

#include "cellmirror_messages.h"

static const char* const kUsage =
    "usage: send_command [--timeout SECONDS] [--script-key KEY] [--reply-key KEY] COMMAND\n"
    "Sends one SCRIPT command to the gateway and prints its answer: done, or refused and why.\n";

struct Message {
  long type; /* System V wants a long first; it is not counted in the length */
  char text[CELLMIRROR_MAX_MESSAGE_BYTES + 1];
};

static void on_alarm(int signal_number) { (void)signal_number; }

/* msgrcv has no time-out: a timer interrupts it, and goes on doing so, in case the first came just before the wait. */
static void interrupt_after(double seconds) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_alarm; /* no SA_RESTART: the call ends with EINTR */
  sigaction(SIGALRM, &action, NULL);
  struct itimerval timer;
  timer.it_value.tv_sec = (time_t)seconds;
  timer.it_value.tv_usec = (suseconds_t)((seconds - (double)timer.it_value.tv_sec) * 1e6) + 1;
  timer.it_interval.tv_sec = 0;
  timer.it_interval.tv_usec = 100000;
  setitimer(ITIMER_REAL, &timer, NULL);
}

static int failed(const char* what) {
  if (errno == EINTR) {
    fprintf(stderr, "send_command: no answer in time; the command may still be executed\n");
  } else if (errno == ENOENT) {
    fprintf(stderr, "send_command: no gateway is running (%s)\n", what);
  } else if (errno == EIDRM) {
    fprintf(stderr, "send_command: the gateway ended before it answered\n");
  } else {
    fprintf(stderr, "send_command: %s: %s\n", what, strerror(errno));
  }
  return 1;
}

int main(int argc, char** argv) {
  key_t script_key = CELLMIRROR_SCRIPT_KEY, reply_key = CELLMIRROR_REPLY_KEY;
  double timeout = 5.0;
  const char* command = NULL;
  for (int i = 1; i < argc; ++i) {
    if (strcmp(argv[i], "--help") == 0) {
      fputs(kUsage, stdout);
      return 0;
    } else if (strcmp(argv[i], "--timeout") == 0 && i + 1 < argc) {
      timeout = atof(argv[++i]);
    } else if (strcmp(argv[i], "--script-key") == 0 && i + 1 < argc) {
      script_key = (key_t)strtol(argv[++i], NULL, 0);
    } else if (strcmp(argv[i], "--reply-key") == 0 && i + 1 < argc) {
      reply_key = (key_t)strtol(argv[++i], NULL, 0);
    } else if (command == NULL && strncmp(argv[i], "--", 2) != 0) {
      command = argv[i];
    } else {
      command = NULL;
      break;
    }
  }
  if (command == NULL || timeout <= 0) {
    fputs(kUsage, stderr);
    return 2;
  }

  const int queue = msgget(script_key, 0);
  if (queue < 0) return failed("the queue of commands");
  const int replies = msgget(reply_key, 0);
  if (replies < 0) return failed("the queue of replies");

  /* Any number from 1 to 2147483647 that nobody else uses now. A process is alone with its own. */
  const long tag = (long)getpid();
  struct Message message;
  message.type = CELLMIRROR_MESSAGE_TYPE;
  const int length = snprintf(message.text, sizeof message.text, "@%ld %s", tag, command);
  if (length < 0 || (unsigned)length > CELLMIRROR_MAX_MESSAGE_BYTES) {
    fprintf(stderr, "send_command: the command is too long\n");
    return 1;
  }

  /* A reply to an earlier process of this number could still be there. */
  struct Message reply;
  while (msgrcv(replies, &reply, CELLMIRROR_MAX_MESSAGE_BYTES, tag, IPC_NOWAIT | MSG_NOERROR) >= 0) {
  }

  interrupt_after(timeout);
  if (msgsnd(queue, &message, (size_t)length, 0) != 0) return failed("sending");
  const ssize_t got = msgrcv(replies, &reply, CELLMIRROR_MAX_MESSAGE_BYTES, tag, MSG_NOERROR);
  if (got < 0) return failed("receiving");
  reply.text[got] = '\0';
  puts(reply.text);
  return strncmp(reply.text, "done", 4) == 0 ? 0 : 1;
}
