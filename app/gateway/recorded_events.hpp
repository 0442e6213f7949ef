// What a recording that is played says of alarms, collisions and faults.
#pragma once

#include "app/alarms/alarm_history.hpp"
#include "app/playback/recorded_run.hpp"
#include "rt_core/ports/playback.hpp"

namespace cellmirror::app {

// Nothing where the recording has no such topic, or cannot be read.
void read_alarms(RecordedRun& run, AlarmHistory& alarms);
// Bodies that began to touch, and alarms of high priority that were raised and are about something else.
[[nodiscard]] PlaybackMarks read_marks(RecordedRun& run, const AlarmHistory& alarms);

}  // namespace cellmirror::app
