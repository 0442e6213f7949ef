/*
 * The messages of cellmirror for C programs (C99 and later, C++ too). Nothing but this file is needed.
 *
 * docs/messages.md says what the numbers mean. All numbers of a record are little-endian: on a little-endian machine a
 * received record may be copied into the structs below; elsewhere read the bytes at the CELLMIRROR_*_OFFSET_* places.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef CELLMIRROR_MESSAGES_H
#define CELLMIRROR_MESSAGES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Keys of the instance "default". Another instance prints its own: cellmirror status. */
#define CELLMIRROR_SCRIPT_KEY 2351 /* commands to the gateway */
#define CELLMIRROR_SENSOR_KEY 1990 /* records from the gateway */
#define CELLMIRROR_REPLY_KEY 2352  /* replies to commands */

#define CELLMIRROR_MESSAGE_TYPE 5L         /* of commands and records */
#define CELLMIRROR_MAX_MESSAGE_BYTES 8192u /* of the text of one message */
#define CELLMIRROR_MAX_REPLY_BYTES 4096u
#define CELLMIRROR_MAX_TAG 2147483647L

#define CELLMIRROR_RECORD_MAGIC 0x52494D43u /* the bytes "CMIR" */
#define CELLMIRROR_RECORD_VERSION 1u
#define CELLMIRROR_KIND_ROBOT 1u
#define CELLMIRROR_KIND_RANGE 2u       /* reserved */
#define CELLMIRROR_KIND_RANGE_ARRAY 3u /* reserved */
#define CELLMIRROR_KIND_CAMERA 4u      /* reserved */

#define CELLMIRROR_NAME_BYTES 64 /* with at least one NUL */
#define CELLMIRROR_MAX_JOINTS 16

/* Byte offsets in a record. */
#define CELLMIRROR_HEADER_OFFSET_MAGIC 0
#define CELLMIRROR_HEADER_OFFSET_VERSION 4
#define CELLMIRROR_HEADER_OFFSET_KIND 6
#define CELLMIRROR_HEADER_OFFSET_LENGTH 8
#define CELLMIRROR_HEADER_OFFSET_SEQUENCE 16
#define CELLMIRROR_HEADER_OFFSET_TIME_NS 24
#define CELLMIRROR_HEADER_OFFSET_WALL_TIME_NS 32
#define CELLMIRROR_HEADER_BYTES 40

#define CELLMIRROR_ROBOT_OFFSET_ID 40
#define CELLMIRROR_ROBOT_OFFSET_ONLINE 104
#define CELLMIRROR_ROBOT_OFFSET_STATE 105
#define CELLMIRROR_ROBOT_OFFSET_JOINT_COUNT 106
#define CELLMIRROR_ROBOT_OFFSET_SAMPLE_SEQUENCE 112
#define CELLMIRROR_ROBOT_OFFSET_BASE_TCP 120
#define CELLMIRROR_ROBOT_OFFSET_WORLD_TCP 176
#define CELLMIRROR_ROBOT_OFFSET_JOINTS 232

/* Byte offsets in a joint. */
#define CELLMIRROR_JOINT_OFFSET_NAME 0
#define CELLMIRROR_JOINT_OFFSET_KIND 64
#define CELLMIRROR_JOINT_OFFSET_STATE 65
#define CELLMIRROR_JOINT_OFFSET_POSITION 72
#define CELLMIRROR_JOINT_OFFSET_VELOCITY 80
#define CELLMIRROR_JOINT_OFFSET_EFFORT 88
#define CELLMIRROR_JOINT_OFFSET_AGE_S 96
#define CELLMIRROR_JOINT_OFFSET_SOURCE_AGE_S 104
#define CELLMIRROR_JOINT_BYTES 112

/* State of a robot's or joint's data. */
enum cellmirror_state {
  CELLMIRROR_STATE_NONE = 0,
  CELLMIRROR_STATE_FRESH = 1,
  CELLMIRROR_STATE_STALE = 2,
  CELLMIRROR_STATE_LOST = 3,
  CELLMIRROR_STATE_INVALID = 4
};

enum cellmirror_joint_kind {
  CELLMIRROR_JOINT_REVOLUTE = 0,
  CELLMIRROR_JOINT_CONTINUOUS = 1,
  CELLMIRROR_JOINT_PRISMATIC = 2
};

struct cellmirror_header {
  uint32_t magic;
  uint16_t version;
  uint16_t kind;
  uint32_t length; /* bytes of the whole record */
  uint32_t reserved;
  uint64_t sequence;    /* from 1; a gap: records were dropped or read by another program */
  int64_t time_ns;      /* CLOCK_MONOTONIC */
  int64_t wall_time_ns; /* since 1970 */
};

struct cellmirror_pose {
  double position[3];   /* m */
  double quaternion[4]; /* x, y, z, w */
};

struct cellmirror_joint {
  char name[CELLMIRROR_NAME_BYTES];
  uint8_t kind;
  uint8_t state;
  uint8_t reserved[6];
  double position;     /* rad or m */
  double velocity;     /* rad/s or m/s */
  double effort;       /* Nm or N */
  double age_s;        /* since it was received; NaN: never */
  double source_age_s; /* since the source's own stamp; NaN: it has none */
};

struct cellmirror_robot {
  struct cellmirror_header header;
  char id[CELLMIRROR_NAME_BYTES];
  uint8_t online;
  uint8_t state;
  uint16_t joint_count;
  uint32_t reserved;
  uint64_t sample_sequence;
  struct cellmirror_pose base_tcp;
  struct cellmirror_pose world_tcp;
  struct cellmirror_joint joints[CELLMIRROR_MAX_JOINTS]; /* joint_count of them are sent */
};

/* Copies a robot record out of a received message. 1: done; 0: the bytes are no robot record of this version. */
static inline int cellmirror_read_robot(const void* message, size_t bytes, struct cellmirror_robot* robot) {
  if (bytes < CELLMIRROR_ROBOT_OFFSET_JOINTS || bytes > sizeof *robot) return 0;
  memset(robot, 0, sizeof *robot);
  memcpy(robot, message, bytes);
  if (robot->header.magic != CELLMIRROR_RECORD_MAGIC || robot->header.version != CELLMIRROR_RECORD_VERSION ||
      robot->header.kind != CELLMIRROR_KIND_ROBOT || robot->header.length != bytes ||
      robot->joint_count > CELLMIRROR_MAX_JOINTS) {
    return 0;
  }
  robot->id[CELLMIRROR_NAME_BYTES - 1] = '\0';
  return bytes == CELLMIRROR_ROBOT_OFFSET_JOINTS + (size_t)robot->joint_count * CELLMIRROR_JOINT_BYTES;
}

static inline const char* cellmirror_state_name(unsigned state) {
  static const char* const names[] = {"none", "fresh", "stale", "lost", "invalid"};
  return state < 5 ? names[state] : "unknown";
}

#endif
