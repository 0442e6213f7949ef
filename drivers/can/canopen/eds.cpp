#include "drivers/can/canopen/eds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/ini.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uintmax_t kMaxEdsBytes = 16U << 20U;
constexpr std::uint64_t kArray = 8;
constexpr std::uint64_t kRecord = 9;
constexpr std::size_t kMaxText = 256;

// Returns `text` without a trailing comment and without enclosing quotation marks. Not for text values, which may
// contain these characters.
std::string_view without_comment(std::string_view text) {
  text = trimmed(text.substr(0, std::min(text.find_first_of(";#"), text.find("//"))));
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = trimmed(text.substr(1, text.size() - 2));
  return text;
}

// A number and whether it was written with a minus.
struct Number {
  std::uint64_t magnitude = 0;
  bool negative = false;
};

// Hexadecimal with 0x, octal with 0, else decimal (CiA 306, 4.1). Some tools pad decimal numbers with zeros: a number
// with a leading zero and a digit 8 or 9 is decimal.
std::optional<Number> parse_ini_number(std::string_view text) {
  Number number;
  text = without_comment(text);
  if (text.starts_with('-')) {
    number.negative = true;
    text.remove_prefix(1);
  }
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    base = 16;
    text.remove_prefix(2);
  } else if (text.size() > 1 && text.front() == '0' && text.find_first_of("89") == std::string_view::npos) {
    base = 8;
    text.remove_prefix(1);
  }
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number.magnitude, base);
  if (text.empty() || problem != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

// A number, $NODEID, or the sum of two of them in any order.
std::optional<Number> parse_expression(std::string_view text, std::uint8_t node_id) {
  text = without_comment(text);
  Number sum;
  for (int terms = 0; terms < 2; ++terms) {
    const std::size_t plus = text.find('+');
    const std::string_view term = trimmed(text.substr(0, plus));
    Number value{node_id, false};
    if (!equal_ignoring_case(term, "$nodeid")) {
      const auto number = parse_ini_number(term);
      if (!number) return {};
      value = *number;
    }
    if (plus == std::string_view::npos && terms == 0) return value;
    if (value.negative || value.magnitude > ~std::uint64_t{0} - sum.magnitude) return {};
    sum.magnitude += value.magnitude;
    if (plus == std::string_view::npos) return sum;
    text.remove_prefix(plus + 1);
  }
  return {};
}

// Two's complement; a signed object may be written as the unsigned number of its bits (0xFFFFFFFF for -1).
std::optional<std::uint64_t> fit(const Number& number, DataType type) {
  const std::size_t bits = 8 * size_of(type);
  const std::uint64_t mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  if (!number.negative) return number.magnitude <= mask ? std::optional(number.magnitude) : std::nullopt;
  const bool fits = is_signed_type(type) && number.magnitude <= (mask >> 1) + 1;
  return fits ? std::optional((~number.magnitude + 1) & mask) : std::nullopt;
}

bool is_hex(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
  });
}

unsigned from_hex(std::string_view text) {
  unsigned value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return value;
}

class EdsReader {
 public:
  EdsReader(IniFile ini, const std::string& file, std::uint8_t node_id, Diagnostics& diagnostics)
      : ini_(std::move(ini)), file_(file), node_id_(node_id), diagnostics_(&diagnostics) {}

  DeviceDescription read() {
    if (const auto info = ini_.find("deviceinfo"); info != ini_.end()) {
      if (const IniValue* vendor = info->second.find("vendorname")) device_.vendor = vendor->text.substr(0, kMaxText);
      if (const IniValue* product = info->second.find("productname"))
        device_.product = product->text.substr(0, kMaxText);
    }
    read_commissioned_node();
    for (const auto& [name, section] : ini_) object_section(name, section);
    check_list("mandatoryobjects");
    check_list("optionalobjects");
    check_list("manufacturerobjects");
    if (device_.objects.size() == 0) {
      diagnostics_->error({file_, 0, 0}, "the file describes no object", "is it an EDS or DCF file?");
    }
    return std::move(device_);
  }

 private:
  void warn(const Place& place, std::string message, std::string remedy = {}) {
    diagnostics_->warning(place, std::move(message), std::move(remedy));
  }
  [[nodiscard]] Place place_of(const IniValue& value) const { return {file_, value.line, value.column}; }

  // Marks an object as unusable. A warning here, since the cell may not need the object; an error where it is used.
  void spoil(ObjectAddress address, const Place& place, const std::string& message, const std::string& remedy) {
    warn(place, message, remedy);
    device_.faults.try_emplace(address, Diagnostic{Severity::error, place, message, remedy});
  }

  // CiA 306 spells the section of a DCF with one m; tools write both spellings.
  void read_commissioned_node() {
    for (const char* name : {"devicecomissioning", "devicecommissioning"}) {
      const auto found = ini_.find(name);
      if (found == ini_.end()) continue;
      const IniValue* value = found->second.find("nodeid");
      const auto number = value == nullptr ? std::nullopt : parse_ini_number(value->text);
      if (!number || number->negative || number->magnitude < 1 || number->magnitude > kMaxNodeId) continue;
      device_.commissioned_node = static_cast<std::uint8_t>(number->magnitude);
      device_.commissioned_place = place_of(*value);
    }
  }

  // "1000", "1018sub1"; sections with other names are not objects.
  void object_section(std::string_view name, const IniSection& section) {
    if (name.size() < 4 || !is_hex(name.substr(0, 4))) return;
    ObjectAddress address{static_cast<std::uint16_t>(from_hex(name.substr(0, 4))), 0};
    const std::string_view rest = name.substr(4);
    if (!rest.empty()) {
      if (!rest.starts_with("sub") || !is_hex(rest.substr(3)) || rest.size() > 5) return;
      address.subindex = static_cast<std::uint8_t>(from_hex(rest.substr(3)));
      add_object(address, section);
      return;
    }
    const auto compact = number_of(section, "compactsubobj");
    if (compact && *compact > 0) {
      add_compact(address.index, section, *compact);
      return;
    }
    const auto kind = number_of(section, "objecttype");
    // An object with subindices has its values there. Some files leave out the type of the object.
    if (kind == kArray || kind == kRecord || number_of(section, "subnumber").value_or(0) > 0) return;
    add_object(address, section);
  }

  std::optional<std::uint64_t> number_of(const IniSection& section, std::string_view key) {
    const IniValue* value = section.find(key);
    if (value == nullptr || without_comment(value->text).empty()) return {};
    const auto number = parse_ini_number(value->text);
    if (!number || number->negative) {
      warn(place_of(*value), fmt::format("'{}' is not a number: ignored", printable(value->text)),
           "write a decimal number, or a hexadecimal one with 0x");
      return {};
    }
    return number->magnitude;
  }

  std::optional<ObjectEntry> entry_of(ObjectAddress address, const IniSection& section) {
    ObjectEntry entry;
    if (const IniValue* name = section.find("parametername")) entry.name = name->text.substr(0, kMaxText);
    const Place place{file_, section.line, 0};
    const auto type = number_of(section, "datatype");
    if (!type) {
      spoil(address, place, fmt::format("[{}] has no DataType: left out", printable(section.name)),
            "write the type of its value, such as DataType=0x0007 for UNSIGNED32");
      return {};
    }
    entry.type = static_cast<DataType>(*type);
    const bool known = *type <= 0x1B && (size_of(entry.type) > 0 || entry.type == DataType::visible_string ||
                                         entry.type == DataType::octet_string ||
                                         entry.type == DataType::unicode_string || entry.type == DataType::domain);
    if (!known) {
      spoil(address, place,
            fmt::format("[{}] has the unknown DataType 0x{:X}: left out", printable(section.name), *type),
            "write a type of CiA 301, 0x1 to 0x1B");
      return {};
    }
    entry.access = access_of(section);
    entry.pdo_mappable = number_of(section, "pdomapping").value_or(0) != 0;
    entry.low_limit = limit_of(section, "lowlimit", entry.type);
    entry.high_limit = limit_of(section, "highlimit", entry.type);
    return entry;
  }

  ObjectAccess access_of(const IniSection& section) {
    const IniValue* access = section.find("accesstype");
    if (access == nullptr) return ObjectAccess::read_write;
    const std::string text = lower_case(without_comment(access->text));
    if (text == "ro") return ObjectAccess::read_only;
    if (text == "wo") return ObjectAccess::write_only;
    if (text == "const") return ObjectAccess::constant;
    if (text != "rw" && text != "rwr" && text != "rww") {
      warn(place_of(*access), fmt::format("'{}' is not an AccessType: taken as rw", printable(access->text)),
           "write ro, wo, rw, rwr, rww or const");
    }
    return ObjectAccess::read_write;
  }

  std::optional<std::int64_t> limit_of(const IniSection& section, std::string_view key, DataType type) {
    const IniValue* value = section.find(key);
    if (value == nullptr || without_comment(value->text).empty() || !is_integer_type(type)) return {};
    const auto number = parse_expression(value->text, node_id_);
    const auto raw = number ? fit(*number, type) : std::nullopt;
    if (!raw) {
      warn(place_of(*value), fmt::format("'{}' is not a limit that {} can hold: ignored", printable(value->text),
                                         bytes_text(size_of(type))));
      return {};
    }
    if (is_signed_type(type)) return sign_extended(*raw, 8 * size_of(type));
    if (*raw > static_cast<std::uint64_t>(INT64_MAX)) return {};
    return static_cast<std::int64_t>(*raw);
  }

  static std::string bytes_text(std::size_t bytes) { return fmt::format("{} byte{}", bytes, bytes == 1 ? "" : "s"); }

  void set_value(ObjectAddress address, ObjectEntry& entry, const IniValue* value) {
    entry.value.assign(size_of(entry.type), 0);
    if (value == nullptr) return;
    if (entry.type == DataType::visible_string) {
      entry.value.assign(value->text.begin(), value->text.end());
      return;
    }
    if (without_comment(value->text).empty()) return;
    if (is_integer_type(entry.type)) {
      const auto number = parse_expression(value->text, node_id_);
      const auto raw = number ? fit(*number, entry.type) : std::nullopt;
      if (!raw) {
        spoil(address, place_of(*value),
              fmt::format("'{}' is not a value that {} can hold: the object {} gets 0", printable(value->text),
                          bytes_text(entry.value.size()), text(address)),
              "check DataType and value");
        return;
      }
      put_le(entry.value, *raw, entry.value.size());
    } else if (entry.type == DataType::real32 || entry.type == DataType::real64) {
      set_real(address, entry, *value);
    }
  }

  void set_real(ObjectAddress address, ObjectEntry& entry, const IniValue& value) {
    const bool single = entry.type == DataType::real32;
    if (const auto number = parse_number(without_comment(value.text))) {
      const std::uint64_t raw =
          single ? std::bit_cast<std::uint32_t>(static_cast<float>(*number)) : std::bit_cast<std::uint64_t>(*number);
      put_le(entry.value, raw, entry.value.size());
    } else if (const auto bits = parse_ini_number(value.text); bits && !bits->negative) {
      put_le(entry.value, bits->magnitude, entry.value.size());  // the bits of the number, as some tools write
    } else {
      spoil(address, place_of(value),
            fmt::format("'{}' is not a real number: the object {} gets 0", printable(value.text), text(address)),
            "check DataType and value");
    }
  }

  void add_object(ObjectAddress address, const IniSection& section) {
    auto entry = entry_of(address, section);
    if (!entry) return;
    const IniValue* value = section.find("parametervalue");
    set_value(address, *entry, value != nullptr ? value : section.find("defaultvalue"));
    store(address, std::move(*entry));
  }

  // CompactSubObj=n: n subindices that look alike, their values in [1003Value].
  void add_compact(std::uint16_t index, const IniSection& section, std::uint64_t count) {
    if (count > 254) {
      spoil({index, 0}, {file_, section.line, 0},
            fmt::format("[{}]: CompactSubObj={} is beyond 254 subindices: left out", printable(section.name), count),
            "write the number of subindices after subindex 0, at most 254");
      return;
    }
    const auto common = entry_of({index, 0}, section);
    if (!common) return;
    const auto values = ini_.find(fmt::format("{:04x}value", index));
    ObjectEntry highest;
    highest.name = "NrOfObjects";
    highest.type = DataType::unsigned8;
    highest.access = ObjectAccess::read_only;
    highest.value = {static_cast<std::uint8_t>(count)};
    store({index, 0}, highest);
    for (std::uint64_t i = 1; i <= count; ++i) {
      const ObjectAddress address{index, static_cast<std::uint8_t>(i)};
      ObjectEntry entry = *common;
      const IniValue* value = section.find("defaultvalue");
      if (values != ini_.end()) {
        if (const IniValue* own = values->second.find(std::to_string(i))) value = own;
      }
      set_value(address, entry, value);
      store(address, std::move(entry));
    }
  }

  void store(ObjectAddress address, ObjectEntry entry) {
    if (device_.objects.set(address, std::move(entry))) return;
    if (!full_) {
      warn({file_, 0, 0}, fmt::format("more than {} objects: those from {} on are left out",
                                      ObjectDictionary::kMaxEntries, text(address)));
    }
    full_ = true;
  }

  // [MandatoryObjects] and its sisters: each listed object has to be described.
  void check_list(std::string_view name) {
    const auto found = ini_.find(name);
    if (found == ini_.end()) return;
    for (const auto& [key, value] : found->second.values) {
      if (key == "supportedobjects") continue;
      const auto number = parse_ini_number(value.text);
      if (!number || number->negative || number->magnitude > 0xFFFF) {
        warn(place_of(value), fmt::format("'{}' is not the index of an object: ignored", printable(value.text)),
             "write 0x0000 to 0xFFFF");
      } else if (!ini_.contains(fmt::format("{:04x}", number->magnitude))) {
        warn(place_of(value), fmt::format("the object 0x{:04X} is listed but not described", number->magnitude));
      }
    }
  }

  IniFile ini_;
  std::string file_;
  std::uint8_t node_id_;
  Diagnostics* diagnostics_;
  DeviceDescription device_;
  bool full_ = false;
};

}  // namespace

DeviceDescription parse_eds(std::string_view text, const std::string& file, std::uint8_t node_id,
                            Diagnostics& diagnostics) {
  CELLMIRROR_EXPECTS(node_id >= 1 && node_id <= kMaxNodeId);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  return EdsReader(parse_ini(text, file, diagnostics), file, node_id, diagnostics).read();
}

std::optional<DeviceDescription> read_eds(const std::string& file, std::uint8_t node_id, Diagnostics& diagnostics) {
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(file, problem);
  if (problem || !std::filesystem::is_regular_file(file, problem)) {
    diagnostics.error({file, 0, 0}, "cannot read the EDS or DCF file", "check the path and its permissions");
    return {};
  }
  if (size > kMaxEdsBytes) {
    diagnostics.error({file, 0, 0}, fmt::format("the file has {} bytes, at most {} are read", size, kMaxEdsBytes));
    return {};
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    diagnostics.error({file, 0, 0}, "cannot read the EDS or DCF file", "check its permissions");
    return {};
  }
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return parse_eds(text, file, node_id, diagnostics);
}

namespace {

// Reads the TPDOs of a description. A faulty object is an error if a TPDO that a stream could use needs it; otherwise
// it is ignored.
class TpdoReader {
 public:
  TpdoReader(const DeviceDescription& device, std::uint8_t node_id, const std::string& file, Diagnostics& diagnostics)
      : device_(&device), node_id_(node_id), file_(file), diagnostics_(&diagnostics) {}

  // Returns nothing if the TPDO does not exist or cannot be used.
  std::optional<TpdoConfig> read(std::uint16_t i) {
    parameters_ = static_cast<std::uint16_t>(0x1800 + i);
    mapping_ = static_cast<std::uint16_t>(0x1A00 + i);
    const bool broken = is_broken();
    const auto count = number(mapping_, 0);
    if (!broken && (count < 1 || count > static_cast<std::int64_t>(kMaxPdoEntries))) return {};
    TpdoConfig tpdo;
    tpdo.number = static_cast<std::uint8_t>(i + 1);
    auto cob_id = static_cast<std::uint32_t>(number(parameters_, 1));
    if ((cob_id & kCobIdInvalid) != 0) return {};
    cob_id &= ~kCobIdNoRtr;
    const bool named = cob_id != 0 || device_->faults.contains({parameters_, 1});
    if (!named && i >= 4) return {};  // beyond the predefined ones
    tpdo.cob_id = cob_id != 0 || i >= 4 ? cob_id : tpdo_cob_id(i + 1, node_id_);
    tpdo.transmission_type = static_cast<std::uint8_t>(device_->objects.integer({parameters_, 2}).value_or(255));
    tpdo.inhibit_time_100us = static_cast<std::uint16_t>(number(parameters_, 3));
    tpdo.event_timer_ms = static_cast<std::uint16_t>(number(parameters_, 5));
    if (broken && !may_be_used()) return {};
    if (report_faults() || !read_entries(static_cast<std::uint8_t>(count), tpdo)) return {};
    return is_valid_mapping(tpdo.entries) ? std::optional(std::move(tpdo)) : std::nullopt;
  }

 private:
  [[nodiscard]] std::int64_t number(std::uint16_t index, std::uint8_t subindex) const {
    return device_->objects.integer({index, subindex}).value_or(0);
  }

  // Calls `visit` with each fault of the two objects until it returns true. Skips mapping entries after the last one in
  // use.
  template <class Visit>
  bool any_fault(const Visit& visit) const {
    const bool counted = !device_->faults.contains({mapping_, 0});
    for (const std::uint16_t index : {parameters_, mapping_}) {
      for (auto at = device_->faults.lower_bound({index, 0}); at != device_->faults.end(); ++at) {
        if (at->first.index != index) break;
        if (index == mapping_ && counted && at->first.subindex > number(mapping_, 0)) continue;
        if (visit(at->first, at->second)) return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool is_broken() const {
    return any_fault([](ObjectAddress, const Diagnostic&) { return true; });
  }

  // Returns true if the mapping has an object that a stream uses, or if the mapping itself is faulty.
  [[nodiscard]] bool may_be_used() const {
    const bool unreadable =
        any_fault([this](ObjectAddress address, const Diagnostic&) { return address.index == mapping_; });
    if (unreadable) return true;
    const auto count = std::min(number(mapping_, 0), static_cast<std::int64_t>(kMaxPdoEntries));
    for (std::int64_t k = 1; k <= count; ++k) {
      const auto word = static_cast<std::uint32_t>(number(mapping_, static_cast<std::uint8_t>(k)));
      if (std::ranges::find(kUsedIndices, entry_of_mapping_word(word).index) != kUsedIndices.end()) return true;
    }
    return false;
  }

  bool report_faults() {
    bool found = false;
    any_fault([&](ObjectAddress address, const Diagnostic& fault) {
      diagnostics_->error(fault.place, fmt::format("the stream uses {}: {}", text(address), fault.message),
                          fault.remedy + "; or write the mapping into the cell file as [[stream.node.tpdo]]");
      found = true;
      return false;
    });
    return found;
  }

  // A gap would shift the values after it. Many EDS files count entries that are 0 at the end of the mapping.
  bool read_entries(std::uint8_t count, TpdoConfig& tpdo) {
    std::optional<int> gap;
    for (int k = 1; k <= count; ++k) {
      const auto word = static_cast<std::uint32_t>(number(mapping_, static_cast<std::uint8_t>(k)));
      if (word == 0) {
        if (!gap) gap = k;
        continue;
      }
      if (gap) {
        diagnostics_->error({file_, 0, 0},
                            fmt::format("the mapping of TPDO{} has a gap: {} is 0 or missing, {} is not", tpdo.number,
                                        text(ObjectAddress{mapping_, static_cast<std::uint8_t>(*gap)}),
                                        text(ObjectAddress{mapping_, static_cast<std::uint8_t>(k)})),
                            "write the mapping into the cell file as [[stream.node.tpdo]]");
        return false;
      }
      tpdo.entries.push_back(entry_of_mapping_word(word));
    }
    return true;
  }

  // Statusword, mode display, position, velocity and torque actual value.
  static constexpr std::array<std::uint16_t, 5> kUsedIndices = {0x6041, 0x6061, 0x6064, 0x606C, 0x6077};

  const DeviceDescription* device_;
  std::uint8_t node_id_;
  std::string file_;
  Diagnostics* diagnostics_;
  std::uint16_t parameters_ = 0;
  std::uint16_t mapping_ = 0;
};

// The node that owns this PDO identifier in the predefined connection set (CiA 301); nothing for other identifiers.
std::optional<std::uint8_t> predefined_owner(std::uint32_t cob_id) {
  const auto node = static_cast<std::uint8_t>(cob_id & 0x7FU);
  const bool is_pdo = cob_id > 0x180 && cob_id < 0x580;
  return is_pdo && node != 0 ? std::optional(node) : std::nullopt;
}

}  // namespace

std::vector<TpdoConfig> tpdos_of(const DeviceDescription& device, std::uint8_t node_id, const std::string& file,
                                 Diagnostics& diagnostics) {
  TpdoReader reader(device, node_id, file, diagnostics);
  std::vector<TpdoConfig> tpdos;
  // TpdoConfig counts to 255; no device of the field comes near it.
  for (std::uint16_t i = 0; i < 255; ++i) {
    if (auto tpdo = reader.read(i)) tpdos.push_back(std::move(*tpdo));
  }
  return tpdos;
}

void warn_of_foreign_node(const DeviceDescription& device, std::span<const TpdoConfig> tpdos, std::uint8_t node_id,
                          const std::string& file, Diagnostics& diagnostics) {
  if (device.commissioned_node && *device.commissioned_node != node_id) {
    diagnostics.warning(
        device.commissioned_place,
        fmt::format("the file was written for node {}, and is used for node {}", *device.commissioned_node, node_id),
        "use the DCF of this node, or the EDS of the device");
  }
  for (const TpdoConfig& tpdo : tpdos) {
    const auto owner = predefined_owner(tpdo.cob_id);
    if (!owner || *owner == node_id) continue;
    diagnostics.warning({file, 0, 0},
                        fmt::format("TPDO{} of node {} has the COB-ID 0x{:X}, which CiA 301 gives to node {}",
                                    tpdo.number, node_id, tpdo.cob_id, *owner),
                        "if the drive sends with another one, use the DCF of this node, or write cob_id into the cell "
                        "file as [[stream.node.tpdo]]");
  }
}

bool is_drive(const DeviceDescription& device) {
  const auto type = device.objects.integer({0x1000, 0});
  constexpr std::int64_t kDriveProfile = 402;
  return device.objects.has_index(0x6064) || (type && (*type & 0xFFFF) == kDriveProfile);
}

}  // namespace cellmirror::can
