/*
 * Prints the force at the TCP of the active robot (SET_EXT_TCP_TEST, SET_TORQUE_LIMIT), one line a change:
 *   sequence robot force x y z N torque t Nm valid|no force|beyond the limit|test
 *
 *   cc -o tcp_force_reader tcp_force_reader.c
 *   ./tcp_force_reader --count 10
 *
 * With --old it does what a program of 1999 does: reads four floats and knows nothing else.
 * SPDX-License-Identifier: Apache-2.0
 */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <time.h>

#include "cellmirror_haptic.h"

static const char* const kUsage =
    "usage: tcp_force_reader [--count N] [--timeout SECONDS] [--key KEY] [--old]\n"
    "Prints the force at the TCP as it changes: N times (default: without end), waiting at most SECONDS for a "
    "change.\n";

/* The gateway may be held up for a moment by other work of the machine. */
#define SILENCE_NS 1000000000

/* 1 kHz is enough for monitoring. */
static void pause_a_little(void) {
  const struct timespec millisecond = {0, 1000000};
  nanosleep(&millisecond, NULL);
}

static int64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void print_force(const struct cellmirror_tcp_force* force) {
  printf("%llu %s force %.3f %.3f %.3f N torque %.3f Nm %s%s%s\n", (unsigned long long)force->sequence,
         force->robot[0] == '\0' ? "-" : force->robot, (double)force->values[0], (double)force->values[1],
         (double)force->values[2], (double)force->values[3],
         force->flags & CELLMIRROR_TCP_FORCE_VALID ? "valid" : "no force",
         force->flags & CELLMIRROR_TCP_FORCE_BEYOND_LIMIT ? " beyond the limit" : "",
         force->flags & CELLMIRROR_TCP_FORCE_TEST ? " test" : "");
  fflush(stdout);
}

int main(int argc, char** argv) {
  key_t key = CELLMIRROR_TCP_FORCE_KEY;
  long count = 0;
  double timeout = 0;
  int old = 0;
  for (int i = 1; i < argc; ++i) {
    if (strcmp(argv[i], "--help") == 0) {
      fputs(kUsage, stdout);
      return 0;
    } else if (strcmp(argv[i], "--count") == 0 && i + 1 < argc) {
      count = strtol(argv[++i], NULL, 0);
    } else if (strcmp(argv[i], "--timeout") == 0 && i + 1 < argc) {
      timeout = strtod(argv[++i], NULL);
    } else if (strcmp(argv[i], "--key") == 0 && i + 1 < argc) {
      key = (key_t)strtoll(argv[++i], NULL, 0);
    } else if (strcmp(argv[i], "--old") == 0) {
      old = 1;
    } else {
      fputs(kUsage, stderr);
      return 2;
    }
  }
  const int id = shmget(key, 0, 0);
  struct shmid_ds found;
  if (id < 0 || shmctl(id, IPC_STAT, &found) != 0) {
    fprintf(stderr, "tcp_force_reader: no gateway is running: %s\n", strerror(errno));
    return 1;
  }
  const void* memory = shmat(id, NULL, SHM_RDONLY);
  if (memory == (void*)-1) {
    fprintf(stderr, "tcp_force_reader: %s\n", strerror(errno));
    return 1;
  }
  if (old) {
    const volatile float* values = (const volatile float*)memory;
    printf("%.3f %.3f %.3f %.3f\n", (double)values[0], (double)values[1], (double)values[2], (double)values[3]);
    return 0;
  }
  struct cellmirror_tcp_force force;
  uint64_t last = 0;
  double waited = 0;
  int64_t current = now_ns(); /* when a living gateway was last seen behind the force */
  for (long printed = 0; count == 0 || printed < count;) {
    const int got = cellmirror_read_tcp_force(memory, found.shm_segsz, &force);
    const int good = got && cellmirror_tcp_force_is_current(&force, now_ns(), CELLMIRROR_TCP_FORCE_MOST_AGE_NS);
    if (good) current = now_ns();
    if (good && force.sequence != last) {
      last = force.sequence;
      waited = 0;
      print_force(&force);
      ++printed;
      continue;
    }
    if (shmget(key, 0, 0) != id) {
      fprintf(stderr, "tcp_force_reader: the gateway ended\n");
      return 1;
    }
    if (now_ns() - current > SILENCE_NS) {
      fprintf(stderr, "tcp_force_reader: the gateway no longer writes: it was killed, or hangs\n");
      return 1;
    }
    pause_a_little();
    waited += 1e-3;
    if (timeout > 0 && waited > timeout) {
      fprintf(stderr, "tcp_force_reader: no change in time\n");
      return 1;
    }
  }
  return 0;
}
