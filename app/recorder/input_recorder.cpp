#include "app/recorder/input_recorder.hpp"

#include <string>
#include <utility>

#include "app/recording_layout/recording_names.hpp"
#include "app/recording_layout/tick_inputs.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kBetweenMessages{50'000'000};
constexpr std::size_t kLargeMessage = std::size_t{512} << 10;
constexpr Nanoseconds kBetweenLooks{200'000'000};  // at the files of recordings
constexpr Nanoseconds kBetweenStarts{10'000'000'000};

TopicPtr inputs_topic() {
  Topic topic;
  topic.name = kInputsTopic;
  topic.encoding = kInputsEncoding;
  topic.schema_name = "cellmirror.Inputs";
  topic.schema_encoding = kInputsEncoding;
  topic.schema = "What the tick took, for cellmirror replay (docs/recording.md). Version 1.";
  topic.importance = Importance::event;
  return std::make_shared<const Topic>(std::move(topic));
}

// Kind, length, content.
void append_record(std::vector<std::byte>& out, engine::InputRecord kind, std::span<const std::byte> content) {
  const auto length = static_cast<std::uint32_t>(content.size());
  out.push_back(static_cast<std::byte>(kind));
  const auto bytes = std::as_bytes(std::span(&length, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.insert(out.end(), content.begin(), content.end());
}

}  // namespace

InputRecorder::InputRecorder(engine::InputTap& tap, RecordingHub& hub)
    : tap_(tap), hub_(hub), topic_(inputs_topic()), message_{std::byte{engine::kInputsVersion}} {}

InputRecorder::~InputRecorder() { tap_.end(); }

void InputRecorder::look(Timestamp now, const CellState* cell_state) {
  if (!hub_.wants(*topic_)) {
    if (!tap_.on()) return;
    tap_.end();
    message_.resize(1);
    return;
  }
  if (!tap_.on()) {
    tap_.drain(message_);  // what was left of the time before
    message_.resize(1);
    known_files_ = hub_.files_begun();
    known_drops_ = drops();
    ask_for_start(now);
  }
  if (now - last_look_ >= kBetweenLooks) {
    last_look_ = now;
    const std::uint64_t files = hub_.files_begun();
    const std::uint64_t left_out = drops();
    const bool begun = std::exchange(known_files_, files) != files;
    const bool lost_some = std::exchange(known_drops_, left_out) != left_out;
    if (begun || lost_some || now - last_start_ >= kBetweenStarts) ask_for_start(now);
    const std::uint64_t lost = tap_.lost_ticks();
    if (lost > known_lost_) hub_.count_missed(topic_, lost - known_lost_);
    known_lost_ = lost;
  }
  if (cell_state != nullptr) take_names(*cell_state);
  tap_.drain(message_);
  if (message_.size() > kLargeMessage || now - last_put_ >= kBetweenMessages) put(now);
}

void InputRecorder::ask_for_start(Timestamp now) {
  last_start_ = now;
  names_due_ = true;
  tap_.request_start();
}

// With each start state, and when they have changed.
void InputRecorder::take_names(const CellState& cell_state) {
  if (cell_state.cell == named_cell_ && !names_due_) return;
  named_cell_ = cell_state.cell;
  NamesBySlot names;
  for (const CompiledRobot& robot : cell_state.cell->robots)
    names[static_cast<std::uint8_t>(robot.slot)] = {robot.id, robot.joint_names};
  std::vector<std::byte> record = names_record(names);
  if (record == names_ && !names_due_) return;
  names_ = std::move(record);
  names_due_ = false;
  append_record(message_, engine::InputRecord::robots, names_);
}

void InputRecorder::put(Timestamp now) {
  last_put_ = now;
  if (message_.size() > 1) hub_.put(topic_, to_wall_clock_ns(now), message_);
  message_.resize(1);
}

std::uint64_t InputRecorder::drops() const {
  std::uint64_t sum = 0;
  for (const RecordingReport& report : hub_.reports()) {
    for (const TopicReport& topic : report.topics)
      if (topic.topic == kInputsTopic) sum += topic.dropped;
  }
  return sum;
}

}  // namespace cellmirror::app
