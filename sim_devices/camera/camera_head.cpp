#include "sim_devices/camera/camera_head.hpp"

#include <algorithm>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::sim {
// The drives call it within work(), for the instant to which the head was just moved.
class CameraHead::Angles final : public MotionSource {
 public:
  explicit Angles(const PanTiltHead& head) : head_(head) {}
  void at(double /*t_s*/, std::span<JointValue> values) const override {
    for (std::size_t i = 0; i < values.size() && i < kHeadAxes; ++i) {
      values[i].position = head_.axis(i).position();
      values[i].velocity = head_.axis(i).velocity();
    }
  }

 private:
  const PanTiltHead& head_;
};

CameraHead::CameraHead(const CameraHeadConfig& config, std::unique_ptr<CanChannel> channel)
    : config_(config),
      head_(config.head),
      reader_(config.key, config.camera, config.take),
      drives_(std::make_unique<Cia402Robots>(config.drives, std::make_shared<const Angles>(head_), std::move(channel))),
      looks_({}, period_of(config.look_hz)) {}

CameraHead::~CameraHead() = default;

void CameraHead::start(Timestamp now) {
  head_.start(now);
  looks_ = Pacer(now, looks_.period());
  drives_->start(now);
}

void CameraHead::work(Timestamp now) {
  if (looks_.due(now)) {
    looks_.advance(now);
    if (const auto record = reader_.newest(now)) {
      heard_ = now;
      head_.follow(*record, now);
    }
  }
  head_.advance(now);
  drives_->work(now);
}

Timestamp CameraHead::next() const { return std::min(looks_.next(), drives_->next()); }

Result<std::string> CameraHead::execute(const ControlCommand& command, Timestamp now) {
  if (const auto* held = std::get_if<SetHeld>(&command)) head_.hold(held->held);
  const auto* end = std::get_if<EndFaults>(&command);
  if (end == nullptr || end->kind) return drives_->execute(command, now);
  const std::size_t ended = head_.end_faults(end->id, {}, now);
  if (end->id != 0 && ended > 0) return std::to_string(ended) + " ended";
  const auto others = drives_->execute(command, now);
  if (!others || ended == 0) return others;
  return std::to_string(ended) + " of the head and " + *others;
}

std::optional<Result<std::string>> CameraHead::execute_own(std::string_view line, Timestamp now) {
  line = trimmed(line);
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view verb = line.substr(0, end);
  const std::string_view rest = trimmed(line.substr(end));
  if (!is_head_fault(rest) || (verb != "fault" && verb != "clear")) return {};
  const auto spec = parse_head_fault(rest);
  if (!spec) return std::unexpected(spec.error());
  if (verb == "clear") return std::to_string(head_.end_faults(0, spec->kind, now)) + " ended";
  const auto added = head_.add_fault(*spec, now);
  if (!added) return std::unexpected(added.error());
  return "fault " + std::to_string(*added);
}

DeviceStatus CameraHead::status(Timestamp now) const {
  DeviceStatus status = drives_->status(now);
  const CameraReader::Counters& read = reader_.counters();
  const PanTiltHead::Counters& head = head_.counters();
  status.details.insert(status.details.end(), {{"records", read.records},
                                               {"records_of_others", read.others},
                                               {"records_malformed", read.malformed},
                                               {"queue_attachments", read.attachments},
                                               {"followed", head.followed},
                                               {"echoes", head.echoes},
                                               {"ignored", head.ignored},
                                               {"beyond_a_stop", head.beyond}});
  status.quantities = {{"pan_rad", head_.axis(0).position()},
                       {"tilt_rad", head_.axis(1).position()},
                       {"wanted_pan_rad", head_.goal()[0]},
                       {"wanted_tilt_rad", head_.goal()[1]}};
  if (heard_.known()) status.quantities.emplace_back("record_age_s", seconds(now - heard_));
  for (const HeadFault& fault : head_.faults()) {
    status.faults.push_back({fault.id, fault.spec.text, fault.in_force(now), fault.applied});
  }
  return status;
}

}  // namespace cellmirror::sim
