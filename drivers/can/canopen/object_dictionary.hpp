// The objects of a CANopen device: types, access, values. Filled from an EDS/DCF or by code; served by SdoServer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cellmirror::can {

struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  auto operator<=>(const ObjectAddress&) const = default;
};

// "0x6064:00".
[[nodiscard]] std::string text(ObjectAddress address);

// CiA 301, table of data types (objects 0x0001..0x001B).
enum class DataType : std::uint16_t {
  boolean = 0x01,
  integer8 = 0x02,
  integer16 = 0x03,
  integer32 = 0x04,
  unsigned8 = 0x05,
  unsigned16 = 0x06,
  unsigned32 = 0x07,
  real32 = 0x08,
  visible_string = 0x09,
  octet_string = 0x0A,
  unicode_string = 0x0B,
  time_of_day = 0x0C,
  time_difference = 0x0D,
  domain = 0x0F,
  integer24 = 0x10,
  real64 = 0x11,
  integer40 = 0x12,
  integer48 = 0x13,
  integer56 = 0x14,
  integer64 = 0x15,
  unsigned24 = 0x16,
  unsigned40 = 0x18,
  unsigned48 = 0x19,
  unsigned56 = 0x1A,
  unsigned64 = 0x1B,
};

// Bytes of a value of the type; 0 where the length varies (strings, domain) or the type is unknown.
[[nodiscard]] std::size_t size_of(DataType type);
[[nodiscard]] bool is_integer_type(DataType type);  // boolean included
[[nodiscard]] bool is_signed_type(DataType type);

// As the device allows it by SDO and PDO.
enum class ObjectAccess : std::uint8_t { constant, read_only, write_only, read_write };

struct ObjectEntry {
  std::string name;
  DataType type = DataType::unsigned32;
  ObjectAccess access = ObjectAccess::read_write;
  bool pdo_mappable = false;
  std::vector<std::uint8_t> value;  // little-endian; as long as the type where that has a size
  std::optional<std::int64_t> low_limit;
  std::optional<std::int64_t> high_limit;
};

class ObjectDictionary {
 public:
  static constexpr std::size_t kMaxEntries = 100'000;

  // Replaces what was there. False where the dictionary is full.
  bool set(ObjectAddress address, ObjectEntry entry);
  // An integer of the type; `value` is cut to it.
  bool set_integer(ObjectAddress address, DataType type, ObjectAccess access, std::int64_t value, std::string name = {},
                   bool pdo_mappable = false);

  [[nodiscard]] const ObjectEntry* find(ObjectAddress address) const;
  [[nodiscard]] ObjectEntry* find(ObjectAddress address);
  [[nodiscard]] bool has_index(std::uint16_t index) const;
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] const std::map<ObjectAddress, ObjectEntry>& entries() const { return entries_; }

  // The value of an integer object by its type's sign; none where it does not exist, is no integer or has no value.
  [[nodiscard]] std::optional<std::int64_t> integer(ObjectAddress address) const;
  // Writes the value of an existing integer object, cut to its type, whatever its access. False where there is none.
  bool write_integer(ObjectAddress address, std::int64_t value);

 private:
  std::map<ObjectAddress, ObjectEntry> entries_;
};

}  // namespace cellmirror::can
