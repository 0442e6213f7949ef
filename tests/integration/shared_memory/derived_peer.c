/* Reads outputs, or writes samples, of which every number is derived from the sequence (derived_block.hpp).
 *   derived_peer read KEY LAST MANY   until sequence LAST was seen; prints "enough" once it saw MANY different blocks,
 * and at its end "whole N retried N inconsistent N last N" derived_peer write KEY LAST       samples 1 to LAST, about a
 * million a second */
#define _XOPEN_SOURCE 700
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <time.h>
#include <unistd.h>

#include "docs/examples/cellmirror_haptic.h"

static int is_derived(const struct cellmirror_haptic_force* force) {
  const double value = (double)(force->sequence % 4096);
  int good = force->answers == force->sequence && force->time_ns == (int64_t)force->sequence &&
             force->period_ns == force->time_ns && force->phase == (uint32_t)force->sequence &&
             force->fault == force->phase && force->gripper_torque == value && force->max_force == value;
  for (int i = 0; i < 3; ++i) {
    good =
        good && force->force[i] == (float)value && force->force_device[i] == value && force->torque_device[i] == value;
  }
  for (int i = 0; i < 16; ++i) good = good && force->joint_torque[i] == (float)value;
  return good;
}

static int read_all(const void* memory, size_t bytes, uint64_t last, unsigned long long many) {
  unsigned long long whole = 0, retried = 0, inconsistent = 0, unchanged = 0;
  uint64_t newest = 0;
  struct cellmirror_haptic_force force;
  const time_t end = time(NULL) + 300;
  memset(&force, 0, sizeof force);
  puts("ready");
  fflush(stdout);
  while (force.sequence < last && time(NULL) < end) {
    if (!cellmirror_read_force(memory, bytes, &force)) {
      ++retried;
      continue;
    }
    if (force.sequence == 0) continue;
    if (force.sequence < newest) ++inconsistent;
    if (force.sequence > newest && ++whole == many) {
      puts("enough");
      fflush(stdout);
    }
    unchanged = force.sequence == newest ? unchanged + 1 : 0;
    if (unchanged % 100 == 99) sched_yield(); /* where both have one processor, the other one's turn brings news */
    newest = force.sequence;
    if (!is_derived(&force)) ++inconsistent;
  }
  printf("whole %llu retried %llu inconsistent %llu last %llu\n", whole, retried, inconsistent,
         (unsigned long long)force.sequence);
  return 0;
}

static int64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int write_all(void* memory, size_t bytes, uint64_t last) {
  struct cellmirror_haptic_sample sample;
  memset(&sample, 0, sizeof sample);
  sample.process = (uint32_t)getpid();
  sample.flags = CELLMIRROR_HAPTIC_GOOD;
  sample.axis_count = 7;
  int64_t next = now_ns();
  for (uint64_t i = 1; i <= last; ++i) {
    const double value = (double)i;
    sample.sequence = i;
    sample.time_ns = (int64_t)i;
    sample.buttons = (uint32_t)i;
    for (int k = 0; k < 3; ++k) sample.position[k] = value;
    for (int k = 0; k < 4; ++k) sample.orientation[k] = value;
    sample.gripper = value;
    for (int k = 0; k < 7; ++k) sample.axes[k] = value;
    if (!cellmirror_write_sample(memory, bytes, &sample)) return 1;
    /* Without a pause the section would be odd nearly always. */
    for (next += 1000; now_ns() < next;) {
    }
  }
  return 0;
}

int main(int argc, char** argv) {
  const int reads = argc == 5 && strcmp(argv[1], "read") == 0;
  if (!reads && argc != 4) return 2;
  const int id = shmget((key_t)strtoll(argv[2], NULL, 0), 0, 0);
  struct shmid_ds found;
  if (id < 0 || shmctl(id, IPC_STAT, &found) != 0) return 1;
  const uint64_t last = strtoull(argv[3], NULL, 0);
  void* memory = shmat(id, NULL, reads ? SHM_RDONLY : 0);
  if (memory == (void*)-1) return 1;
  return reads ? read_all(memory, found.shm_segsz, last, strtoull(argv[4], NULL, 0))
               : write_all(memory, found.shm_segsz, last);
}
