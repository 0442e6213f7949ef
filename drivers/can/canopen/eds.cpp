#include "drivers/can/canopen/eds.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// A number and whether it was written with a minus.
struct Number {
  std::uint64_t magnitude = 0;
  bool negative = false;
};

// Hexadecimal with 0x, octal with 0, else decimal (CiA 306, 4.1).
std::optional<Number> parse_ini_number(std::string_view text) {
  Number number;
  text = trimmed(text);
  if (text.starts_with('-')) {
    number.negative = true;
    text.remove_prefix(1);
  }
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    base = 16;
    text.remove_prefix(2);
  } else if (text.size() > 1 && text.front() == '0') {
    base = 8;
    text.remove_prefix(1);
  }
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number.magnitude, base);
  if (text.empty() || problem != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

// A number, $NODEID, or the sum of two of them in any order.
std::optional<Number> parse_expression(std::string_view text, std::uint8_t node_id) {
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
    if (value.negative) return {};
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
  void error(const IniValue& at, std::string message) {
    diagnostics_->error({file_, at.line, at.column}, std::move(message));
  }

  // "1000", "1018sub1"; others are no objects of their own.
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
    if (kind == kArray || kind == kRecord) return;  // its values stand in its subindices
    add_object(address, section);
  }

  std::optional<std::uint64_t> number_of(const IniSection& section, std::string_view key) {
    const IniValue* value = section.find(key);
    if (value == nullptr || value->text.empty()) return {};
    const auto number = parse_ini_number(value->text);
    if (!number || number->negative) {
      error(*value, fmt::format("'{}' is no number", printable(value->text)));
      return {};
    }
    return number->magnitude;
  }

  std::optional<ObjectEntry> entry_of(const IniSection& section) {
    ObjectEntry entry;
    if (const IniValue* name = section.find("parametername")) entry.name = name->text.substr(0, kMaxText);
    const auto type = number_of(section, "datatype");
    if (!type) {
      if (section.find("datatype") == nullptr) {
        diagnostics_->warning({file_, section.line, 0},
                              fmt::format("[{}] has no DataType: left out", printable(section.name)));
      }
      return {};
    }
    entry.type = static_cast<DataType>(*type);
    const bool known = *type <= 0x1B && (size_of(entry.type) > 0 || entry.type == DataType::visible_string ||
                                         entry.type == DataType::octet_string ||
                                         entry.type == DataType::unicode_string || entry.type == DataType::domain);
    if (!known) {
      diagnostics_->warning({file_, section.line, 0}, fmt::format("[{}] has the unknown DataType 0x{:X}: left out",
                                                                  printable(section.name), *type));
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
    const std::string text = lower_case(access->text);
    if (text == "ro") return ObjectAccess::read_only;
    if (text == "wo") return ObjectAccess::write_only;
    if (text == "const") return ObjectAccess::constant;
    if (text != "rw" && text != "rwr" && text != "rww") {
      error(*access, fmt::format("'{}' is no AccessType; ro, wo, rw, rwr, rww, const are", printable(access->text)));
    }
    return ObjectAccess::read_write;
  }

  std::optional<std::int64_t> limit_of(const IniSection& section, std::string_view key, DataType type) {
    const IniValue* value = section.find(key);
    if (value == nullptr || value->text.empty() || !is_integer_type(type)) return {};
    const auto number = parse_expression(value->text, node_id_);
    const auto raw = number ? fit(*number, type) : std::nullopt;
    if (!raw) {
      diagnostics_->warning({file_, value->line, value->column},
                            fmt::format("'{}' is no limit of this type: ignored", printable(value->text)));
      return {};
    }
    if (is_signed_type(type)) return sign_extended(*raw, 8 * size_of(type));
    if (*raw > static_cast<std::uint64_t>(INT64_MAX)) return {};
    return static_cast<std::int64_t>(*raw);
  }

  void set_value(ObjectEntry& entry, const IniValue* value) {
    entry.value.assign(size_of(entry.type), 0);
    if (value == nullptr || value->text.empty()) return;
    if (is_integer_type(entry.type)) {
      const auto number = parse_expression(value->text, node_id_);
      const auto raw = number ? fit(*number, entry.type) : std::nullopt;
      if (!raw) {
        error(*value, fmt::format("'{}' is no value of {} bytes", printable(value->text), entry.value.size()));
        return;
      }
      put_le(entry.value, *raw, entry.value.size());
    } else if (entry.type == DataType::real32 || entry.type == DataType::real64) {
      set_real(entry, *value);
    } else if (entry.type == DataType::visible_string) {
      entry.value.assign(value->text.begin(), value->text.end());
    }
  }

  void set_real(ObjectEntry& entry, const IniValue& value) {
    const bool single = entry.type == DataType::real32;
    if (const auto number = parse_number(value.text)) {
      const std::uint64_t raw =
          single ? std::bit_cast<std::uint32_t>(static_cast<float>(*number)) : std::bit_cast<std::uint64_t>(*number);
      put_le(entry.value, raw, entry.value.size());
    } else if (const auto bits = parse_ini_number(value.text); bits && !bits->negative) {
      put_le(entry.value, bits->magnitude, entry.value.size());  // the bits of the number, as some tools write
    } else {
      error(value, fmt::format("'{}' is no real number", printable(value.text)));
    }
  }

  void add_object(ObjectAddress address, const IniSection& section) {
    auto entry = entry_of(section);
    if (!entry) return;
    const IniValue* value = section.find("parametervalue");
    set_value(*entry, value != nullptr ? value : section.find("defaultvalue"));
    store(address, std::move(*entry));
  }

  // CompactSubObj=n: n subindices that look alike, their values in [1003Value].
  void add_compact(std::uint16_t index, const IniSection& section, std::uint64_t count) {
    if (count > 254) {
      diagnostics_->error({file_, section.line, 0},
                          fmt::format("[{}]: CompactSubObj={} is beyond 254", printable(section.name), count));
      return;
    }
    const auto common = entry_of(section);
    if (!common) return;
    const auto values = ini_.find(fmt::format("{:04x}value", index));
    ObjectEntry highest;
    highest.name = "NrOfObjects";
    highest.type = DataType::unsigned8;
    highest.access = ObjectAccess::read_only;
    highest.value = {static_cast<std::uint8_t>(count)};
    store({index, 0}, highest);
    for (std::uint64_t i = 1; i <= count; ++i) {
      ObjectEntry entry = *common;
      const IniValue* value = section.find("defaultvalue");
      if (values != ini_.end()) {
        if (const IniValue* own = values->second.find(std::to_string(i))) value = own;
      }
      set_value(entry, value);
      store({index, static_cast<std::uint8_t>(i)}, std::move(entry));
    }
  }

  void store(ObjectAddress address, ObjectEntry entry) {
    if (device_.objects.set(address, std::move(entry))) return;
    if (!full_) diagnostics_->error({file_, 0, 0}, fmt::format("more than {} objects", ObjectDictionary::kMaxEntries));
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
        error(value, fmt::format("'{}' is no index of an object", printable(value.text)));
      } else if (!ini_.contains(fmt::format("{:04x}", number->magnitude))) {
        diagnostics_->warning({file_, value.line, value.column},
                              fmt::format("the object 0x{:04X} is listed but not described", number->magnitude));
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

std::vector<TpdoConfig> tpdos_of(const ObjectDictionary& objects, std::uint8_t node_id) {
  std::vector<TpdoConfig> tpdos;
  // TpdoConfig counts to 255; no device of the field comes near it.
  for (std::uint16_t i = 0; i < 255; ++i) {
    const auto parameters = static_cast<std::uint16_t>(0x1800 + i);
    const auto mapping = static_cast<std::uint16_t>(0x1A00 + i);
    const auto count = objects.integer({mapping, 0});
    if (!count || *count < 1 || *count > static_cast<std::int64_t>(kMaxPdoEntries)) continue;
    TpdoConfig tpdo;
    tpdo.number = static_cast<std::uint8_t>(i + 1);
    auto cob_id = static_cast<std::uint32_t>(objects.integer({parameters, 1}).value_or(0));
    if ((cob_id & kCobIdInvalid) != 0) continue;
    cob_id &= ~kCobIdNoRtr;
    if (cob_id == 0 && i >= 4) continue;  // beyond the predefined ones
    tpdo.cob_id = cob_id != 0 ? cob_id : tpdo_cob_id(i + 1, node_id);
    const auto number = [&](std::uint8_t subindex) { return objects.integer({parameters, subindex}).value_or(0); };
    tpdo.transmission_type = static_cast<std::uint8_t>(objects.integer({parameters, 2}).value_or(255));
    tpdo.inhibit_time_100us = static_cast<std::uint16_t>(number(3));
    tpdo.event_timer_ms = static_cast<std::uint16_t>(number(5));
    for (int k = 1; k <= *count; ++k) {
      const auto word =
          static_cast<std::uint32_t>(objects.integer({mapping, static_cast<std::uint8_t>(k)}).value_or(0));
      if (word != 0) tpdo.entries.push_back(entry_of_mapping_word(word));
    }
    if (is_valid_mapping(tpdo.entries)) tpdos.push_back(std::move(tpdo));
  }
  return tpdos;
}

}  // namespace cellmirror::can
