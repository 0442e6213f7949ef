#include "app/replay/verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/recording/build_identity.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

std::string value_of(const mcap::Texts& values, std::string_view key) {
  const auto found = values.find(key);
  return found == values.end() ? std::string() : found->second;
}

std::string where(const ReplayDifference& difference) {
  std::string out = fmt::format("tick {}", difference.tick);
  if (!difference.robot.empty()) out += ", robot " + printable(difference.robot);
  if (!difference.joint.empty()) out += ", joint " + printable(difference.joint);
  return out + ": " + difference.what;
}

}  // namespace

std::string other_build(const mcap::Reader& reader) {
  const auto about = reader.metadata(kGatewayName);
  if (!about) return "the recording does not say which program has made it";
  const std::string version = value_of(about->values, "version");
  const std::string build = value_of(about->values, kBuildKey);
  const std::string target = value_of(about->values, kTargetKey);
  if (version != CELLMIRROR_VERSION)
    return fmt::format("it was recorded with version {}, and this is " CELLMIRROR_VERSION, printable(version));
  if (build != build_identity())
    return fmt::format("it was recorded by another build ({:.12}, and this is {:.12})", printable(build),
                       build_identity());
  if (target != compute_target())
    return fmt::format("it was computed with {} instructions, and here they are {}", printable(target),
                       compute_target());
  return {};
}

Result<Verification> verify(mcap::Reader& reader, mcap::Filter filter, const Clock& clock) {
  const bool has_inputs = std::ranges::any_of(reader.catalogue().channels, [](const auto& one) {
    return one.second.topic == kInputsTopic && one.second.encoding == kInputsEncoding;
  });
  if (!has_inputs)
    return fail(fmt::format("the recording has no topic {}, so it cannot be run again", kInputsTopic),
                "record it without --topics, or with this one among them");
  Verification out;
  out.other_build = other_build(reader);
  const Timestamp began = clock.now();
  EngineReplay replay;
  std::optional<std::uint32_t> last;
  filter.topics = {std::string(kInputsTopic)};
  const auto read = reader.read(filter, [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (channel.encoding != kInputsEncoding) return true;
    if (last && message.sequence != *last + 1) {
      out.lost_messages += message.sequence > *last ? message.sequence - *last - 1 : 1;
      replay.gap(fmt::format("messages of {} are missing", kInputsTopic));
    }
    last = message.sequence;
    replay.take(message.data);
    return !replay.difference().has_value();
  });
  if (!read) return std::unexpected(read.error());
  out.took_s = seconds(clock.now() - began);
  out.difference = replay.difference();
  out.counts = replay.counts();
  for (const std::uint8_t channel : replay.channels_taken_over())
    out.not_compared.push_back(fmt::format("haptic device {}", channel));
  return out;
}

std::string verification_text(const Verification& verification) {
  const ReplayCounts& counts = verification.counts;
  std::string out;
  if (!verification.other_build.empty()) out += fmt::format("note: {}\n", verification.other_build);
  if (verification.difference) {
    const ReplayDifference& difference = *verification.difference;
    out += fmt::format("the replay differs at {}\n  recorded {}\n  computed {}\n", where(difference),
                       difference.recorded, difference.computed);
  } else if (counts.ticks == 0) {
    out += "no tick could be run again\n";
  } else {
    out += fmt::format("{} ticks ({:.1f} s) are equal to the bit; it took {:.2f} s ({:.0f} times as fast)\n",
                       counts.ticks, counts.recorded_s, verification.took_s,
                       verification.took_s > 0 ? counts.recorded_s / verification.took_s : 0.0);
  }
  if (counts.skipped > 0)
    out += fmt::format("{} ticks could not be run: before the first start state, or after a gap\n", counts.skipped);
  if (counts.gaps > 0) out += fmt::format("{} gaps; the first: {}\n", counts.gaps, counts.first_problem);
  if (counts.not_sound > 0)
    out += fmt::format("{} records could not be understood; the first: {}\n", counts.not_sound, counts.first_problem);
  for (const std::string& one : verification.not_compared)
    out += fmt::format(
        "{}: open before the recording began, which does not have its state: its forces were not compared; its robot "
        "was\n",
        one);
  return out;
}

std::string verification_json(const Verification& verification) {
  const ReplayCounts& counts = verification.counts;
  JsonWriter out;
  out.begin_object().member("equal", verification.equal()).member("ticks", counts.ticks);
  out.member("recorded_s", counts.recorded_s).member("took_s", verification.took_s);
  out.member("skipped", counts.skipped).member("starts", counts.starts).member("gaps", counts.gaps);
  out.member("not_sound", counts.not_sound).member("lost_messages", verification.lost_messages);
  out.member("problem", counts.first_problem).member("other_build", verification.other_build);
  out.key("not_compared").begin_array();
  for (const std::string& one : verification.not_compared) out.value(one);
  out.end_array();
  if (verification.difference) {
    const ReplayDifference& difference = *verification.difference;
    out.key("difference").begin_object().member("tick", difference.tick).member("time_ns", difference.time.ns);
    out.member("robot", difference.robot).member("joint", difference.joint).member("what", difference.what);
    out.member("recorded", difference.recorded).member("computed", difference.computed).end_object();
  }
  out.end_object();
  return out.take();
}

}  // namespace cellmirror::app
