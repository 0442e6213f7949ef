// Reads one TOML table by its keys, and finds everything that is wrong with it: wrong types, ranges, unknown keys (with
// the nearest known one, and with the SI value for keys in mm or degrees), missing keys. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/toml.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"

namespace cellmirror {

struct Range {
  double min = -1e9;
  double max = 1e9;
  bool min_excluded = false;
  bool max_excluded = false;
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0.0, 1e9, true};
inline constexpr Range kNotNegative{0.0, 1e9, false};

class TableReader {
 public:
  // `where` names the table for messages, e.g. "[loop]" or "node J_1".
  TableReader(const toml::table& table, const std::string& file, std::string where, Diagnostics& diagnostics)
      : table_(&table), file_(&file), where_(std::move(where)), diagnostics_(&diagnostics) {}

  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
  // An error where the key is missing.
  void require(std::string_view key);
  void set_where(std::string where) { where_ = std::move(where); }
  [[nodiscard]] const std::string& where() const { return where_; }

  // Each gives nothing where the key is missing or its value is refused (with an error).
  std::optional<double> number(std::string_view key, Range range = kAnyNumber);
  std::optional<long long> integer(std::string_view key, long long min, long long max);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  // A name of a node, robot, ...: 1 to 63 printable characters without blanks, dots, quotes, ';' and '#'.
  std::optional<std::string> name(std::string_view key);
  std::optional<Eigen::Vector3d> vector3(std::string_view key, Range each = kAnyNumber);
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, Range each = kAnyNumber);
  // [[x, y, z], ...]
  std::optional<std::vector<Eigen::Vector3d>> points(std::string_view key, std::size_t least, std::size_t most,
                                                     Range each = kAnyNumber);
  std::optional<std::vector<std::string>> texts(std::string_view key);
  // One of the words.
  template <class Value>
  std::optional<Value> choice(std::string_view key, std::initializer_list<std::pair<std::string_view, Value>> words) {
    const auto word = text(key);
    if (!word) return std::nullopt;
    std::vector<std::string> known;
    for (const auto& [name, value] : words) {
      if (name == *word) return value;
      known.emplace_back(name);
    }
    refuse_word(key, *word, known);
    return std::nullopt;
  }
  // xyz_m and rpy_rad.
  Pose pose();
  std::optional<TableReader> table(std::string_view key);
  // An array of tables: [[key]] or key = [{...}, ...].
  std::vector<TableReader> tables(std::string_view key, std::size_t most);

  // Keys that belong into another table, which is named as it is written: what finish() says of them where they are
  // found in this one.
  void belongs_to(std::string table, std::vector<std::string> keys);
  // Every key that was asked for until now.
  [[nodiscard]] const std::vector<std::string>& known() const { return known_; }

  // The key format: 1 is the only one yet.
  void format();
  // Unread keys are errors. Call it last.
  void finish();

  // The place of a key's value, or of the table where the key is missing.
  [[nodiscard]] Place place(std::string_view key = {}) const;
  void error(std::string_view key, std::string message, std::string remedy = {}) const;
  void warning(std::string_view key, std::string message, std::string remedy = {}) const;
  [[nodiscard]] Diagnostics& diagnostics() const { return *diagnostics_; }
  [[nodiscard]] const std::string& file() const { return *file_; }

 private:
  const toml::node* get(std::string_view key);
  void refuse_type(std::string_view key, const toml::node& node, const char* wanted) const;
  void refuse_word(std::string_view key, const std::string& word, const std::vector<std::string>& known) const;
  // "it belongs under [[stream.node]]"; empty where no other table is known to have the key.
  [[nodiscard]] std::string place_remedy(std::string_view key) const;
  [[nodiscard]] std::string unit_remedy(std::string_view key, const toml::node& node) const;
  [[nodiscard]] bool in_range(std::string_view key, double value, Range range) const;
  std::optional<double> element(std::string_view key, const toml::node& node, Range range) const;

  const toml::table* table_;
  const std::string* file_;
  std::string where_;
  Diagnostics* diagnostics_;
  std::vector<std::string> known_;
  std::vector<std::pair<std::string, std::vector<std::string>>> elsewhere_;  // table, its keys
};

// The keys that `read` asks a table like this one for.
template <class Read>
std::vector<std::string> keys_read_by(Read read, const toml::table& like = {}) {
  const std::string file;
  Diagnostics ignored;
  TableReader reader(like, file, "", ignored);
  read(reader);
  return reader.known();
}

// The table of a TOML text; nothing, with the place of the error, if it is invalid.
[[nodiscard]] std::optional<toml::table> parse_toml(std::string_view text, const std::string& file,
                                                    Diagnostics& diagnostics);

}  // namespace cellmirror
