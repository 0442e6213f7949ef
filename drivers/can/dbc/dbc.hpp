// DBC: which signals lie where in which frames. Own reader; what decoding does not need is skipped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

enum class ByteOrder : std::uint8_t {
  little_endian,  // @1, Intel: the start bit is the least significant one
  big_endian,     // @0, Motorola: the start bit is the most significant one, counted in the saw-tooth way
};
enum class DbcValueType : std::uint8_t { integer, float32, float64 };

struct DbcSignal {
  std::string name;
  std::string short_name;    // as in DbcMessage
  std::uint16_t start = 0;   // bit, 0..511
  std::uint16_t length = 0;  // bits, 1..64
  ByteOrder order = ByteOrder::little_endian;
  bool is_signed = false;
  DbcValueType type = DbcValueType::integer;  // SIG_VALTYPE_
  double factor = 1.0;                        // physical = raw * factor + offset
  double offset = 0.0;
  double minimum = 0.0;  // both 0: no limits
  double maximum = 0.0;
  std::string unit;
  bool is_multiplexer = false;  // M
  bool is_multiplexed = false;  // m<n>: only there while the multiplexer has one of the values
  // The multiplexer's name; empty: the message's own (M). Named by SG_MUL_VAL_ where multiplexers are nested.
  std::string multiplexer;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> multiplexer_values;  // ranges, ends included
  int line = 0;
};

struct DbcMessage {
  std::string name;
  std::string short_name;  // name that CANdb++ writes instead of one with more than 32 characters; else empty
  std::uint32_t id = 0;    // 11 or 29 bits
  bool extended = false;
  std::uint8_t length = 0;  // bytes, 0..64
  std::vector<DbcSignal> signals;
  int line = 0;

  [[nodiscard]] const DbcSignal* find(std::string_view signal) const;  // by its name or short name
  [[nodiscard]] const DbcSignal* multiplexer() const;
};

// A message or signal that is left out because its description in the file is faulty.
struct DbcFault {
  std::string message;
  std::string signal;  // empty: the whole message
  Diagnostic why;      // an error, to be reported where the message or signal is used
};

struct Dbc {
  std::vector<DbcMessage> messages;
  std::vector<DbcFault> left_out;

  [[nodiscard]] const DbcMessage* find(std::string_view message) const;  // by its name or short name
  // The fault for which a message or signal was left out; nullptr if the file does not have it or it has no fault.
  [[nodiscard]] const DbcFault* fault_of(std::string_view message, std::string_view signal) const;
};

// Reads the whole text; reports all findings in one pass. A faulty message or signal (it reaches beyond its message,
// its name appears twice, a number is out of range) is left out with a warning, since a cell uses few messages of a
// file. A file without messages is an error.
[[nodiscard]] Dbc parse_dbc(std::string_view text, const std::string& file, Diagnostics& diagnostics);
// The same from a file; none where it cannot be read (told in `diagnostics`). At most 16 MiB.
[[nodiscard]] std::optional<Dbc> read_dbc(const std::string& file, Diagnostics& diagnostics);

// Whether the signal is in these data of the message: always, but for multiplexed ones. `data` has the message's
// length.
[[nodiscard]] bool is_present(const DbcMessage& message, const DbcSignal& signal, std::span<const std::uint8_t> data);

// Bytes of data that the signal needs.
[[nodiscard]] std::size_t bytes_needed(const DbcSignal& signal);
// The signal's bits as a number, zero extended. `data` has at least bytes_needed().
[[nodiscard]] std::uint64_t raw_value(const DbcSignal& signal, std::span<const std::uint8_t> data);
// raw * factor + offset, by the signal's type; may be NaN or infinite for float signals.
[[nodiscard]] double physical_value(const DbcSignal& signal, std::span<const std::uint8_t> data);
// Puts a physical value into the data (the inverse; rounds and clamps integers to their range).
void put_physical_value(const DbcSignal& signal, double value, std::span<std::uint8_t> data);

}  // namespace cellmirror::can
