#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "drivers/can/dbc/dbc.hpp"
#include "drivers/can/dbc/dbc_scanner.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uintmax_t kMaxDbcBytes = 16U << 20U;
constexpr std::uint32_t kExtendedFlag = 0x8000'0000;
// Pseudo message that holds signals without a message. Tools choose its identifier, in most cases 0xC0000000.
constexpr std::string_view kNoMessage = "VECTOR__INDEPENDENT_SIG_MSG";
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

// Statements that are read.
constexpr std::array<std::string_view, 8> kRead = {"BO_",     "SG_", "SIG_VALTYPE_", "SG_MUL_VAL_",
                                                   "VERSION", "NS_", "BS_",          "BU_"};

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
  // Leaves out a message, or one of its signals (if `signal` is not empty). A warning here, since the cell may not need
  // it; an error where it is used.
  void spoil(const std::string& message, const std::string& signal, const Place& place, const std::string& what,
             const std::string& remedy = {}) {
    diagnostics_->warning(place, what + ": left out", remedy);
    dbc_.left_out.push_back({message, signal, {Severity::error, place, what, remedy}});
    spoiled_.emplace(message, signal);
  }
  [[nodiscard]] Place here() const { return {file_, in_.line(), in_.column()}; }
  [[nodiscard]] Place line_place(int line) const { return {file_, line, 0}; }

  // If not `found`, reports `what` as expected and leaves out the current message or signal if its name is known.
  bool expect(bool found, std::string_view what) {
    if (found) return true;
    const std::string text = fmt::format("expected {}", what);
    if (reading_message_.empty()) {
      diagnostics_->warning(here(), text + ": the line is left out");
    } else {
      spoil(reading_message_, reading_signal_, here(), text);
    }
    return false;
  }

  void statement() {
    reading_message_.clear();
    reading_signal_.clear();
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
    } else if (std::ranges::find(kRead, word) != kRead.end()) {
      in_.skip_line();
    } else if (std::ranges::find(kSkipped, word) != kSkipped.end()) {
      // Alone on its line it is a name of the list behind NS_.
      if (in_.at_line_end()) return;
      if (word == "BA_") long_name();
      skip_statement();
    } else {
      unknown(word);
    }
  }

  void unknown(std::string_view word) {
    const bool name_of_list = word.ends_with('_') && in_.at_line_end();
    if (!name_of_list) {
      const std::string what = word.empty() ? "the line does not begin with a statement: skipped"
                                            : "unknown statement " + printable(word) + ": skipped";
      diagnostics_->warning(here(), what);
    }
    in_.skip_line();
  }

  // Returns true if the next line begins a statement.
  [[nodiscard]] bool at_statement() const {
    DbcScanner probe = in_;
    const std::string_view word = probe.word();
    if (word.empty() || probe.at_line_end()) return false;
    return std::ranges::find(kRead, word) != kRead.end() || std::ranges::find(kSkipped, word) != kSkipped.end();
  }

  // To the semicolon; strings may hold semicolons and line ends.
  void skip_statement() {
    const int first_line = in_.line();
    const DbcScanner start = in_;
    while (!in_.at_end()) {
      if (in_.peek() == '"') {
        if (in_.string()) continue;
        diagnostics_->warning(line_place(first_line), "a string that starts in this statement does not end: skipped");
        in_ = start;
        in_.skip_line();
        return;
      }
      const char c = in_.peek();
      in_.advance();
      if (c == ';') return;
      if (c == '\n' && at_statement()) break;
    }
    diagnostics_->warning(line_place(first_line), "the statement does not end with a semicolon");
  }

  // BA_ "SystemMessageLongSymbol" BO_ 256 "..." and BA_ "SystemSignalLongSymbol" SG_ 256 Short "...": CANdb++ shortens
  // names to 32 characters and keeps the full names in these attributes.
  void long_name() {
    const auto attribute = in_.string();
    const bool of_signal = attribute == "SystemSignalLongSymbol";
    if (!of_signal && attribute != "SystemMessageLongSymbol") return;
    if (in_.word() != (of_signal ? "SG_" : "BO_")) return;
    const auto id = unsigned_number(0xFFFF'FFFF);
    const std::string signal(of_signal ? in_.word() : std::string_view{});
    const auto name = in_.string();
    const bool fits = name && !name->empty() && name->size() <= kMaxName && name->find_first_of("\"\n") == name->npos;
    if (!id || !fits) return;
    const auto found = messages_by_id_.find(static_cast<std::uint32_t>(*id));
    if (found == messages_by_id_.end()) return;
    long_names_.push_back({dbc_.messages[found->second].name, signal, std::string(*name), in_.line()});
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
    skipping_ = true;  // skips the signals until the message proves usable
    const Place place = line_place(in_.line());
    const auto raw_id = unsigned_number(0xFFFF'FFFF);
    if (!expect(raw_id.has_value(), "the identifier of the message as a decimal number")) return false;
    const std::string name(in_.word());
    if (!expect(!name.empty() && name.size() <= kMaxName, "the name of the message")) return false;
    has_messages_ = true;
    reading_message_ = name;
    if (!expect(in_.take(':'), "':' behind the message's name")) return false;
    const auto length = unsigned_number(0xFFFF'FFFF);
    if (!expect(length.has_value(), "the message's length in bytes")) return false;
    in_.skip_line();  // the sender
    const auto id = static_cast<std::uint32_t>(*raw_id);
    if (id == kNoMessageId || name == kNoMessage) {
      parked_ids_.insert(id);
    } else {
      add_message(id, name, *length, place);
    }
    return true;
  }

  void add_message(std::uint32_t id, const std::string& name, std::uint64_t length, const Place& place) {
    DbcMessage message;
    message.name = name;
    message.extended = (id & kExtendedFlag) != 0;
    message.id = id & ~kExtendedFlag;
    message.line = place.line;
    if (message.id > (message.extended ? 0x1FFF'FFFFU : 0x7FFU)) {
      parked_ids_.insert(id);
      spoil(name, {}, place, fmt::format("message {}: {} is not a CAN identifier", name, id),
            "write 0 to 2047, or an identifier of 29 bits plus 2147483648");
      return;
    }
    if (length > kCanMaxData) {
      parked_ids_.insert(id);
      spoil(name, {}, place,
            fmt::format("message {} has {} bytes, a CAN frame holds at most {}", name, length, kCanMaxData),
            "messages of several frames (J1939 transport, ISO-TP) are not read");
      return;
    }
    message.length = static_cast<std::uint8_t>(length);
    if (const auto other = messages_by_id_.find(id); other != messages_by_id_.end()) {
      spoil(name, {}, place,
            fmt::format("message {} has the identifier {} of {}", name, id, dbc_.messages[other->second].name),
            "give each message an identifier of its own");
      return;
    }
    if (!names_.insert(name).second) {
      parked_ids_.insert(id);
      spoil(name, {}, place, fmt::format("the message {} appears twice", name), "give each message a name of its own");
      return;
    }
    messages_by_id_.emplace(id, dbc_.messages.size());
    current_ = dbc_.messages.size();
    skipping_ = false;
    signal_names_.clear();
    dbc_.messages.push_back(std::move(message));
  }

  bool signal() {
    if (current_ == kNone) {
      if (!skipping_)
        diagnostics_->warning(line_place(in_.line()), "the signal does not belong to a message: left out");
      return false;
    }
    DbcSignal signal;
    signal.line = in_.line();
    signal.name = std::string(in_.word());
    if (!expect(!signal.name.empty() && signal.name.size() <= kMaxName, "the name of the signal")) return false;
    reading_message_ = dbc_.messages[current_].name;
    reading_signal_ = signal.name;
    if (!multiplexing(signal)) return false;
    if (!expect(in_.take(':'), "':' behind the signal's name")) return false;
    if (!layout(signal) || !scaling(signal)) return false;
    read_limits(signal);
    if (const auto unit = in_.string()) {
      signal.unit = std::string(unit->substr(0, kMaxName));
    } else {
      diagnostics_->warning(
          here(), fmt::format("signal {}: expected the unit in quotation marks: no unit is used", signal.name));
    }
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

  // Reads two numbers; `brackets` has the opening bracket, the separator and the closing bracket.
  bool pair(std::string_view brackets, double& a, double& b) {
    if (!in_.take(brackets[0])) return false;
    const auto first = number();
    if (!first || !in_.take(brackets[1])) return false;
    const auto second = number();
    if (!second || !in_.take(brackets[2])) return false;
    a = *first;
    b = *second;
    return true;
  }

  bool scaling(DbcSignal& signal) {
    if (!expect(pair("(,)", signal.factor, signal.offset), "(factor,offset)")) return false;
    return expect(signal.factor != 0.0, "a factor other than 0");
  }

  // Unreadable limits are not a fault: decoding does not need them, and tools write infinities such as 1.#INF.
  void read_limits(DbcSignal& signal) {
    if (pair("[|]", signal.minimum, signal.maximum)) return;
    signal.minimum = signal.maximum = 0.0;
    diagnostics_->warning(here(),
                          fmt::format("signal {}: expected [minimum|maximum]: no limits are used", signal.name));
    while (!in_.at_line_end() && in_.peek() != ']' && in_.peek() != '"') in_.advance();
    in_.take(']');
  }

  void keep(DbcSignal signal) {
    DbcMessage& message = dbc_.messages[current_];
    const Place place = line_place(signal.line);
    if (bytes_needed(signal) > message.length) {
      spoil(message.name, signal.name, place,
            fmt::format("the signal {} reaches to byte {}, the message {} has {} bytes", signal.name,
                        bytes_needed(signal), message.name, message.length),
            "check start bit, length and byte order");
      return;
    }
    if (!signal_names_.insert(signal.name).second) {
      spoil(message.name, signal.name, place,
            fmt::format("the signal {} appears twice in {}", signal.name, message.name),
            "give each signal a name of its own");
      return;
    }
    if (message.signals.size() >= kMaxSignals) {
      spoil(message.name, signal.name, place,
            fmt::format("the message {} has more than {} signals", message.name, kMaxSignals));
      return;
    }
    message.signals.push_back(std::move(signal));
  }

  // The signal that "<id> <name>" names. Warns if it does not exist, unless it or its message was left out.
  DbcSignal* named_signal() {
    const auto raw_id = unsigned_number(0xFFFF'FFFF);
    if (!expect(raw_id.has_value(), "the identifier of a message")) return nullptr;
    const std::string_view name = in_.word();
    const auto id = static_cast<std::uint32_t>(*raw_id);
    const auto found = messages_by_id_.find(id);
    if (found != messages_by_id_.end()) {
      DbcMessage& message = dbc_.messages[found->second];
      for (DbcSignal& signal : message.signals) {
        if (signal.name != name) continue;
        reading_message_ = message.name;
        reading_signal_ = signal.name;
        return &signal;
      }
    }
    const bool left_out =
        id == kNoMessageId || parked_ids_.contains(id) ||
        (found != messages_by_id_.end() && is_spoiled(dbc_.messages[found->second].name, std::string(name)));
    if (!left_out) {
      diagnostics_->warning(here(), fmt::format("there is no signal {} in a message {}: skipped", printable(name), id));
    }
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
    return end_of_statement();
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
    return end_of_statement();
  }

  // A missing semicolon at the end of a line is only a warning: the statement was read completely.
  bool end_of_statement() {
    if (in_.take(';')) return true;
    if (!in_.at_line_end()) return expect(false, "';'");
    diagnostics_->warning(line_place(in_.line()), "the statement does not end with a semicolon");
    return true;
  }

  void finish() {
    for (DbcMessage& message : dbc_.messages) {
      std::erase_if(message.signals, [&](const DbcSignal& signal) { return !is_usable(message, signal); });
    }
    std::erase_if(dbc_.messages, [this](const DbcMessage& message) { return is_spoiled(message.name, {}); });
    for (std::size_t i = 0; i < dbc_.messages.size(); ++i) numbers_.emplace(dbc_.messages[i].name, i);
    for (const LongName& name : long_names_) rename(name);
    rename_faults();
    if (!has_messages_) {
      diagnostics_->error({file_, 0, 0}, "the file describes no message (BO_)", "is it a DBC file?");
    }
  }

  bool is_usable(const DbcMessage& message, const DbcSignal& signal) {
    if (is_spoiled(message.name, signal.name)) return false;
    const Place place = line_place(signal.line);
    if ((signal.type == DbcValueType::float32 && signal.length != 32) ||
        (signal.type == DbcValueType::float64 && signal.length != 64)) {
      spoil(message.name, signal.name, place,
            fmt::format("the signal {} is a float of {} bits", signal.name, signal.length),
            "floats have 32 or 64 bits: check its length and SIG_VALTYPE_");
      return false;
    }
    if (!signal.is_multiplexed) return true;
    const bool known =
        signal.multiplexer.empty() ? message.multiplexer() != nullptr : message.find(signal.multiplexer) != nullptr;
    if (!known) {
      spoil(message.name, signal.name, place,
            fmt::format("the signal {} has no multiplexer in {}", signal.name, message.name),
            "mark the multiplexer with M");
    }
    return known;
  }

  [[nodiscard]] bool is_spoiled(const std::string& message, const std::string& signal) const {
    return spoiled_.contains({message, signal});
  }

  struct LongName {
    std::string message;  // short
    std::string signal;   // short; empty: the message itself
    std::string name;
    int line = 0;
  };

  // Replaces the short name by the full name; find() still accepts the short one.
  void rename(const LongName& name) {
    const auto replace = [&](auto& named, bool is_free) {
      if (named.name == name.name) return;
      if (!is_free) {
        diagnostics_->warning(line_place(name.line), fmt::format("the long name {} of {} is already in use: ignored",
                                                                 printable(name.name), named.name));
      } else if (named.short_name.empty()) {
        named.short_name = std::exchange(named.name, name.name);
      }
    };
    const auto number = numbers_.find(name.message);
    if (number == numbers_.end()) return;
    DbcMessage& message = dbc_.messages[number->second];
    if (name.signal.empty()) return replace(message, names_.insert(name.name).second);
    const auto signal = std::ranges::find(message.signals, name.signal, &DbcSignal::name);
    if (signal != message.signals.end()) replace(*signal, message.find(name.name) == nullptr);
  }

  // Makes faults known under the long names too, so that fault_of() finds them by either name.
  void rename_faults() {
    std::map<std::pair<std::string, std::string>, std::string> long_names;
    for (const LongName& name : long_names_) long_names.try_emplace({name.message, name.signal}, name.name);
    if (long_names.empty()) return;
    const std::size_t count = dbc_.left_out.size();
    for (std::size_t i = 0; i < count; ++i) {
      DbcFault other = dbc_.left_out[i];
      const auto long_message = long_names.find({other.message, {}});
      const auto long_signal = long_names.find({other.message, other.signal});
      if (long_message != long_names.end()) other.message = long_message->second;
      if (!other.signal.empty()) dbc_.left_out[i].message = other.message;  // its name after rename()
      if (long_signal != long_names.end() && !other.signal.empty()) other.signal = long_signal->second;
      const bool differs = other.message != dbc_.left_out[i].message || other.signal != dbc_.left_out[i].signal;
      if (differs) dbc_.left_out.push_back(std::move(other));
    }
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  static constexpr std::size_t kMaxName = 256;
  static constexpr std::size_t kMaxSignals = 4096;  // per message

  DbcScanner in_;
  std::string file_;
  Diagnostics* diagnostics_;
  Dbc dbc_;
  std::size_t current_ = kNone;
  bool skipping_ = false;
  bool has_messages_ = false;
  // The message and signal that are being read; empty until the name is known.
  std::string reading_message_;
  std::string reading_signal_;
  std::vector<LongName> long_names_;
  std::map<std::string, std::size_t> numbers_;             // position of each message, by short name
  std::set<std::pair<std::string, std::string>> spoiled_;  // as in Dbc::left_out
  std::set<std::uint32_t> parked_ids_;                     // identifiers of messages that are left out
  std::map<std::uint32_t, std::size_t> messages_by_id_;    // with the flag of bit 31
  std::set<std::string> names_;
  std::set<std::string> signal_names_;
};

}  // namespace

const DbcSignal* DbcMessage::find(std::string_view signal) const {
  const auto found = std::find_if(signals.begin(), signals.end(), [&](const DbcSignal& s) {
    return s.name == signal || (!s.short_name.empty() && s.short_name == signal);
  });
  return found == signals.end() ? nullptr : &*found;
}

const DbcSignal* DbcMessage::multiplexer() const {
  const auto found = std::find_if(signals.begin(), signals.end(),
                                  [](const DbcSignal& s) { return s.is_multiplexer && !s.is_multiplexed; });
  return found == signals.end() ? nullptr : &*found;
}

const DbcMessage* Dbc::find(std::string_view message) const {
  const auto found = std::find_if(messages.begin(), messages.end(), [&](const DbcMessage& m) {
    return m.name == message || (!m.short_name.empty() && m.short_name == message);
  });
  return found == messages.end() ? nullptr : &*found;
}

const DbcFault* Dbc::fault_of(std::string_view message, std::string_view signal) const {
  const auto found = std::find_if(left_out.begin(), left_out.end(), [&](const DbcFault& fault) {
    return fault.message == message && fault.signal == signal;
  });
  return found == left_out.end() ? nullptr : &*found;
}

Dbc parse_dbc(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
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
