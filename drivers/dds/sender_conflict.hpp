// Whether two publishers give the values of one joint at the same time. Pure; times are passed in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

// Of a writer: 12 bytes of its participant, 4 of its own (DDSI-RTPS 9.3.1). All zero: unknown.
using WriterGuid = std::array<std::uint8_t, 16>;
// "01.0f.bb.77.5c.1a.00.00.01.00.00.00|00.00.01.03".
[[nodiscard]] std::string text(const WriterGuid& guid);

// Of one joint. A publisher that ends where another begins is no conflict, since it may have been started again; one
// that goes on after another one has begun is.
class SenderConflict {
 public:
  explicit SenderConflict(Nanoseconds window) : window_(window) {}

  // True where the value is one of several publishers', and for a window after the last such value. `publisher`: 0 is
  // unknown, and never in conflict.
  bool take(std::uint64_t publisher, const WriterGuid& guid, Timestamp now);
  [[nodiscard]] const WriterGuid& newest() const { return newest_guid_; }
  [[nodiscard]] const WriterGuid& other() const { return other_guid_; }

 private:
  struct Sender {
    std::uint64_t publisher = 0;
    Timestamp heard;
  };
  static constexpr std::size_t kRemembered = 8;  // that sent before the newest one did

  Nanoseconds window_;
  std::uint64_t newest_ = 0;
  Timestamp newest_heard_;
  WriterGuid newest_guid_{};
  WriterGuid other_guid_{};
  std::array<Sender, kRemembered> before_{};
  Timestamp conflict_;
};

}  // namespace cellmirror::dds
