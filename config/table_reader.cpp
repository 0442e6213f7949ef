#include "config/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror {

namespace {

const char* word(toml::node_type type) {
  switch (type) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      return "a date or time";
    case toml::node_type::none:
      break;
  }
  return "nothing";
}

Place place_of(const std::string& file, const toml::source_region& region) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

// A common unit of data sheets, and ours.
struct Unit {
  std::string_view theirs;
  std::string_view ours;
  double factor;
};
constexpr std::array<Unit, 10> kUnits{{{"_deg_s2", "_rad_s2", kRadPerDeg},
                                       {"_deg_s", "_rad_s", kRadPerDeg},
                                       {"_deg", "_rad", kRadPerDeg},
                                       {"_mm_s2", "_m_s2", kMPerMm},
                                       {"_mm_s", "_m_s", kMPerMm},
                                       {"_mm", "_m", kMPerMm},
                                       {"_ms", "_s", 1e-3},
                                       {"_khz", "_hz", 1e3},
                                       {"_kpa", "_pa", 1e3},
                                       {"_g_cm3", "_kg_m3", 1e3}}};

}  // namespace

const toml::node* TableReader::get(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

Place TableReader::place(std::string_view key) const {
  const toml::node* node = key.empty() ? nullptr : table_->get(key);
  return place_of(*file_, node != nullptr ? node->source() : table_->source());
}

void TableReader::error(std::string_view key, std::string message, std::string remedy) const {
  diagnostics_->error(place(key), where_.empty() ? std::move(message) : where_ + ": " + message, std::move(remedy));
}

void TableReader::warning(std::string_view key, std::string message, std::string remedy) const {
  diagnostics_->warning(place(key), where_.empty() ? std::move(message) : where_ + ": " + message, std::move(remedy));
}

void TableReader::require(std::string_view key) {
  if (!has(key)) error({}, fmt::format("the key {} is missing", key));
}

void TableReader::refuse_type(std::string_view key, const toml::node& node, const char* wanted) const {
  error(key, fmt::format("{} must be {}, but is {}", key, wanted, word(node.type())));
}

void TableReader::refuse_word(std::string_view key, const std::string& word,
                              const std::vector<std::string>& known) const {
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  const std::string near = did_you_mean(word, known);
  error(key, fmt::format("{} cannot be \"{}\"", key, printable(word)), near.empty() ? "it is one of " + all : near);
}

bool TableReader::in_range(std::string_view key, double value, Range range) const {
  if (!std::isfinite(value)) {
    error(key, fmt::format("{} is not a finite number", key));
    return false;
  }
  const bool below = range.min_excluded ? value <= range.min : value < range.min;
  const bool above = range.max_excluded ? value >= range.max : value > range.max;
  if (!below && !above) return true;
  const std::string upper =
      range.max < 1e9 ? fmt::format(" and {} {:g}", range.max_excluded ? "below" : "at most", range.max) : "";
  error(key, fmt::format("{} is {:g}, but must be {} {:g}{}", key, value, range.min_excluded ? "above" : "at least",
                         range.min, upper));
  return false;
}

std::optional<double> TableReader::element(std::string_view key, const toml::node& node, Range range) const {
  std::optional<double> value;
  if (const auto* floating = node.as_floating_point()) value = floating->get();
  if (const auto* integer = node.as_integer()) value = static_cast<double>(integer->get());
  if (!value) {
    refuse_type(key, node, "a number");
    return std::nullopt;
  }
  return in_range(key, *value, range) ? value : std::nullopt;
}

std::optional<double> TableReader::number(std::string_view key, Range range) {
  const toml::node* node = get(key);
  return node == nullptr ? std::nullopt : element(key, *node, range);
}

std::optional<long long> TableReader::integer(std::string_view key, long long min, long long max) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_integer();
  if (value == nullptr) {
    refuse_type(key, *node, "an integer");
    return std::nullopt;
  }
  if (value->get() < min || value->get() > max) {
    error(key, fmt::format("{} is {}, but must be between {} and {}", key, value->get(), min, max));
    return std::nullopt;
  }
  return value->get();
}

std::optional<bool> TableReader::boolean(std::string_view key) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_boolean();
  if (value == nullptr) {
    refuse_type(key, *node, "true or false");
    return std::nullopt;
  }
  return value->get();
}

std::optional<std::string> TableReader::text(std::string_view key) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_string();
  if (value == nullptr) {
    refuse_type(key, *node, "a text");
    return std::nullopt;
  }
  constexpr std::size_t kLongest = 4096;
  if (value->get().size() > kLongest || value->get().find('\0') != std::string::npos) {
    error(key, fmt::format("{} is longer than {} bytes or contains a NUL", key, kLongest));
    return std::nullopt;
  }
  return value->get();
}

std::optional<std::string> TableReader::name(std::string_view key) {
  const auto value = text(key);
  if (!value) return std::nullopt;
  const bool plain = std::ranges::all_of(
      *value, [](char c) { return c > ' ' && c < 0x7F && c != '.' && c != ';' && c != '#' && c != '"' && c != '\''; });
  if (!value->empty() && value->size() <= kMaxNameLength && plain) return value;
  error(key, fmt::format("{} \"{}\" is not a valid name", key, printable(*value)),
        fmt::format("a name has 1 to {} characters, without blanks, dots, quotes, ; and #", kMaxNameLength));
  return std::nullopt;
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, std::size_t count, Range each) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) {
    const std::string is = array == nullptr ? word(node->type()) : fmt::format("an array of {}", array->size());
    error(key, fmt::format("{} must be an array of {} numbers, but is {}", key, count, is));
    return std::nullopt;
  }
  std::vector<double> values;
  for (const toml::node& item : *array) {
    const auto value = element(key, item, each);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

std::optional<Eigen::Vector3d> TableReader::vector3(std::string_view key, Range each) {
  const auto values = numbers(key, 3, each);
  if (!values) return std::nullopt;
  return Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<std::vector<Eigen::Vector3d>> TableReader::points(std::string_view key, std::size_t least,
                                                                std::size_t most, Range each) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() < least || array->size() > most) {
    const std::string is = array == nullptr ? word(node->type()) : fmt::format("an array of {}", array->size());
    error(key, fmt::format("{} must be an array of {} to {} points, but is {}", key, least, most, is),
          "write [[x, y, z], [x, y, z]]");
    return std::nullopt;
  }
  std::vector<Eigen::Vector3d> points;
  for (const toml::node& item : *array) {
    const toml::array* row = item.as_array();
    if (row == nullptr || row->size() != 3) {
      error(key, fmt::format("point {} of {} is not [x, y, z]", points.size() + 1, key));
      return std::nullopt;
    }
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const auto value = element(key, *row->get(static_cast<std::size_t>(k)), each);
      if (!value) return std::nullopt;
      p[k] = *value;
    }
    points.push_back(p);
  }
  return points;
}

std::optional<std::vector<std::string>> TableReader::texts(std::string_view key) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  constexpr std::size_t kMost = 10'000;
  if (array == nullptr || array->size() > kMost) {
    refuse_type(key, *node, "an array of texts");
    return std::nullopt;
  }
  std::vector<std::string> values;
  for (const toml::node& item : *array) {
    const auto* value = item.as_string();
    if (value == nullptr) {
      refuse_type(key, item, "an array of texts");
      return std::nullopt;
    }
    values.push_back(value->get());
  }
  return values;
}

Pose TableReader::pose() {
  const Eigen::Vector3d xyz = vector3("xyz_m").value_or(Eigen::Vector3d::Zero());
  const Eigen::Vector3d rpy = vector3("rpy_rad").value_or(Eigen::Vector3d::Zero());
  return pose_from_xyz_rpy(xyz, rpy);
}

std::optional<TableReader> TableReader::table(std::string_view key) {
  const toml::node* node = get(key);
  if (node == nullptr) return std::nullopt;
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    refuse_type(key, *node, "a table");
    return std::nullopt;
  }
  return TableReader(*table, *file_, where_.empty() ? fmt::format("[{}]", key) : fmt::format("{}, {}", where_, key),
                     *diagnostics_);
}

std::vector<TableReader> TableReader::tables(std::string_view key, std::size_t most) {
  const toml::node* node = get(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    error(key, fmt::format("{} must be an array of tables, but is {}", key, word(node->type())),
          fmt::format("write [[{}]]", key));
    return {};
  }
  if (array->size() > most) {
    error(key, fmt::format("there are {} tables {}, more than {}", array->size(), key, most));
    return {};
  }
  std::vector<TableReader> readers;
  std::size_t number = 0;
  for (const toml::node& item : *array) {
    ++number;
    const toml::table* table = item.as_table();
    if (table == nullptr) {
      diagnostics_->error(place_of(*file_, item.source()),
                          fmt::format("element {} of {} must be a table, but is {}", number, key, word(item.type())));
      continue;
    }
    readers.emplace_back(
        *table, *file_,
        where_.empty() ? fmt::format("{} {}", key, number) : fmt::format("{}, {} {}", where_, key, number),
        *diagnostics_);
  }
  return readers;
}

std::string TableReader::unit_remedy(std::string_view key, const toml::node& node) const {
  for (const Unit& unit : kUnits) {
    if (!key.ends_with(unit.theirs)) continue;
    const std::string ours = std::string(key.substr(0, key.size() - unit.theirs.size())) + std::string(unit.ours);
    if (std::ranges::find(known_, ours) == known_.end()) continue;
    const auto converted = [&](const toml::node& item) -> std::string {
      if (const auto value = item.value<double>()) return fmt::format("{:.9g}", *value * unit.factor);
      return "...";
    };
    std::string value;
    if (const toml::array* array = node.as_array()) {
      for (const toml::node& item : *array) {
        value += (value.empty() ? "[" : ", ") + converted(item);
        if (value.size() > 100) break;
      }
      value += "]";
    } else {
      value = converted(node);
    }
    return fmt::format("files are in SI: write {} = {}", ours, value);
  }
  return {};
}

void TableReader::belongs_to(std::string table, std::vector<std::string> keys) {
  elsewhere_.emplace_back(std::move(table), std::move(keys));
}

std::string TableReader::place_remedy(std::string_view key) const {
  std::string tables;
  for (const auto& [table, keys] : elsewhere_) {
    if (std::ranges::find(keys, key) != keys.end() && tables.find(table) == std::string::npos)
      tables += (tables.empty() ? "" : " or ") + table;
  }
  return tables.empty() ? tables : "it belongs under " + tables;
}

void TableReader::format() {
  require("format");
  const auto version = integer("format", 0, std::numeric_limits<int>::max());
  if (version && *version != 1)
    error("format", fmt::format("format {} is unknown", *version), "this version reads format = 1");
}

void TableReader::finish() {
  std::vector<std::pair<Place, std::string_view>> unknown;
  for (const auto& [key, value] : *table_) {
    if (std::ranges::find(known_, key.str()) != known_.end()) continue;
    const std::string shown = printable(key.str());
    std::string remedy = place_remedy(key.str());
    const char* what = remedy.empty() ? "is unknown" : "does not belong here";
    if (remedy.empty()) remedy = unit_remedy(key.str(), value);
    if (remedy.empty()) {
      std::vector<std::string> known = known_;
      std::ranges::sort(known);
      known.erase(std::unique(known.begin(), known.end()), known.end());
      remedy = did_you_mean(shown, known);
      if (remedy.empty()) {
        for (const std::string& name : known) remedy += (remedy.empty() ? "the keys here are " : ", ") + name;
      }
    }
    diagnostics_->error(place_of(*file_, key.source()),
                        where_.empty() ? fmt::format("the key {} {}", shown, what)
                                       : fmt::format("{}: the key {} {}", where_, shown, what),
                        std::move(remedy));
  }
}

}  // namespace cellmirror
