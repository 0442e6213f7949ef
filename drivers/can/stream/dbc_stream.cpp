#include <fmt/format.h>

#include <utility>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/dbc/session.hpp"
#include "drivers/can/stream/can_stream.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {
namespace {

// A wrong CRC, or a second sender, is shown this long.
constexpr Nanoseconds kTroubleShown{1'000'000'000};

class DbcProtocol final : public CanProtocol, private DbcSessionOutput {
 public:
  DbcProtocol(const DbcPlan& plan, CanProtocolHost& host)
      : host_(&host), ages_(plan.config.ages), session_(plan, *this) {}

  void start(Timestamp now) override {
    started_ = now;
    session_.restart();
  }
  void receive(const CanFrame& frame, Timestamp now, std::size_t /*node*/) override { session_.receive(frame, now); }
  void advance(Timestamp) override {}
  [[nodiscard]] Timestamp next_due() const override { return {}; }

  void publish() override { published_.write({session_.counters(), session_.trouble(), started_, last_sample_}); }

  void describe(JointStreamStatus& status, Timestamp now) override {
    const auto& [counters, trouble, started, last_sample] = published_.read().value;
    status.received = counters.samples;
    status.rejected = counters.rejected;
    status.lost = counters.lost;
    describe_protection(counters, status);
    if (counters.outside > 0) {
      status.details.emplace_back("beyond the DBC's limits", number_of(counters.outside, "value"));
    }
    if (!last_sample.known()) {
      status.condition = fmt::format("no frame of the DBC's messages since {:.1f} s", seconds(now - started));
    } else if (now - last_sample > ages_.stale_after) {
      status.condition = fmt::format("no frame since {:.1f} s", seconds(now - last_sample));
    } else {
      status.condition = trouble_text(trouble, now);
    }
  }

 private:
  struct Report {
    DbcCounters counters;
    DbcTrouble trouble;
    Timestamp started;
    Timestamp last_sample;
  };

  static void describe_protection(const DbcCounters& counters, JointStreamStatus& status) {
    if (counters.wrong_crc > 0) status.details.emplace_back("wrong CRC", number_of(counters.wrong_crc, "message"));
    if (counters.wrong_sequence > 0)
      status.details.emplace_back("wrong sequence", number_of(counters.wrong_sequence, "message"));
    if (counters.repeated > 0) status.details.emplace_back("repeated", number_of(counters.repeated, "message"));
    if (counters.conflicts > 0) status.details.emplace_back("of two senders", number_of(counters.conflicts, "value"));
  }

  static std::string trouble_text(const DbcTrouble& trouble, Timestamp now) {
    if (trouble.conflict.known() && now - trouble.conflict <= kTroubleShown) {
      return fmt::format("two senders of {}.{}: near {:.4g} and {:.4g} rad or m", trouble.conflict_message->name,
                         trouble.conflict_signal->name, trouble.places.a, trouble.places.b);
    }
    if (trouble.protection.known() && now - trouble.protection <= kTroubleShown)
      return fmt::format("{} in {}", word(trouble.status), trouble.message->name);
    return "operational";
  }

  void sample(const JointSample& sample) override {
    last_sample_ = sample.receive_time;
    host_->push(sample);
  }
  void rejected(const std::string& why) override { host_->note(Severity::warning, "rejected", why); }
  void outside(const std::string& what) override { host_->note(Severity::warning, "limits", what); }

  CanProtocolHost* host_;
  StreamAges ages_;
  DbcSession session_;
  Timestamp started_;
  Timestamp last_sample_;
  Latest<Report> published_;
};

}  // namespace

void check_stream(const DbcStreamConfig& config, Diagnostics& diagnostics) {
  DbcStreamConfig sound = config;
  std::erase_if(sound.signals,
                [](const DbcSignalConfig& signal) { return signal.message.empty() || signal.signal.empty(); });
  check_channel(config.channel, config.place, diagnostics);
  if (sound.dbc_file.empty() || sound.signals.empty()) return;
  static_cast<void>(plan_dbc(sound, diagnostics));
}

Result<std::unique_ptr<JointStream>> make_dbc_stream(const DbcStreamConfig& config, const Clock& clock,
                                                     CanStreamOptions options) {
  Diagnostics diagnostics;
  auto plan = plan_dbc(config, diagnostics);
  if (!plan) return fail("the DBC stream cannot be set up:\n" + diagnostics.text());
  return std::make_unique<CanStream>("can-dbc",
                                     std::make_shared<SharedChannel>(config.channel, clock, std::move(options)), clock,
                                     [plan = std::move(*plan)](CanProtocolHost& host) -> std::unique_ptr<CanProtocol> {
                                       return std::make_unique<DbcProtocol>(plan, host);
                                     });
}

}  // namespace cellmirror::can
