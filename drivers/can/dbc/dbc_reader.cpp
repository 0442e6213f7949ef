#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "drivers/can/dbc/dbc.hpp"
#include "drivers/can/dbc/dbc_scanner.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uintmax_t kMaxDbcBytes = 16U << 20U;
constexpr std::uint32_t kExtendedFlag = 0x8000'0000;
// VECTOR__INDEPENDENT_SIG_MSG: a parking place for signals of no message.
constexpr std::uint32_t kNoMessageId = 0xC000'0000;
constexpr std::size_t kMaxRanges = 256;

// Statements that end with a semicolon and hold nothing that decoding needs.
constexpr std::array<std::string_view, 24> kSkipped = {"CM_",
                                                       "BA_DEF_",
                                                       "BA_",
                                                       "VAL_",
                                                       "VAL_TABLE_",
                                                       "BA_DEF_DEF_",
                                                       "BA_DEF_REL_",
                                                       "BA_REL_",
                                                       "BA_SGTYPE_",
                                                       "BA_DEF_SGTYPE_",
                                                       "BA_DEF_DEF_REL_",
                                                       "SIG_GROUP_",
                                                       "BO_TX_BU_",
                                                       "EV_",
                                                       "EV_DATA_",
                                                       "ENVVAR_DATA_",
                                                       "SGTYPE_",
                                                       "SGTYPE_VAL_",
                                                       "SIG_TYPE_REF_",
                                                       "SIGTYPE_VALTYPE_",
                                                       "CAT_DEF_",
                                                       "CAT_",
                                                       "FILTER",
                                                       "BU_SG_REL_"};

class DbcReader {
 public:
  DbcReader(std::string_view text, const std::string& file, Diagnostics& diagnostics)
      : in_(text), file_(file), diagnostics_(&diagnostics) {}

  Dbc read() {
    for (in_.skip_space(); !in_.at_end(); in_.skip_space()) statement();
    finish();
    return std::move(dbc_);
  }

 private:
  void error(std::string message, std::string remedy = {}) {
    diagnostics_->error({file_, in_.line(), in_.column()}, std::move(message), std::move(remedy));
  }
  void error_at(int line, std::string message) { diagnostics_->error({file_, line, 0}, std::move(message)); }

  // Says what was expected, skips the rest of the line.
  bool expect(bool found, std::string_view what) {
    if (!found) error(fmt::format("expected {}", what));
    return found;
  }

  void statement() {
    const std::string_view word = in_.word();
    if (word == "BO_") {
      if (!message()) in_.skip_line();
    } else if (word == "SG_") {
      if (!signal()) in_.skip_line();
    } else if (word == "SIG_VALTYPE_" && !in_.at_line_end()) {
      if (!value_type()) skip_statement();
    } else if (word == "SG_MUL_VAL_" && !in_.at_line_end()) {
      if (!multiplexer_values()) skip_statement();
    } else if (word == "VERSION" && !in_.at_line_end()) {
      if (!expect(in_.string().has_value(), "a version in quotation marks")) in_.skip_line();
    } else if (word == "NS_" || word == "BS_" || word == "BU_" || word == "SIG_VALTYPE_" || word == "SG_MUL_VAL_" ||
               word == "VERSION") {
      in_.skip_line();
    } else if (std::find(kSkipped.begin(), kSkipped.end(), word) != kSkipped.end()) {
      // Alone on its line it is a name of the list behind NS_.
      if (!in_.at_line_end()) skip_statement();
    } else {
      unknown(word);
    }
  }

  void unknown(std::string_view word) {
    const bool name_of_list = word.ends_with('_') && in_.at_line_end();
    if (!name_of_list) {
      const std::string what =
          word.empty() ? "no statement starts like this" : "unknown statement " + printable(word) + ", skipped";
      diagnostics_->warning({file_, in_.line(), in_.column()}, what);
    }
    in_.skip_line();
  }

  // To the semicolon; strings may hold semicolons and line ends.
  void skip_statement() {
    const int first_line = in_.line();
    while (!in_.at_end()) {
      if (in_.peek() == '"') {
        if (!in_.string()) {
          error_at(first_line, "a string that starts in this statement does not end");
          return;
        }
      } else if (in_.peek() == ';') {
        in_.advance();
        return;
      } else {
        in_.advance();
      }
    }
    error_at(first_line, "the statement does not end with a semicolon");
  }

  std::optional<std::uint64_t> unsigned_number(std::uint64_t most) {
    const std::string_view text = in_.number_text();
    std::uint64_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || problem != std::errc() || end != text.data() + text.size() || value > most) return {};
    return value;
  }

  std::optional<double> number() { return parse_number(in_.number_text()); }

  bool message() {
    current_ = kNone;
    const int line = in_.line();
    const auto raw_id = unsigned_number(0xFFFF'FFFF);
    if (!expect(raw_id.has_value(), "the identifier of the message as a decimal number")) return false;
    const std::string name(in_.word());
    if (!expect(!name.empty() && name.size() <= kMaxName, "the name of the message")) return false;
    if (!expect(in_.take(':'), "':' behind the message's name")) return false;
    const auto length = unsigned_number(0xFFFF);
    if (!expect(length.has_value(), "the message's length in bytes")) return false;
    in_.skip_line();  // the sender
    const auto id = static_cast<std::uint32_t>(*raw_id);
    parked_ = id == kNoMessageId;
    if (parked_) return true;
    return add_message(id, name, *length, line);
  }

  bool add_message(std::uint32_t id, const std::string& name, std::uint64_t length, int line) {
    DbcMessage message;
    message.name = name;
    message.extended = (id & kExtendedFlag) != 0;
    message.id = id & ~kExtendedFlag;
    message.line = line;
    if (message.id > (message.extended ? 0x1FFF'FFFFU : 0x7FFU)) {
      error_at(line, fmt::format("message {}: {} is no CAN identifier", name, id));
      return true;
    }
    if (length > kCanMaxData) {
      error_at(line, fmt::format("message {}: {} bytes, a CAN frame holds at most 64", name, length));
      return true;
    }
    message.length = static_cast<std::uint8_t>(length);
    if (!messages_by_id_.emplace(id, dbc_.messages.size()).second) {
      error_at(line, fmt::format("message {}: the identifier {} appears twice", name, id));
    }
    if (!names_.insert(name).second) error_at(line, fmt::format("the message {} appears twice", name));
    current_ = dbc_.messages.size();
    signal_names_.clear();
    dbc_.messages.push_back(std::move(message));
    return true;
  }

  bool signal() {
    DbcSignal signal;
    signal.line = in_.line();
    signal.name = std::string(in_.word());
    if (!expect(!signal.name.empty() && signal.name.size() <= kMaxName, "the name of the signal")) return false;
    if (!multiplexing(signal)) return false;
    if (!expect(in_.take(':'), "':' behind the signal's name")) return false;
    if (!layout(signal) || !scaling(signal)) return false;
    const auto unit = in_.string();
    if (!expect(unit.has_value(), "the unit in quotation marks")) return false;
    signal.unit = std::string(unit->substr(0, kMaxName));
    in_.skip_line();  // the receivers
    keep(std::move(signal));
    return true;
  }

  bool multiplexing(DbcSignal& signal) {
    std::string_view word = in_.word();
    if (word.empty()) return true;
    if (word == "M") {
      signal.is_multiplexer = true;
      return true;
    }
    if (word.starts_with('m') && word.ends_with('M')) {
      signal.is_multiplexer = true;
      word.remove_suffix(1);
    }
    const long long value = word.starts_with('m') ? parse_integer(word.substr(1)).value_or(-1) : -1;
    if (!expect(value >= 0, "M, m<number> or ':'")) return false;
    signal.is_multiplexed = true;
    signal.multiplexer_values = {{static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(value)}};
    return true;
  }

  bool layout(DbcSignal& signal) {
    const auto start = unsigned_number(8 * kCanMaxData - 1);
    if (!expect(start.has_value(), "the start bit, 0 to 511")) return false;
    if (!expect(in_.take('|'), "'|' after the start bit")) return false;
    const auto length = unsigned_number(64);
    if (!expect(length && *length > 0, "the length in bits, 1 to 64")) return false;
    if (!expect(in_.take('@'), "'@' behind the length")) return false;
    const bool little = in_.peek() == '1';
    if (!expect(little || in_.peek() == '0', "the byte order, 0 or 1")) return false;
    in_.advance();
    const bool is_signed = in_.peek() == '-';
    if (!expect(is_signed || in_.peek() == '+', "+ or - behind the byte order")) return false;
    in_.advance();
    signal.start = static_cast<std::uint16_t>(*start);
    signal.length = static_cast<std::uint16_t>(*length);
    signal.order = little ? ByteOrder::little_endian : ByteOrder::big_endian;
    signal.is_signed = is_signed;
    return true;
  }

  bool scaling(DbcSignal& signal) {
    const auto pair = [this](char open, char middle, char close, double& a, double& b, std::string_view what) {
      if (!expect(in_.take(open), what)) return false;
      const auto first = number();
      if (!expect(first && in_.take(middle), what)) return false;
      const auto second = number();
      if (!expect(second && in_.take(close), what)) return false;
      a = *first;
      b = *second;
      return true;
    };
    if (!pair('(', ',', ')', signal.factor, signal.offset, "(factor,offset)")) return false;
    if (!expect(signal.factor != 0.0, "a factor other than 0")) return false;
    return pair('[', '|', ']', signal.minimum, signal.maximum, "[minimum|maximum]");
  }

  void keep(DbcSignal signal) {
    if (current_ == kNone) {
      if (!parked_) error_at(signal.line, fmt::format("the signal {} belongs to no message", signal.name));
      return;
    }
    DbcMessage& message = dbc_.messages[current_];
    if (bytes_needed(signal) > message.length) {
      error_at(signal.line, fmt::format("the signal {} reaches to byte {}, the message {} has {} bytes", signal.name,
                                        bytes_needed(signal), message.name, message.length));
      return;
    }
    if (!signal_names_.insert(signal.name).second) {
      error_at(signal.line, fmt::format("the signal {} appears twice in {}", signal.name, message.name));
      return;
    }
    message.signals.push_back(std::move(signal));
  }

  // The signal that "<id> <name>" names; told where there is none.
  DbcSignal* named_signal() {
    const auto raw_id = unsigned_number(0xFFFF'FFFF);
    if (!expect(raw_id.has_value(), "the identifier of a message")) return nullptr;
    const std::string_view name = in_.word();
    const auto id = static_cast<std::uint32_t>(*raw_id);
    if (const auto found = messages_by_id_.find(id); found != messages_by_id_.end()) {
      for (DbcSignal& signal : dbc_.messages[found->second].signals) {
        if (signal.name == name) return &signal;
      }
    }
    if (id != kNoMessageId) error(fmt::format("there is no signal {} in a message {}", printable(name), id));
    return nullptr;
  }

  bool value_type() {
    DbcSignal* signal = named_signal();
    if (signal == nullptr) return false;
    in_.take(':');
    const auto type = unsigned_number(3);
    if (!expect(type.has_value(), "the type of the value, 0 to 3")) return false;
    if (*type == 1) signal->type = DbcValueType::float32;
    if (*type == 2) signal->type = DbcValueType::float64;
    return expect(in_.take(';'), "';'");
  }

  bool multiplexer_values() {
    DbcSignal* signal = named_signal();
    if (signal == nullptr) return false;
    std::string multiplexer(in_.word());
    std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
    do {
      const std::string_view text = in_.number_text();
      const std::size_t dash = text.find('-');
      const long long low = parse_integer(text.substr(0, dash)).value_or(-1);
      const long long high = dash == std::string_view::npos ? -1 : parse_integer(text.substr(dash + 1)).value_or(-1);
      if (!expect(low >= 0 && high >= low && ranges.size() < kMaxRanges, "a range such as 0-3")) return false;
      ranges.emplace_back(static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high));
    } while (in_.take(','));
    signal->is_multiplexed = true;
    signal->multiplexer = std::move(multiplexer);
    signal->multiplexer_values = std::move(ranges);
    return expect(in_.take(';'), "';'");
  }

  void finish() {
    for (DbcMessage& message : dbc_.messages) {
      std::erase_if(message.signals, [&](const DbcSignal& signal) { return !is_consistent(message, signal); });
    }
  }

  bool is_consistent(const DbcMessage& message, const DbcSignal& signal) {
    if ((signal.type == DbcValueType::float32 && signal.length != 32) ||
        (signal.type == DbcValueType::float64 && signal.length != 64)) {
      error_at(signal.line, fmt::format("the signal {} is a float of {} bits", signal.name, signal.length));
      return false;
    }
    if (!signal.is_multiplexed) return true;
    const bool known =
        signal.multiplexer.empty() ? message.multiplexer() != nullptr : message.find(signal.multiplexer) != nullptr;
    if (!known) error_at(signal.line, fmt::format("the signal {} has no multiplexer in {}", signal.name, message.name));
    return known;
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  static constexpr std::size_t kMaxName = 128;

  DbcScanner in_;
  std::string file_;
  Diagnostics* diagnostics_;
  Dbc dbc_;
  std::size_t current_ = kNone;
  bool parked_ = false;
  std::map<std::uint32_t, std::size_t> messages_by_id_;  // with the flag of bit 31
  std::set<std::string> names_;
  std::set<std::string> signal_names_;
};

}  // namespace

const DbcSignal* DbcMessage::find(std::string_view signal) const {
  const auto found = std::find_if(signals.begin(), signals.end(), [&](const DbcSignal& s) { return s.name == signal; });
  return found == signals.end() ? nullptr : &*found;
}

const DbcSignal* DbcMessage::multiplexer() const {
  const auto found = std::find_if(signals.begin(), signals.end(),
                                  [](const DbcSignal& s) { return s.is_multiplexer && !s.is_multiplexed; });
  return found == signals.end() ? nullptr : &*found;
}

const DbcMessage* Dbc::find(std::string_view message) const {
  const auto found =
      std::find_if(messages.begin(), messages.end(), [&](const DbcMessage& m) { return m.name == message; });
  return found == messages.end() ? nullptr : &*found;
}

Dbc parse_dbc(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  return DbcReader(text, file, diagnostics).read();
}

std::optional<Dbc> read_dbc(const std::string& file, Diagnostics& diagnostics) {
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(file, problem);
  if (problem || !std::filesystem::is_regular_file(file, problem)) {
    diagnostics.error({file, 0, 0}, "cannot read the DBC file", "check the path and its permissions");
    return {};
  }
  if (size > kMaxDbcBytes) {
    diagnostics.error({file, 0, 0}, fmt::format("the DBC file has {} bytes, at most {} are read", size, kMaxDbcBytes));
    return {};
  }
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in && text.empty()) {
    diagnostics.error({file, 0, 0}, "cannot read the DBC file", "check its permissions");
    return {};
  }
  return parse_dbc(text, file, diagnostics);
}

}  // namespace cellmirror::can
