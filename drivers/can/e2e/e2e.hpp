// End-to-end protection of CAN frames: a counter and a CRC over data and an identifier that both sides know. AUTOSAR
// PRS_E2EProtocol, profiles 1, 2 and 5, and formats that a cell file describes. Pure: no I/O, no clock, no memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/can/dbc/dbc.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/e2e_config.hpp"

namespace cellmirror::can {

// Most significant bit first, as all CRCs of AUTOSAR's profiles for CAN. `width`: 8 or 16.
[[nodiscard]] std::uint16_t crc_of(const CrcParameters& parameters, std::span<const std::uint8_t> data);

inline constexpr CrcParameters kCrc8SaeJ1850{.width = 8, .polynomial = 0x1D, .initial = 0xFF, .final_xor = 0xFF};
inline constexpr CrcParameters kCrc8H2f{.width = 8, .polynomial = 0x2F, .initial = 0xFF, .final_xor = 0xFF};
inline constexpr CrcParameters kCrc16Ccitt{.width = 16, .polynomial = 0x1021, .initial = 0xFFFF, .final_xor = 0};

// How the frames of one message are protected.
struct E2eFormat {
  E2eProfile profile = E2eProfile::described;
  CrcParameters crc;
  DbcSignal crc_field;             // whole bytes
  DbcSignal counter_field;         // at most 16 bits
  std::uint16_t last_counter = 0;  // after which it is 0 again
  std::array<std::uint8_t, 16> data_id{};
  std::uint8_t data_id_bytes = 0;  // that count: profiles 1 and 5 have two (low, high), profile 2 one for each counter
  E2eDataIdMode data_id_mode = E2eDataIdMode::both;
  bool data_id_first = false;  // described: before the data
  std::uint8_t max_delta = 1;  // so far may the counter go on: 1 is no loss
};

// For a message of the DBC. Fails where signals are missing, overlap, do not fit or lie across bytes.
[[nodiscard]] Result<E2eFormat> make_e2e_format(const E2eConfig& config, const DbcMessage& message);

// Puts the counter and the CRC into the data. `data` has the message's length.
void protect(const E2eFormat& format, std::uint16_t counter, std::span<std::uint8_t> data);

// The check states of PRS_E2EProtocol.
enum class E2eStatus : std::uint8_t {
  ok,
  initial,         // the first one: its counter cannot be compared
  ok_some_lost,    // within `max_delta`
  repeated,        // the counter is that of the message before: nothing new
  wrong_sequence,  // beyond `max_delta`; the next one is compared with this one
  wrong_crc,       // or an impossible counter
};
[[nodiscard]] std::string_view word(E2eStatus status);

class E2eChecker {
 public:
  explicit E2eChecker(const E2eFormat& format) : format_(format) {}

  struct Verdict {
    E2eStatus status = E2eStatus::ok;
    std::uint16_t missing = 0;  // messages that the counter skipped; ok_some_lost and wrong_sequence
    // Whether the data may be used.
    [[nodiscard]] bool good() const { return status <= E2eStatus::ok_some_lost; }
  };
  // `data` has the message's length.
  [[nodiscard]] Verdict check(std::span<const std::uint8_t> data);

 private:
  E2eFormat format_;
  std::optional<std::uint16_t> last_;  // counter of the newest message whose CRC was right
};

}  // namespace cellmirror::can
