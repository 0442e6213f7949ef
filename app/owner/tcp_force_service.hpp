// SCRIPT's commands about forces (manual 1.2.4), the settings that they change, and the memory that tells of the force
// at the TCP. Belongs to the thread that owns the cell.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "app/io/tcp_force_memory.hpp"
#include "app/snapshot/force_settings.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

// What SET_FORCE_ARROW answers where the cell has nothing of what it is to draw: forces are known of robots whose
// joints move masses, and at the TCP of a haptic device besides. Empty: there is nothing to say.
[[nodiscard]] std::string arrows_without_effect(const ForceArrowSettings& settings, const CompiledCell& cell,
                                                bool has_haptic_devices);

class TcpForceService {
 public:
  struct Parts {
    std::int32_t key = kTcpForceKey;
    std::uint32_t mode = 0600;
    std::string instance;
    const Clock& clock;
    std::function<void(std::string_view text)> show_message;
    ForceGuard* guard = nullptr;  // of the memory; may be null
  };

  explicit TcpForceService(Parts parts) : parts_(std::move(parts)) {}

  // The memory is made when first one of the commands below asks for it, or with this.
  Result<void> make_memory();

  Result<void> set_arrows(const ForceArrowSettings& settings);  // the first three count
  Result<void> set_motors_only(bool on);
  Result<void> set_limits(const ForceLimits& limits);
  Result<void> set_test(bool on, const std::array<double, 4>& values);

  // Shows a message while a limit is passed, and looks after the memory. Often.
  void follow();

  [[nodiscard]] const ForceSettings& settings() const { return settings_; }
  [[nodiscard]] const std::shared_ptr<TcpForceMemory>& memory() const { return memory_; }  // null: not made yet

 private:
  static constexpr Nanoseconds kFollowEvery{50'000'000};
  static constexpr Nanoseconds kMessageEvery{5'000'000'000};  // as long as a message is shown

  void warn(const TcpForce& force);

  Parts parts_;
  ForceSettings settings_;
  std::shared_ptr<TcpForceMemory> memory_;
  std::uint64_t times_reported_ = 0;
  Timestamp last_check_;
  Timestamp last_message_;
};

}  // namespace cellmirror::app
