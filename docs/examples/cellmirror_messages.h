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
#define CELLMIRROR_KIND_RANGE 2u
#define CELLMIRROR_KIND_RANGE_ARRAY 3u
#define CELLMIRROR_KIND_CAMERA 4u
#define CELLMIRROR_KIND_PROXIMITY 5u
#define CELLMIRROR_KIND_EVENT 6u
#define CELLMIRROR_KIND_TISSUE_EVENT 7u
#define CELLMIRROR_KIND_BARRIER 8u

#define CELLMIRROR_NAME_BYTES 64 /* with at least one NUL */
#define CELLMIRROR_PATH_BYTES 128
#define CELLMIRROR_MAX_JOINTS 16
#define CELLMIRROR_MAX_RANGES 72 /* of one record */
#define CELLMIRROR_MAX_PAIRS 10

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

#define CELLMIRROR_RANGE_OFFSET_ID 40
#define CELLMIRROR_RANGE_OFFSET_OBJECT 104
#define CELLMIRROR_RANGE_OFFSET_DISTANCE 232
#define CELLMIRROR_RANGE_OFFSET_RANGE 240
#define CELLMIRROR_RANGE_OFFSET_BLIND_ZONE 248
#define CELLMIRROR_RANGE_OFFSET_HALF_ANGLE 256
#define CELLMIRROR_RANGE_OFFSET_POINT 264
#define CELLMIRROR_RANGE_OFFSET_FLAGS 288
#define CELLMIRROR_RANGE_BYTES 296

#define CELLMIRROR_RANGE_ARRAY_OFFSET_PART 40
#define CELLMIRROR_RANGE_ARRAY_OFFSET_PARTS 42
#define CELLMIRROR_RANGE_ARRAY_OFFSET_COUNT 44
#define CELLMIRROR_RANGE_ARRAY_OFFSET_TOTAL 46
#define CELLMIRROR_RANGE_ARRAY_OFFSET_RANGES 48

/* Byte offsets in an entry of the array of ranges. */
#define CELLMIRROR_RANGE_ENTRY_OFFSET_ID 0
#define CELLMIRROR_RANGE_ENTRY_OFFSET_DISTANCE 64
#define CELLMIRROR_RANGE_ENTRY_OFFSET_RANGE 72
#define CELLMIRROR_RANGE_ENTRY_OFFSET_POINT 80
#define CELLMIRROR_RANGE_ENTRY_OFFSET_FLAGS 104
#define CELLMIRROR_RANGE_ENTRY_BYTES 112

#define CELLMIRROR_CAMERA_OFFSET_ID 40
#define CELLMIRROR_CAMERA_OFFSET_TRACKS 104
#define CELLMIRROR_CAMERA_OFFSET_POSE 232
#define CELLMIRROR_CAMERA_OFFSET_MOUNT 288
#define CELLMIRROR_CAMERA_OFFSET_PAN 344
#define CELLMIRROR_CAMERA_OFFSET_TILT 352
#define CELLMIRROR_CAMERA_OFFSET_FOCAL_DISTANCE 360
#define CELLMIRROR_CAMERA_OFFSET_FOVY 368
#define CELLMIRROR_CAMERA_OFFSET_FLAGS 376
#define CELLMIRROR_CAMERA_BYTES 384

#define CELLMIRROR_PROXIMITY_OFFSET_CHECK 40
#define CELLMIRROR_PROXIMITY_OFFSET_WARNING_DISTANCE 48
#define CELLMIRROR_PROXIMITY_OFFSET_COMPUTED_AFTER_S 56
#define CELLMIRROR_PROXIMITY_OFFSET_TESTED 64
#define CELLMIRROR_PROXIMITY_OFFSET_TOUCHING 68
#define CELLMIRROR_PROXIMITY_OFFSET_WITHIN_WARNING 72
#define CELLMIRROR_PROXIMITY_OFFSET_DOUBTS 76
#define CELLMIRROR_PROXIMITY_OFFSET_FOUND 80
#define CELLMIRROR_PROXIMITY_OFFSET_PAIR_COUNT 84
#define CELLMIRROR_PROXIMITY_OFFSET_PAIRS 88

/* Byte offsets in a pair. */
#define CELLMIRROR_PAIR_OFFSET_A 0
#define CELLMIRROR_PAIR_OFFSET_B 128
#define CELLMIRROR_PAIR_OFFSET_DISTANCE 256
#define CELLMIRROR_PAIR_OFFSET_DEPTH 264
#define CELLMIRROR_PAIR_OFFSET_POINT_A 272
#define CELLMIRROR_PAIR_OFFSET_POINT_B 296
#define CELLMIRROR_PAIR_OFFSET_NORMAL 320
#define CELLMIRROR_PAIR_OFFSET_CLOSING_SPEED 344
#define CELLMIRROR_PAIR_OFFSET_TIME_TO_CONTACT_S 352
#define CELLMIRROR_PAIR_OFFSET_FLAGS 360
#define CELLMIRROR_PAIR_OFFSET_CONTACTS 364
#define CELLMIRROR_PAIR_OFFSET_CONTACT_AGE_S 368
#define CELLMIRROR_PAIR_BYTES 376

#define CELLMIRROR_EVENT_OFFSET_EVENT 40
#define CELLMIRROR_EVENT_OFFSET_CHANGE 48
#define CELLMIRROR_EVENT_OFFSET_DISTANCE 56
#define CELLMIRROR_EVENT_OFFSET_A 64
#define CELLMIRROR_EVENT_OFFSET_B 192
#define CELLMIRROR_EVENT_BYTES 320

#define CELLMIRROR_TISSUE_OFFSET_EVENT 40
#define CELLMIRROR_TISSUE_OFFSET_KIND 48
#define CELLMIRROR_TISSUE_OFFSET_LIMIT 49
#define CELLMIRROR_TISSUE_OFFSET_VALUE 56
#define CELLMIRROR_TISSUE_OFFSET_PLACE 64
#define CELLMIRROR_TISSUE_OFFSET_ROBOT 88
#define CELLMIRROR_TISSUE_OFFSET_OBJECT 152
#define CELLMIRROR_TISSUE_OFFSET_PART 216
#define CELLMIRROR_TISSUE_BYTES 280

#define CELLMIRROR_BARRIER_OFFSET_ID 40
#define CELLMIRROR_BARRIER_OFFSET_OBJECT 104
#define CELLMIRROR_BARRIER_OFFSET_INTERRUPTIONS 232
#define CELLMIRROR_BARRIER_OFFSET_FLAGS 240
#define CELLMIRROR_BARRIER_BYTES 248

/* Flags of a light barrier. */
#define CELLMIRROR_BARRIER_INTERRUPTED 1u
#define CELLMIRROR_BARRIER_DOUBTFUL 2u

/* Flags of a range. */
#define CELLMIRROR_RANGE_SEEN 1u          /* something is in the cone */
#define CELLMIRROR_RANGE_IN_BLIND_ZONE 2u /* nearer than a real sensor can measure */
#define CELLMIRROR_RANGE_DOUBTFUL 4u      /* something nearer may be there */

/* Flags of a camera. */
#define CELLMIRROR_CAMERA_TRACKING 1u /* it is to look at the frame that is named */
#define CELLMIRROR_CAMERA_MIRRORED 2u /* its head is mirrored: without the flag above there is nothing to follow */

/* Flags of a pair. */
#define CELLMIRROR_PAIR_TOUCHING 1u
#define CELLMIRROR_PAIR_WITHIN_WARNING 2u
#define CELLMIRROR_PAIR_DOUBTFUL 4u /* not certain: take it as touching */

/* Change of an event. */
enum cellmirror_change {
  CELLMIRROR_CHANGE_ENTERED_WARNING = 0,
  CELLMIRROR_CHANGE_TOUCHED = 1,
  CELLMIRROR_CHANGE_PARTED = 2,
  CELLMIRROR_CHANGE_LEFT_WARNING = 3
};

/* Kind of a tissue event. */
enum cellmirror_tissue_kind {
  CELLMIRROR_TISSUE_GRIP = 0,
  CELLMIRROR_TISSUE_RELEASE = 1,
  CELLMIRROR_TISSUE_SLIP = 2,
  CELLMIRROR_TISSUE_CLIP = 3,
  CELLMIRROR_TISSUE_CUT = 4,
  CELLMIRROR_TISSUE_COAGULATE = 5,
  CELLMIRROR_TISSUE_TEAR = 6,
  CELLMIRROR_TISSUE_BLEED = 7,
  CELLMIRROR_TISSUE_BLEED_END = 8,
  CELLMIRROR_TISSUE_LIMIT = 9
};

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

struct cellmirror_range {
  struct cellmirror_header header;
  char id[CELLMIRROR_NAME_BYTES];
  char object[CELLMIRROR_PATH_BYTES]; /* short name of the body that is seen */
  double distance;                    /* m; NaN: nothing is seen */
  double range;                       /* m */
  double blind_zone;                  /* m */
  double half_angle;                  /* rad */
  double point[3];                    /* m, in the world; NaN: nothing is seen */
  uint32_t flags;
  uint32_t reserved;
};

struct cellmirror_range_entry {
  char id[CELLMIRROR_NAME_BYTES];
  double distance; /* m; NaN: nothing is seen */
  double range;    /* m */
  double point[3]; /* m, in the world; NaN: nothing is seen */
  uint32_t flags;
  uint32_t reserved;
};

struct cellmirror_range_array {
  struct cellmirror_header header;
  uint16_t part;                                               /* from 1 */
  uint16_t parts;                                              /* records that hold all sensors */
  uint16_t count;                                              /* sensors of this record */
  uint16_t total;                                              /* sensors of all parts */
  struct cellmirror_range_entry ranges[CELLMIRROR_MAX_RANGES]; /* count of them are sent */
};

struct cellmirror_camera {
  struct cellmirror_header header;
  char id[CELLMIRROR_NAME_BYTES];
  char tracks[CELLMIRROR_PATH_BYTES]; /* dotted path of the frame that it is to look at; empty: none */
  struct cellmirror_pose pose;        /* where it is to look, in the world */
  struct cellmirror_pose mount;       /* as it looks with its pan-tilt head at zero */
  double pan;                         /* rad, about y of the mount */
  double tilt;                        /* rad, then about the new x */
  double focal_distance;              /* m */
  double fovy;                        /* rad, vertical */
  uint32_t flags;
  uint32_t reserved;
};

struct cellmirror_pair {
  char a[CELLMIRROR_PATH_BYTES];
  char b[CELLMIRROR_PATH_BYTES];
  double distance;          /* m; 0 where they touch */
  double depth;             /* m; 0 where they do not touch */
  double point_a[3];        /* m, in the world */
  double point_b[3];        /* m, in the world */
  double normal[3];         /* of a contact, from a to b */
  double closing_speed;     /* m/s; NaN: not known */
  double time_to_contact_s; /* NaN: they do not approach, or not known */
  uint32_t flags;
  uint32_t contacts;    /* contact points that were found */
  double contact_age_s; /* how much older the contact is than the record's posture */
};

struct cellmirror_proximity {
  struct cellmirror_header header;
  uint64_t check;          /* number of the computation */
  double warning_distance; /* m */
  double computed_after_s; /* from the instant that it is for */
  uint32_t tested;         /* pairs */
  uint32_t touching;       /* pairs */
  uint32_t within_warning; /* pairs, those that touch included */
  uint32_t doubts;         /* what could not be computed for sure */
  uint32_t found;          /* pairs that would be listed if all had room */
  uint16_t pair_count;     /* pairs of this record */
  uint16_t reserved;
  struct cellmirror_pair pairs[CELLMIRROR_MAX_PAIRS]; /* pair_count of them are sent */
};

struct cellmirror_event {
  struct cellmirror_header header;
  uint64_t event; /* from 1; a gap: events were lost */
  uint8_t change; /* enum cellmirror_change */
  uint8_t reserved[7];
  double distance; /* m */
  char a[CELLMIRROR_PATH_BYTES];
  char b[CELLMIRROR_PATH_BYTES];
};

struct cellmirror_tissue_event {
  struct cellmirror_header header;
  uint64_t event; /* from 1; a gap: events were lost */
  uint8_t kind;   /* enum cellmirror_tissue_kind */
  uint8_t limit;  /* of kind CELLMIRROR_TISSUE_LIMIT */
  uint8_t reserved[6];
  double value;    /* docs/messages.md */
  double place[3]; /* m, in the world */
  char robot[CELLMIRROR_NAME_BYTES];
  char object[CELLMIRROR_NAME_BYTES];
  char part[CELLMIRROR_NAME_BYTES];
};

struct cellmirror_barrier {
  struct cellmirror_header header;
  char id[CELLMIRROR_NAME_BYTES];
  char object[CELLMIRROR_PATH_BYTES]; /* in the beam; empty: none, or not known */
  uint64_t interruptions;             /* since the start */
  uint32_t flags;                     /* CELLMIRROR_BARRIER_... */
  uint32_t reserved;
};

#if defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define CELLMIRROR_CHECK(condition) _Static_assert(condition, #condition)
#elif defined(__cplusplus) && __cplusplus >= 201103L
#define CELLMIRROR_CHECK(condition) static_assert(condition, #condition)
#else /* C99: an array of negative size is refused */
#define CELLMIRROR_CHECK(condition) extern int cellmirror_check[(condition) ? 1 : -1]
#endif
CELLMIRROR_CHECK(sizeof(struct cellmirror_header) == CELLMIRROR_HEADER_BYTES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_joint) == CELLMIRROR_JOINT_BYTES);
CELLMIRROR_CHECK(offsetof(struct cellmirror_robot, joints) == CELLMIRROR_ROBOT_OFFSET_JOINTS);
CELLMIRROR_CHECK(sizeof(struct cellmirror_range) == CELLMIRROR_RANGE_BYTES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_range_entry) == CELLMIRROR_RANGE_ENTRY_BYTES);
CELLMIRROR_CHECK(offsetof(struct cellmirror_range_array, ranges) == CELLMIRROR_RANGE_ARRAY_OFFSET_RANGES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_range_array) <= CELLMIRROR_MAX_MESSAGE_BYTES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_camera) == CELLMIRROR_CAMERA_BYTES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_pair) == CELLMIRROR_PAIR_BYTES);
CELLMIRROR_CHECK(offsetof(struct cellmirror_proximity, pairs) == CELLMIRROR_PROXIMITY_OFFSET_PAIRS);
CELLMIRROR_CHECK(sizeof(struct cellmirror_event) == CELLMIRROR_EVENT_BYTES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_tissue_event) == CELLMIRROR_TISSUE_BYTES);
CELLMIRROR_CHECK(sizeof(struct cellmirror_barrier) == CELLMIRROR_BARRIER_BYTES);

/* Whether a received message is a record of this version and kind with at least `least` bytes. */
static inline int cellmirror_is_record(const void* message, size_t bytes, unsigned kind, size_t least) {
  struct cellmirror_header header;
  if (bytes < least || bytes < sizeof header) return 0;
  memcpy(&header, message, sizeof header);
  return header.magic == CELLMIRROR_RECORD_MAGIC && header.version == CELLMIRROR_RECORD_VERSION &&
         header.kind == kind && header.length == bytes;
}

/* These copy a record out of a received message. 1: done; 0: the bytes are no such record of this version. Texts end
 * with a NUL. */
static inline int cellmirror_read_robot(const void* message, size_t bytes, struct cellmirror_robot* robot) {
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_ROBOT, CELLMIRROR_ROBOT_OFFSET_JOINTS)) return 0;
  if (bytes > sizeof *robot) return 0;
  memset(robot, 0, sizeof *robot);
  memcpy(robot, message, bytes);
  robot->id[CELLMIRROR_NAME_BYTES - 1] = '\0';
  return robot->joint_count <= CELLMIRROR_MAX_JOINTS &&
         bytes == CELLMIRROR_ROBOT_OFFSET_JOINTS + (size_t)robot->joint_count * CELLMIRROR_JOINT_BYTES;
}

static inline int cellmirror_read_range(const void* message, size_t bytes, struct cellmirror_range* range) {
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_RANGE, CELLMIRROR_RANGE_BYTES)) return 0;
  if (bytes != sizeof *range) return 0;
  memcpy(range, message, bytes);
  range->id[CELLMIRROR_NAME_BYTES - 1] = '\0';
  range->object[CELLMIRROR_PATH_BYTES - 1] = '\0';
  return 1;
}

static inline int cellmirror_read_range_array(const void* message, size_t bytes, struct cellmirror_range_array* array) {
  unsigned i;
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_RANGE_ARRAY, CELLMIRROR_RANGE_ARRAY_OFFSET_RANGES))
    return 0;
  if (bytes > sizeof *array) return 0;
  memset(array, 0, sizeof *array);
  memcpy(array, message, bytes);
  for (i = 0; i < CELLMIRROR_MAX_RANGES; ++i) array->ranges[i].id[CELLMIRROR_NAME_BYTES - 1] = '\0';
  return array->count <= CELLMIRROR_MAX_RANGES &&
         bytes == CELLMIRROR_RANGE_ARRAY_OFFSET_RANGES + (size_t)array->count * CELLMIRROR_RANGE_ENTRY_BYTES;
}

static inline int cellmirror_read_camera(const void* message, size_t bytes, struct cellmirror_camera* camera) {
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_CAMERA, CELLMIRROR_CAMERA_BYTES)) return 0;
  if (bytes != sizeof *camera) return 0;
  memcpy(camera, message, bytes);
  camera->id[CELLMIRROR_NAME_BYTES - 1] = '\0';
  camera->tracks[CELLMIRROR_PATH_BYTES - 1] = '\0';
  return 1;
}

static inline int cellmirror_read_proximity(const void* message, size_t bytes, struct cellmirror_proximity* proximity) {
  unsigned i;
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_PROXIMITY, CELLMIRROR_PROXIMITY_OFFSET_PAIRS)) return 0;
  if (bytes > sizeof *proximity) return 0;
  memset(proximity, 0, sizeof *proximity);
  memcpy(proximity, message, bytes);
  for (i = 0; i < CELLMIRROR_MAX_PAIRS; ++i) {
    proximity->pairs[i].a[CELLMIRROR_PATH_BYTES - 1] = '\0';
    proximity->pairs[i].b[CELLMIRROR_PATH_BYTES - 1] = '\0';
  }
  return proximity->pair_count <= CELLMIRROR_MAX_PAIRS &&
         bytes == CELLMIRROR_PROXIMITY_OFFSET_PAIRS + (size_t)proximity->pair_count * CELLMIRROR_PAIR_BYTES;
}

static inline int cellmirror_read_event(const void* message, size_t bytes, struct cellmirror_event* event) {
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_EVENT, CELLMIRROR_EVENT_BYTES)) return 0;
  if (bytes != sizeof *event) return 0;
  memcpy(event, message, bytes);
  event->a[CELLMIRROR_PATH_BYTES - 1] = '\0';
  event->b[CELLMIRROR_PATH_BYTES - 1] = '\0';
  return 1;
}

static inline int cellmirror_read_tissue_event(const void* message, size_t bytes,
                                               struct cellmirror_tissue_event* event) {
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_TISSUE_EVENT, CELLMIRROR_TISSUE_BYTES)) return 0;
  if (bytes != sizeof *event) return 0;
  memcpy(event, message, bytes);
  event->robot[CELLMIRROR_NAME_BYTES - 1] = '\0';
  event->object[CELLMIRROR_NAME_BYTES - 1] = '\0';
  event->part[CELLMIRROR_NAME_BYTES - 1] = '\0';
  return 1;
}

static inline int cellmirror_read_barrier(const void* message, size_t bytes, struct cellmirror_barrier* barrier) {
  if (!cellmirror_is_record(message, bytes, CELLMIRROR_KIND_BARRIER, CELLMIRROR_BARRIER_BYTES)) return 0;
  if (bytes != sizeof *barrier) return 0;
  memcpy(barrier, message, bytes);
  barrier->id[CELLMIRROR_NAME_BYTES - 1] = '\0';
  barrier->object[CELLMIRROR_PATH_BYTES - 1] = '\0';
  return 1;
}

static inline const char* cellmirror_tissue_name(unsigned kind) {
  static const char* const names[] = {"grip",      "release", "slip",  "clip",      "cut",
                                      "coagulate", "tear",    "bleed", "bleed_end", "limit"};
  return kind < 10 ? names[kind] : "unknown";
}

static inline const char* cellmirror_change_name(unsigned change) {
  static const char* const names[] = {"entered_warning", "touched", "parted", "left_warning"};
  return change < 4 ? names[change] : "unknown";
}

static inline const char* cellmirror_state_name(unsigned state) {
  static const char* const names[] = {"none", "fresh", "stale", "lost", "invalid"};
  return state < 5 ? names[state] : "unknown";
}

#endif
