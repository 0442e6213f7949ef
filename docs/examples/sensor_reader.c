/*
 * Prints the records of a running cellmirror, one a line:
 *   sequence robot online|offline state joint=position ... tcp x y z     ROBOT <id> send_on
 *   sequence range sensor DISTANCE|nothing|blind|doubt [object]          SET_USSPAR active
 *   sequence ranges PART/PARTS sensor=DISTANCE|nothing|blind|doubt ...   SET_USSPAR sendmode 1
 *   sequence camera NAME tracks FRAME|free mirrored|simulated pan P tilt T distance D fovy F   CAM_ONLINE
 *   sequence proximity touching N warning N of TESTED pairs: a|b=DISTANCE|touching ...
 *   sequence event NUMBER CHANGE a b DISTANCE
 *   sequence tissue NUMBER KIND robot|- object|- part|- VALUE at x y z
 *   sequence barrier NAME interrupted|free|doubt COUNT object|-
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
    "usage: sensor_reader [--count N] [--timeout SECONDS] [--key KEY]\nPrints records as they come: N of them "
    "(default: no limit), waiting at most SECONDS (default: no limit) for\neach.\n";

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
}

static void print_reading(double distance, unsigned flags) {
  if (flags & CELLMIRROR_RANGE_DOUBTFUL) {
    printf("doubt");
  } else if (!(flags & CELLMIRROR_RANGE_SEEN)) {
    printf("nothing");
  } else if (flags & CELLMIRROR_RANGE_IN_BLIND_ZONE) {
    printf("blind");
  } else {
    printf("%.6f", distance);
  }
}

static void print_range(const struct cellmirror_range* range) {
  printf("%llu range %s ", (unsigned long long)range->header.sequence, range->id);
  print_reading(range->distance, range->flags);
  printf("%s%s\n", range->object[0] == '\0' ? "" : " ", range->object);
}

static void print_range_array(const struct cellmirror_range_array* array) {
  printf("%llu ranges %u/%u", (unsigned long long)array->header.sequence, (unsigned)array->part,
         (unsigned)array->parts);
  for (unsigned i = 0; i < array->count; ++i) {
    printf(" %s=", array->ranges[i].id);
    print_reading(array->ranges[i].distance, array->ranges[i].flags);
  }
  printf("\n");
}

static void print_camera(const struct cellmirror_camera* camera) {
  printf("%llu camera %s ", (unsigned long long)camera->header.sequence, camera->id);
  if (camera->flags & CELLMIRROR_CAMERA_TRACKING) {
    printf("tracks %s", camera->tracks);
  } else {
    printf("free");
  }
  printf(" %s pan %.6f tilt %.6f distance %.6f fovy %.6f\n",
         camera->flags & CELLMIRROR_CAMERA_MIRRORED ? "mirrored" : "simulated", camera->pan, camera->tilt,
         camera->focal_distance, camera->fovy);
}

static void print_proximity(const struct cellmirror_proximity* proximity) {
  printf("%llu proximity touching %u warning %u of %u pairs:", (unsigned long long)proximity->header.sequence,
         (unsigned)proximity->touching, (unsigned)proximity->within_warning, (unsigned)proximity->tested);
  for (unsigned i = 0; i < proximity->pair_count; ++i) {
    const struct cellmirror_pair* pair = &proximity->pairs[i];
    printf(" %s|%s=", pair->a, pair->b);
    if (pair->flags & CELLMIRROR_PAIR_TOUCHING) {
      printf("touching");
    } else {
      printf("%.6f", pair->distance);
    }
  }
  printf("\n");
}

static void print_event(const struct cellmirror_event* event) {
  printf("%llu event %llu %s %s %s %.6f\n", (unsigned long long)event->header.sequence,
         (unsigned long long)event->event, cellmirror_change_name(event->change), event->a, event->b, event->distance);
}

static const char* text_or_dash(const char* text) { return text[0] == '\0' ? "-" : text; }

static void print_tissue_event(const struct cellmirror_tissue_event* event) {
  printf("%llu tissue %llu %s %s %s %s %.6f at %.6f %.6f %.6f\n", (unsigned long long)event->header.sequence,
         (unsigned long long)event->event, cellmirror_tissue_name(event->kind), text_or_dash(event->robot),
         text_or_dash(event->object), text_or_dash(event->part), event->value, event->place[0], event->place[1],
         event->place[2]);
}

static void print_barrier(const struct cellmirror_barrier* barrier) {
  const char* state = (barrier->flags & CELLMIRROR_BARRIER_INTERRUPTED) ? "interrupted" : "free";
  if (barrier->flags & CELLMIRROR_BARRIER_DOUBTFUL) state = "doubt";
  printf("%llu barrier %s %s %llu %s\n", (unsigned long long)barrier->header.sequence, barrier->id, state,
         (unsigned long long)barrier->interruptions, text_or_dash(barrier->object));
}

/* 1: it was a record of a kind that this program knows. */
static int print_record(const void* message, size_t bytes) {
  static union {
    struct cellmirror_robot robot;
    struct cellmirror_range range;
    struct cellmirror_range_array array;
    struct cellmirror_camera camera;
    struct cellmirror_proximity proximity;
    struct cellmirror_event event;
    struct cellmirror_tissue_event tissue_event;
    struct cellmirror_barrier barrier;
  } record;
  if (cellmirror_read_robot(message, bytes, &record.robot)) {
    print_robot(&record.robot);
  } else if (cellmirror_read_range(message, bytes, &record.range)) {
    print_range(&record.range);
  } else if (cellmirror_read_range_array(message, bytes, &record.array)) {
    print_range_array(&record.array);
  } else if (cellmirror_read_camera(message, bytes, &record.camera)) {
    print_camera(&record.camera);
  } else if (cellmirror_read_proximity(message, bytes, &record.proximity)) {
    print_proximity(&record.proximity);
  } else if (cellmirror_read_event(message, bytes, &record.event)) {
    print_event(&record.event);
  } else if (cellmirror_read_tissue_event(message, bytes, &record.tissue_event)) {
    print_tissue_event(&record.tissue_event);
  } else if (cellmirror_read_barrier(message, bytes, &record.barrier)) {
    print_barrier(&record.barrier);
  } else {
    return 0;
  }
  fflush(stdout);
  return 1;
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
    alarm(timeout);
    const ssize_t got = msgrcv(queue, &message, sizeof message.text, CELLMIRROR_MESSAGE_TYPE, MSG_NOERROR);
    if (got < 0) {
      /* EIDRM: the gateway ended. A long-running reader waits a second and begins again with msgget. */
      fprintf(stderr, "sensor_reader: %s\n", errno == EINTR ? "no record in time" : strerror(errno));
      return 1;
    }
    if (print_record(message.text, (size_t)got)) ++printed;
  }
  return 0;
}
