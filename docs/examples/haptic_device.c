/*
 * A haptic device without hardware: moves its handle on a slow circle, writes the pose at 1 kHz into the memory that it
 * shares with a running cellmirror, reads the force that comes back, and prints one line a tenth of a second:
 *   sequence phase fault force x y z N age MICROSECONDS us
 *
 *   cc -o haptic_device haptic_device.c -lm
 *   ./haptic_device --key 1401 --seconds 10
 *   ./haptic_device --key 1401 --seconds 10 --to 0.0469,0.0294,-0.0605     (there and back, every 4 s)
 *
 * The hand rests for a second and a half first: a gateway that has lost a device before engages the next one at rest.
 * A driver of real hardware looks the same: replace measure() and render(). SPDX-License-Identifier: Apache-2.0
 */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <time.h>
#include <unistd.h>

#include "cellmirror_haptic.h"

#define PERIOD_NS 1000000L
/* A force that is older is not rendered: the gateway has ended, or is late. */
#define OLDEST_NS 5000000L
#define REST_S 1.5
#define THERE_AND_BACK_S 4.0
#define TWO_PI 6.283185307179586

static const char* const kUsage =
    "usage: haptic_device --key KEY [--seconds SECONDS] [--radius METRES] [--to X,Y,Z]\n"
    "Writes poses into the gateway's shared memory and prints the forces that come back.\n";

static int64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

struct Attached {
  int id;
  size_t bytes;
  void* memory; /* NULL: not attached */
};

static int attach(struct Attached* attached, key_t key) {
  struct shmid_ds found;
  attached->memory = NULL;
  attached->id = shmget(key, 0, 0);
  if (attached->id < 0 || shmctl(attached->id, IPC_STAT, &found) != 0) return 0;
  attached->bytes = found.shm_segsz;
  void* memory = shmat(attached->id, NULL, 0);
  if (memory == (void*)-1) return 0;
  attached->memory = memory;
  return 1;
}

static void detach(struct Attached* attached) {
  shmdt(attached->memory);
  attached->memory = NULL;
}

/* The gateway has removed the memory: nobody who looks for the key finds this one any longer. */
static int is_removed(const struct Attached* attached, key_t key) { return shmget(key, 0, 0) != attached->id; }

struct Motion {
  double radius; /* m, of the circle */
  int to_is_given;
  double to[3]; /* m, in the device's axes */
};

static void measure(struct cellmirror_haptic_sample* sample, double seconds, const struct Motion* motion) {
  const double moving = seconds > REST_S ? seconds - REST_S : 0;
  if (motion->to_is_given) {
    const double share = 0.5 - 0.5 * cos(TWO_PI * moving / THERE_AND_BACK_S);
    for (int i = 0; i < 3; ++i) sample->position[i] = share * motion->to[i];
  } else {
    sample->position[0] = motion->radius * cos(moving);
    sample->position[1] = motion->radius * sin(moving);
    sample->position[2] = 0;
  }
  sample->orientation[3] = 1; /* x y z w */
  sample->flags = CELLMIRROR_HAPTIC_GOOD;
}

/* Newtons in the device's base frame, to the motors. */
static void render(const double force[3]) { (void)force; }

static int usage(void) {
  fputs(kUsage, stderr);
  return 2;
}

int main(int argc, char** argv) {
  key_t key = 0;
  double seconds = 0;
  struct Motion motion = {0.01, 0, {0, 0, 0}};
  for (int i = 1; i < argc; ++i) {
    if (strcmp(argv[i], "--help") == 0) {
      fputs(kUsage, stdout);
      return 0;
    } else if (strcmp(argv[i], "--key") == 0 && i + 1 < argc) {
      key = (key_t)strtoll(argv[++i], NULL, 0);
    } else if (strcmp(argv[i], "--seconds") == 0 && i + 1 < argc) {
      seconds = strtod(argv[++i], NULL);
    } else if (strcmp(argv[i], "--radius") == 0 && i + 1 < argc) {
      motion.radius = strtod(argv[++i], NULL);
    } else if (strcmp(argv[i], "--to") == 0 && i + 1 < argc) {
      motion.to_is_given = sscanf(argv[++i], "%lf,%lf,%lf", &motion.to[0], &motion.to[1], &motion.to[2]) == 3;
      if (!motion.to_is_given) return usage();
    } else {
      return usage();
    }
  }
  if (key == 0) return usage();

  struct Attached attached;
  if (!attach(&attached, key)) {
    fprintf(stderr, "haptic_device: no gateway is running: %s\n", strerror(errno));
    return 1;
  }
  struct cellmirror_haptic_sample sample;
  struct cellmirror_haptic_force force;
  memset(&sample, 0, sizeof sample);
  sample.process = (uint32_t)getpid();
  const int64_t start = now_ns();
  struct timespec next;
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (long step = 0; seconds <= 0 || now_ns() - start < (int64_t)(seconds * 1e9); ++step) {
    const double none[3] = {0, 0, 0};
    if (attached.memory != NULL) {
      measure(&sample, 1e-9 * (double)(now_ns() - start), &motion);
      sample.time_ns = now_ns();
      ++sample.sequence;
      if (!cellmirror_write_sample(attached.memory, attached.bytes, &sample)) {
        fprintf(stderr, "haptic_device: %zu bytes are too few for poses: set 512 in the cell file\n", attached.bytes);
        return 1;
      }
      const int got = cellmirror_read_force(attached.memory, attached.bytes, &force);
      const int64_t age = got ? now_ns() - force.time_ns : 0;
      const int good = got && cellmirror_force_is_current(&force, now_ns(), OLDEST_NS);
      render(good ? force.force_device : none);
      if (step % 100 == 0 && got) {
        printf("%llu %s %s force %.3f %.3f %.3f N age %lld us%s\n", (unsigned long long)force.sequence,
               cellmirror_phase_name(force.phase), cellmirror_fault_name(force.fault), force.force_device[0],
               force.force_device[1], force.force_device[2], (long long)(age / 1000), good ? "" : ", not rendered");
        fflush(stdout);
      }
    } else {
      render(none);
    }
    /* Every half second, since it is a system call: has the gateway gone, is it there again? */
    if (step % 500 == 499) {
      if (attached.memory != NULL && is_removed(&attached, key)) detach(&attached);
      if (attached.memory == NULL) attach(&attached, key);
    }
    next.tv_nsec += PERIOD_NS;
    if (next.tv_nsec >= 1000000000L) {
      next.tv_nsec -= 1000000000L;
      ++next.tv_sec;
    }
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL) == EINTR) {
    }
  }
  /* The device's last word: its values no longer count. */
  if (attached.memory != NULL) {
    sample.flags = 0;
    ++sample.sequence;
    sample.time_ns = now_ns();
    cellmirror_write_sample(attached.memory, attached.bytes, &sample);
    detach(&attached);
  }
  return 0;
}
