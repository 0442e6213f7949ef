#include "drivers/can/canopen/object_dictionary.hpp"

#include <fmt/format.h>

#include <utility>

#include "drivers/can/canopen/bytes.hpp"

namespace cellmirror::can {

std::string text(ObjectAddress address) { return fmt::format("0x{:04X}:{:02X}", address.index, address.subindex); }

std::size_t size_of(DataType type) {
  switch (type) {
    case DataType::boolean:
    case DataType::integer8:
    case DataType::unsigned8:
      return 1;
    case DataType::integer16:
    case DataType::unsigned16:
      return 2;
    case DataType::integer24:
    case DataType::unsigned24:
      return 3;
    case DataType::integer32:
    case DataType::unsigned32:
    case DataType::real32:
      return 4;
    case DataType::integer40:
    case DataType::unsigned40:
      return 5;
    case DataType::integer48:
    case DataType::unsigned48:
    case DataType::time_of_day:
    case DataType::time_difference:
      return 6;
    case DataType::integer56:
    case DataType::unsigned56:
      return 7;
    case DataType::integer64:
    case DataType::unsigned64:
    case DataType::real64:
      return 8;
    case DataType::visible_string:
    case DataType::octet_string:
    case DataType::unicode_string:
    case DataType::domain:
      return 0;
  }
  return 0;
}

bool is_signed_type(DataType type) {
  switch (type) {
    case DataType::integer8:
    case DataType::integer16:
    case DataType::integer24:
    case DataType::integer32:
    case DataType::integer40:
    case DataType::integer48:
    case DataType::integer56:
    case DataType::integer64:
      return true;
    default:
      return false;
  }
}

bool is_integer_type(DataType type) {
  switch (type) {
    case DataType::real32:
    case DataType::real64:
    case DataType::time_of_day:
    case DataType::time_difference:
      return false;
    default:
      return size_of(type) > 0;
  }
}

bool ObjectDictionary::set(ObjectAddress address, ObjectEntry entry) {
  if (entries_.size() >= kMaxEntries && !entries_.contains(address)) return false;
  entries_[address] = std::move(entry);
  return true;
}

bool ObjectDictionary::set_integer(ObjectAddress address, DataType type, ObjectAccess access, std::int64_t value,
                                   std::string name, bool pdo_mappable) {
  CELLMIRROR_EXPECTS(is_integer_type(type));
  ObjectEntry entry;
  entry.name = std::move(name);
  entry.type = type;
  entry.access = access;
  entry.pdo_mappable = pdo_mappable;
  entry.value.resize(size_of(type));
  put_le(entry.value, static_cast<std::uint64_t>(value), entry.value.size());
  return set(address, std::move(entry));
}

const ObjectEntry* ObjectDictionary::find(ObjectAddress address) const {
  const auto found = entries_.find(address);
  return found == entries_.end() ? nullptr : &found->second;
}

ObjectEntry* ObjectDictionary::find(ObjectAddress address) {
  const auto found = entries_.find(address);
  return found == entries_.end() ? nullptr : &found->second;
}

bool ObjectDictionary::has_index(std::uint16_t index) const {
  const auto found = entries_.lower_bound({index, 0});
  return found != entries_.end() && found->first.index == index;
}

std::optional<std::int64_t> ObjectDictionary::integer(ObjectAddress address) const {
  const ObjectEntry* entry = find(address);
  if (entry == nullptr || !is_integer_type(entry->type) || entry->value.size() != size_of(entry->type)) return {};
  const std::uint64_t raw = get_le(entry->value, entry->value.size());
  return is_signed_type(entry->type) ? sign_extended(raw, 8 * entry->value.size()) : static_cast<std::int64_t>(raw);
}

bool ObjectDictionary::write_integer(ObjectAddress address, std::int64_t value) {
  ObjectEntry* entry = find(address);
  if (entry == nullptr || !is_integer_type(entry->type)) return false;
  entry->value.resize(size_of(entry->type));
  put_le(entry->value, static_cast<std::uint64_t>(value), entry->value.size());
  return true;
}

}  // namespace cellmirror::can
