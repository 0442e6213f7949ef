// A master made with lely-core's C++ library: boots drives of a [[device]], and moves all of them in cyclic synchronous
// position, one RPDO and one TPDO of each with each SYNC. lely_core.py compiles and runs it.
//
//   lely_master INTERFACE DCF NODE...
#include <lely/coapp/fiber_driver.hpp>
#include <lely/coapp/master.hpp>
#include <lely/ev/loop.hpp>
#include <lely/io2/linux/can.hpp>
#include <lely/io2/posix/poll.hpp>
#include <lely/io2/sys/io.hpp>
#include <lely/io2/sys/timer.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace {

using lely::canopen::AsyncMaster;
using lely::canopen::NmtState;

constexpr std::uint32_t kPeriodUs = 10'000;
constexpr double kTurn = 2 * 3.14159265358979;
constexpr double kAmplitude = 2000;  // increments
constexpr double kMostBehind = 500;
constexpr int kPeriods = 400;       // of SYNC that the motion takes: two waves
constexpr int kMostPeriods = 3000;  // until everything must be done

class Drive final : public lely::canopen::FiberDriver {
 public:
  using FiberDriver::FiberDriver;

  [[nodiscard]] bool booted() const { return booted_; }
  [[nodiscard]] bool done() const { return moved_ >= kPeriods && enabled_seen_ && !enabled(); }
  void report() const {
    std::printf("%s: node %d: %zu positions, half of them at most %.0f increments behind, %d emergencies\n",
                failed() ? "failed" : "ok", id(), behind_.size(), median(), emergencies_);
  }
  // SYNCs may be late on a busy machine.
  [[nodiscard]] bool failed() const { return !done() || behind_.size() < kPeriods * 3 / 4 || median() > kMostBehind; }

 private:
  void OnConfig(std::function<void(std::error_code)> result) noexcept override {
    try {
      Wait(AsyncWrite<std::uint16_t>(0x1017, 0, 100));
      Wait(AsyncWrite<std::int8_t>(0x6060, 0, 8));
      Wait(AsyncWrite<std::uint8_t>(0x60C2, 1, kPeriodUs / 1000));
      result({});
    } catch (const std::system_error& error) {
      std::printf("failed: node %d: %s\n", id(), error.what());
      result(error.code());
    }
  }
  void OnBoot(NmtState /*state*/, char status, const std::string& what) noexcept override {
    booted_ = status == 0;
    std::printf("%s: node %d booted %s\n", booted_ ? "ok" : "failed", id(), what.c_str());
  }
  void OnEmcy(std::uint16_t code, std::uint8_t /*error_register*/, std::uint8_t* /*data*/) noexcept override {
    std::printf("failed: node %d: emergency 0x%04X\n", id(), code);
    ++emergencies_;
  }
  void OnRpdoWrite(std::uint16_t index, std::uint8_t /*subindex*/) noexcept override {
    if (index == 0x6041) status_ = rpdo_mapped[0x6041][0];
    if (index != 0x6064) return;
    position_ = rpdo_mapped[0x6064][0];
    if (!enabled()) return;
    behind_.push_back(std::abs(static_cast<double>(position_) - target_));
  }
  // After a SYNC: what goes out with the next one.
  void OnSync(std::uint8_t /*counter*/, const time_point& /*time*/) noexcept override {
    if (!booted_) return;
    if (!enabled()) {
      start_ = position_;
      target_ = position_;
    } else if (moved_ < kPeriods) {
      ++moved_;
      target_ = start_ + kAmplitude * (1 - std::cos(2 * kTurn * moved_ / kPeriods));
    }
    enabled_seen_ = enabled_seen_ || enabled();
    tpdo_mapped[0x6040][0] = next_controlword();
    tpdo_mapped[0x607A][0] = static_cast<std::int32_t>(std::lround(target_));
  }

  [[nodiscard]] bool enabled() const { return (status_ & 0x6FU) == 0x27U; }
  [[nodiscard]] std::uint16_t next_controlword() const {
    if (moved_ >= kPeriods) return 0x00;
    if ((status_ & 0x6FU) == 0x21U) return 0x07;
    if ((status_ & 0x6FU) == 0x23U || enabled()) return 0x0F;
    return 0x06;
  }

  [[nodiscard]] double median() const {
    std::vector<double> values = behind_;
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  bool booted_ = false;
  bool enabled_seen_ = false;
  std::uint16_t status_ = 0;
  std::int32_t position_ = 0;
  double start_ = 0;
  double target_ = 0;
  std::vector<double> behind_;  // increments, one for each position
  int moved_ = 0;               // periods
  int emergencies_ = 0;
};

}  // namespace

int main(int argc, char* argv[]) {
  if (argc < 4) return 2;
  lely::io::IoGuard guard;
  lely::io::Context context;
  lely::io::Poll poll(context);
  lely::ev::Loop loop(poll.get_poll());
  const auto executor = loop.get_executor();
  lely::io::Timer timer(poll, executor, CLOCK_MONOTONIC);
  lely::io::CanController controller(argv[1]);
  lely::io::CanChannel channel(poll, executor);
  channel.open(controller);
  AsyncMaster master(timer, channel, argv[2], "", 1);
  std::vector<std::unique_ptr<Drive>> drives;
  for (int i = 3; i < argc; ++i)
    drives.push_back(std::make_unique<Drive>(executor, master, static_cast<std::uint8_t>(std::atoi(argv[i]))));
  int periods = 0;
  master.OnSync([&](std::uint8_t /*counter*/, const AsyncMaster::time_point& /*time*/) {
    const bool all_done = std::all_of(drives.begin(), drives.end(), [](const auto& drive) { return drive->done(); });
    if (all_done || ++periods > kMostPeriods) context.shutdown();
  });
  master.Reset();
  master[0x1006][0] = kPeriodUs;
  loop.run();
  for (const auto& drive : drives) drive->report();
  return std::any_of(drives.begin(), drives.end(), [](const auto& drive) { return drive->failed(); }) ? 1 : 0;
}
