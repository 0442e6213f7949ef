/*
 * The shared memories of cellmirror for C programs (C99 and later, C++ too; GCC or Clang, little-endian). Nothing but
 * this file is needed.
 *
 * docs/shared-memory.md says what the numbers mean. Two programs use a block at the same time: read and write it by the
 * functions below, never field by field, or what you read may be half of one write and half of the next.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef CELLMIRROR_HAPTIC_H
#define CELLMIRROR_HAPTIC_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The force at the TCP of the active robot. The keys of haptic devices stand in the cell file or in rob_ela_shm. */
#define CELLMIRROR_TCP_FORCE_KEY 1313

#define CELLMIRROR_HAPTIC_MAGIC 0x50484D43u    /* the bytes "CMHP" */
#define CELLMIRROR_TCP_FORCE_MAGIC 0x46544D43u /* the bytes "CMTF" */
#define CELLMIRROR_HAPTIC_VERSION 1u
#define CELLMIRROR_TCP_FORCE_VERSION 1u
#define CELLMIRROR_HAPTIC_BYTES 512u
#define CELLMIRROR_TCP_FORCE_BYTES 192u
#define CELLMIRROR_HAPTIC_JOINTS 16
#define CELLMIRROR_HAPTIC_AXES 7

#define CELLMIRROR_HAPTIC_GOOD 1u /* of device_flags: the device's own word that its values are good */

#define CELLMIRROR_TCP_FORCE_VALID 1u        /* something tells of a force at this robot's TCP */
#define CELLMIRROR_TCP_FORCE_TEST 2u         /* the values of SET_EXT_TCP_TEST */
#define CELLMIRROR_TCP_FORCE_BEYOND_LIMIT 4u /* of SET_TORQUE_LIMIT */

/* What the gateway writes: the first 320 bytes of a haptic device's memory. */
struct cellmirror_haptic_force {
  float force[3];         /* N, on the hand, in the instrument's end-effector frame */
  float joint_torque[16]; /* Nm or N, of the robot's joints; the rest 0 */
  uint8_t unused_1[52];
  uint32_t magic;
  uint16_t version;
  uint16_t joint_count;
  uint32_t bytes;
  uint32_t gateway; /* its process id; 0: it has ended */
  uint64_t lock;    /* odd while it is being written */
  uint64_t sequence;
  int64_t time_ns; /* CLOCK_MONOTONIC */
  int64_t period_ns;
  uint64_t answers; /* sequence of the sample that the force was computed from */
  uint32_t phase;
  uint32_t fault;
  double force_device[3];  /* N, on the hand, in the device's base frame: what a device renders */
  double torque_device[3]; /* Nm */
  double gripper_torque;   /* Nm, positive opens */
  double max_force;        /* N */
  uint8_t unused_2[64];
};

/* What the device's process writes: the bytes 320 to 511. */
struct cellmirror_haptic_sample {
  uint64_t lock; /* odd while it is being written; kept by cellmirror_write_sample() */
  uint64_t sequence;
  int64_t time_ns; /* CLOCK_MONOTONIC, of the measurement */
  uint32_t process;
  uint32_t flags; /* CELLMIRROR_HAPTIC_GOOD */
  uint32_t buttons;
  uint32_t axis_count;
  double position[3];    /* m, of the handle in the device's base frame */
  double orientation[4]; /* quaternion x y z w */
  double gripper;        /* rad, 0: closed */
  double axes[7];        /* rad or m */
  uint8_t unused[32];
};

/* The force at the TCP: the memory CELLMIRROR_TCP_FORCE_KEY. */
struct cellmirror_tcp_force {
  float values[4]; /* force x, y, z, N, in the end-effector frame; torque about the tool axis, Nm */
  uint8_t unused_1[48];
  uint32_t magic;
  uint16_t version;
  uint16_t bytes;
  uint64_t lock;
  uint64_t sequence;
  int64_t time_ns;
  uint32_t flags;
  uint32_t process; /* of the gateway; 0: it has ended */
  char robot[64];
  uint8_t unused_2[24];
};

/* Byte offsets from the beginning of the memory, for other languages. */
#define CELLMIRROR_HAPTIC_OFFSET_FORCE 0
#define CELLMIRROR_HAPTIC_OFFSET_JOINT_TORQUE 12
#define CELLMIRROR_HAPTIC_OFFSET_MAGIC 128
#define CELLMIRROR_HAPTIC_OFFSET_VERSION 132
#define CELLMIRROR_HAPTIC_OFFSET_JOINT_COUNT 134
#define CELLMIRROR_HAPTIC_OFFSET_BYTES 136
#define CELLMIRROR_HAPTIC_OFFSET_GATEWAY 140
#define CELLMIRROR_HAPTIC_OFFSET_FORCE_LOCK 144
#define CELLMIRROR_HAPTIC_OFFSET_FORCE_SEQUENCE 152
#define CELLMIRROR_HAPTIC_OFFSET_FORCE_TIME_NS 160
#define CELLMIRROR_HAPTIC_OFFSET_PERIOD_NS 168
#define CELLMIRROR_HAPTIC_OFFSET_ANSWERS 176
#define CELLMIRROR_HAPTIC_OFFSET_PHASE 184
#define CELLMIRROR_HAPTIC_OFFSET_FAULT 188
#define CELLMIRROR_HAPTIC_OFFSET_FORCE_DEVICE 192
#define CELLMIRROR_HAPTIC_OFFSET_TORQUE_DEVICE 216
#define CELLMIRROR_HAPTIC_OFFSET_GRIPPER_TORQUE 240
#define CELLMIRROR_HAPTIC_OFFSET_MAX_FORCE 248
#define CELLMIRROR_HAPTIC_OFFSET_DEVICE_LOCK 320
#define CELLMIRROR_HAPTIC_OFFSET_DEVICE_SEQUENCE 328
#define CELLMIRROR_HAPTIC_OFFSET_DEVICE_TIME_NS 336
#define CELLMIRROR_HAPTIC_OFFSET_DEVICE_PROCESS 344
#define CELLMIRROR_HAPTIC_OFFSET_DEVICE_FLAGS 348
#define CELLMIRROR_HAPTIC_OFFSET_BUTTONS 352
#define CELLMIRROR_HAPTIC_OFFSET_AXIS_COUNT 356
#define CELLMIRROR_HAPTIC_OFFSET_POSITION 360
#define CELLMIRROR_HAPTIC_OFFSET_ORIENTATION 384
#define CELLMIRROR_HAPTIC_OFFSET_GRIPPER 416
#define CELLMIRROR_HAPTIC_OFFSET_AXES 424

#define CELLMIRROR_TCP_FORCE_OFFSET_VALUES 0
#define CELLMIRROR_TCP_FORCE_OFFSET_MAGIC 64
#define CELLMIRROR_TCP_FORCE_OFFSET_VERSION 68
#define CELLMIRROR_TCP_FORCE_OFFSET_BYTES 70
#define CELLMIRROR_TCP_FORCE_OFFSET_LOCK 72
#define CELLMIRROR_TCP_FORCE_OFFSET_SEQUENCE 80
#define CELLMIRROR_TCP_FORCE_OFFSET_TIME_NS 88
#define CELLMIRROR_TCP_FORCE_OFFSET_FLAGS 96
#define CELLMIRROR_TCP_FORCE_OFFSET_PROCESS 100
#define CELLMIRROR_TCP_FORCE_OFFSET_ROBOT 104

#if defined(__cplusplus)
#define CELLMIRROR_HAPTIC_CHECK(condition) static_assert(condition, #condition)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define CELLMIRROR_HAPTIC_CHECK(condition) _Static_assert(condition, #condition)
#else /* C99: an array of negative size is refused */
#define CELLMIRROR_HAPTIC_CHECK(condition) extern int cellmirror_haptic_check[(condition) ? 1 : -1]
#endif
CELLMIRROR_HAPTIC_CHECK(sizeof(struct cellmirror_haptic_force) == CELLMIRROR_HAPTIC_OFFSET_DEVICE_LOCK);
CELLMIRROR_HAPTIC_CHECK(sizeof(struct cellmirror_haptic_force) + sizeof(struct cellmirror_haptic_sample) ==
                        CELLMIRROR_HAPTIC_BYTES);
CELLMIRROR_HAPTIC_CHECK(sizeof(struct cellmirror_tcp_force) == CELLMIRROR_TCP_FORCE_BYTES);

#define CELLMIRROR_HAPTIC_TRIES 100

/* Not for users: copies a section of whole words that the other side guards by a lock. `lock` counts in words. 1: the
 * copy is of one write; 0: every try met the other side writing. Acquire keeps the loads in this order. */
static inline int cellmirror_copy_section(const void* memory, size_t words, size_t lock, void* copy) {
  const uint64_t* from = (const uint64_t*)memory;
  unsigned char* to = (unsigned char*)copy;
  for (int i = 0; i < CELLMIRROR_HAPTIC_TRIES; ++i) {
    const uint64_t before = __atomic_load_n(from + lock, __ATOMIC_ACQUIRE);
    if (before % 2 != 0) continue;
    for (size_t word = 0; word < words; ++word) {
      const uint64_t value = __atomic_load_n(from + word, __ATOMIC_ACQUIRE);
      memcpy(to + 8 * word, &value, 8);
    }
    if (__atomic_load_n(from + lock, __ATOMIC_ACQUIRE) == before) return 1;
  }
  return 0;
}

/* 1: `force` is the gateway's answer. 0: the memory holds no block of this version, or the gateway was writing in every
 * try (or died doing so): treat it as "no force". `bytes`: of the memory (shmctl IPC_STAT). Look at force->time_ns:
 * do not render a force that is older than some milliseconds. */
static inline int cellmirror_read_force(const void* memory, size_t bytes, struct cellmirror_haptic_force* force) {
  if (bytes < CELLMIRROR_HAPTIC_BYTES) return 0;
  if (!cellmirror_copy_section(memory, sizeof *force / 8, CELLMIRROR_HAPTIC_OFFSET_FORCE_LOCK / 8, force)) return 0;
  return force->magic == CELLMIRROR_HAPTIC_MAGIC && force->version == CELLMIRROR_HAPTIC_VERSION;
}

/* The same for the force at the TCP. */
static inline int cellmirror_read_tcp_force(const void* memory, size_t bytes, struct cellmirror_tcp_force* force) {
  if (bytes < CELLMIRROR_TCP_FORCE_BYTES) return 0;
  if (!cellmirror_copy_section(memory, sizeof *force / 8, CELLMIRROR_TCP_FORCE_OFFSET_LOCK / 8, force)) return 0;
  force->robot[sizeof force->robot - 1] = '\0';
  return force->magic == CELLMIRROR_TCP_FORCE_MAGIC && force->version == CELLMIRROR_TCP_FORCE_VERSION;
}

/* Writes a sample; sample->lock is ignored, the lock goes on from where an earlier process left it. One writer. 0: the
 * memory is too small. */
static inline int cellmirror_write_sample(void* memory, size_t bytes, const struct cellmirror_haptic_sample* sample) {
  if (bytes < CELLMIRROR_HAPTIC_BYTES) return 0;
  uint64_t* to = (uint64_t*)memory + CELLMIRROR_HAPTIC_OFFSET_DEVICE_LOCK / 8;
  const uint64_t odd = __atomic_load_n(to, __ATOMIC_ACQUIRE) | 1u;
  __atomic_store_n(to, odd, __ATOMIC_RELEASE);
  for (size_t word = 1; word < sizeof *sample / 8; ++word) {
    uint64_t value;
    memcpy(&value, (const unsigned char*)sample + 8 * word, 8);
    __atomic_store_n(to + word, value, __ATOMIC_RELEASE); /* release: after the odd lock */
  }
  __atomic_store_n(to, odd + 1, __ATOMIC_RELEASE);
  return 1;
}

/* Whether a living gateway stands behind what was read: only then render it. A gateway that ends, or whose death its
 * guard has seen, leaves the process number 0. One that was killed together with its guard leaves its last force and
 * its number behind, but its time stands still: `now_ns` is CLOCK_MONOTONIC, `most_ns` the greatest age, at least some
 * periods of the loop (10 ms at 1 kHz). A time in the future is that of another machine, or of before a restart. */
#define CELLMIRROR_FORCE_MOST_AGE_NS 10000000
static inline int cellmirror_is_current(uint32_t gateway, int64_t time_ns, int64_t now_ns, int64_t most_ns) {
  return gateway != 0 && time_ns > 0 && time_ns <= now_ns && now_ns - time_ns <= most_ns;
}
static inline int cellmirror_force_is_current(const struct cellmirror_haptic_force* force, int64_t now_ns,
                                              int64_t most_ns) {
  return cellmirror_is_current(force->gateway, force->time_ns, now_ns, most_ns);
}
/* The TCP force is for monitoring and written by an ordinary thread: allow 100 ms. */
#define CELLMIRROR_TCP_FORCE_MOST_AGE_NS 100000000
static inline int cellmirror_tcp_force_is_current(const struct cellmirror_tcp_force* force, int64_t now_ns,
                                                  int64_t most_ns) {
  return cellmirror_is_current(force->process, force->time_ns, now_ns, most_ns);
}

/* "unknown" for a number that this header does not know. */
static inline const char* cellmirror_phase_name(uint32_t phase) {
  static const char* const kNames[] = {"closed", "waiting", "clutched", "engaging", "active", "faulted"};
  return phase < sizeof kNames / sizeof kNames[0] ? kNames[phase] : "unknown";
}

static inline const char* cellmirror_fault_name(uint32_t fault) {
  static const char* const kNames[] = {"none",        "stale", "vanished",  "not_finite",  "invalid",    "jump",
                                       "two_writers", "torn",  "late_tick", "stale_model", "not_passive"};
  return fault < sizeof kNames / sizeof kNames[0] ? kNames[fault] : "unknown";
}

#endif
