/*
 * Prints the robot-parameter records of a running cellmirror (ROBOT <id> send_on), one a line:
 *   sequence robot online|offline state joint=position ... tcp x y z
 *
 *   cc -o sensor_reader sensor_reader.c
 *   ./sensor_reader --count 10
 *
 * A record that was read is gone from the queue: there is one reader. SPDX-License-Identifier: Apache-2.0
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
#include <unistd.h>

#include "cellmirror_messages.h"

static const char* const kUsage =
    "usage: sensor_reader [--count N] [--timeout SECONDS] [--key KEY]\n"
    "Prints robot-parameter records as they come: N of them (default: without end), waiting at most SECONDS (default: "
    "for\n"
    "ever) for each.\n";

struct Message {
  long type;
  unsigned char text[CELLMIRROR_MAX_MESSAGE_BYTES];
};

static void on_alarm(int signal_number) { (void)signal_number; }

static void print_robot(const struct cellmirror_robot* robot) {
  printf("%llu %s %s %s", (unsigned long long)robot->header.sequence, robot->id, robot->online ? "online" : "offline",
         cellmirror_state_name(robot->state));
  for (unsigned i = 0; i < robot->joint_count; ++i) {
    printf(" %.*s=%.6f", CELLMIRROR_NAME_BYTES - 1, robot->joints[i].name, robot->joints[i].position);
  }
  printf(" tcp %.6f %.6f %.6f\n", robot->world_tcp.position[0], robot->world_tcp.position[1],
         robot->world_tcp.position[2]);
  fflush(stdout);
}

int main(int argc, char** argv) {
  key_t key = CELLMIRROR_SENSOR_KEY;
  long count = 0;
  unsigned timeout = 0;
  for (int i = 1; i < argc; ++i) {
    if (strcmp(argv[i], "--help") == 0) {
      fputs(kUsage, stdout);
      return 0;
    } else if (strcmp(argv[i], "--count") == 0 && i + 1 < argc) {
      count = strtol(argv[++i], NULL, 0);
    } else if (strcmp(argv[i], "--timeout") == 0 && i + 1 < argc) {
      timeout = (unsigned)strtoul(argv[++i], NULL, 0);
    } else if (strcmp(argv[i], "--key") == 0 && i + 1 < argc) {
      key = (key_t)strtol(argv[++i], NULL, 0);
    } else {
      fputs(kUsage, stderr);
      return 2;
    }
  }
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_alarm; /* no SA_RESTART: msgrcv ends with EINTR */
  sigaction(SIGALRM, &action, NULL);

  const int queue = msgget(key, 0);
  if (queue < 0) {
    fprintf(stderr, "sensor_reader: no gateway is running: %s\n", strerror(errno));
    return 1;
  }
  for (long printed = 0; count == 0 || printed < count;) {
    struct Message message;
    struct cellmirror_robot robot;
    alarm(timeout);
    const ssize_t got = msgrcv(queue, &message, sizeof message.text, CELLMIRROR_MESSAGE_TYPE, MSG_NOERROR);
    if (got < 0) {
      /* EIDRM: the gateway ended. A long-running reader waits a second and begins again with msgget. */
      fprintf(stderr, "sensor_reader: %s\n", errno == EINTR ? "no record in time" : strerror(errno));
      return 1;
    }
    if (!cellmirror_read_robot(message.text, (size_t)got, &robot)) continue; /* another kind of record */
    print_robot(&robot);
    ++printed;
  }
  return 0;
}
