#include "scripts/lang/command_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

// Built once; then read only.
class Table {
 public:
  Table() {
    for (const auto section : {general_forms(), device_forms(), robot_parameter_forms(), animation_forms(),
                               dynamics_forms(), elastodynamic_forms(), channel_forms(), volume_forms(), own_forms()}) {
      for (const Form& form : section) add(form);
    }
    for (const Form* form : forms_) CELLMIRROR_EXPECTS(form != nullptr);
    collect_commands();
  }

  [[nodiscard]] std::span<const Form* const> forms() const { return forms_; }
  [[nodiscard]] std::span<const std::string> names() const { return names_; }

  [[nodiscard]] std::span<const Form* const> find(std::string_view command) const {
    for (std::size_t bucket = hash(command);; ++bucket) {
      const std::uint8_t index = buckets_[bucket % kBuckets];
      if (index == 0) return {};
      if (equal_ignoring_case(names_[index - 1], command)) return by_command_[index - 1];
    }
  }

 private:
  static constexpr std::size_t kBuckets = 512;  // a power of two, several times the number of commands

  // FNV-1a over letters without their case bit; other characters may collide, which the comparison sorts out.
  static std::size_t hash(std::string_view word) {
    std::uint32_t value = 2166136261U;
    for (const char c : word) value = (value ^ (static_cast<unsigned char>(c) | 0x20U)) * 16777619U;
    return (value ^ (value >> 16U)) % kBuckets;
  }

  void add(const Form& form) {
    const Form*& place = forms_[static_cast<std::size_t>(form.id)];
    CELLMIRROR_EXPECTS(place == nullptr);
    place = &form;
  }

  void collect_commands() {
    for (const Form* form : forms_) {
      if (form->kind != FormKind::command) continue;
      const auto known = std::find(names_.begin(), names_.end(), form->name);
      if (known != names_.end()) {
        by_command_[static_cast<std::size_t>(known - names_.begin())].push_back(form);
        continue;
      }
      names_.emplace_back(form->name);
      by_command_.push_back({form});
      std::size_t bucket = hash(form->name);
      while (buckets_[bucket % kBuckets] != 0) ++bucket;
      CELLMIRROR_EXPECTS(names_.size() < 256);
      buckets_[bucket % kBuckets] = static_cast<std::uint8_t>(names_.size());
    }
  }

  std::array<const Form*, kFormCount> forms_{};
  std::vector<std::string> names_;
  std::vector<std::vector<const Form*>> by_command_;
  std::array<std::uint8_t, kBuckets> buckets_{};  // 0: empty, else index + 1 into names_
};

const Table& table() {
  static const Table the_table;
  return the_table;
}

}  // namespace

std::span<const Form* const> forms() { return table().forms(); }

const Form& form(FormId id) { return *table().forms()[static_cast<std::size_t>(id)]; }

std::span<const Form* const> forms_of(std::string_view command) { return table().find(command); }

std::span<const std::string> command_names() { return table().names(); }

std::string_view unit_text(Unit unit) {
  switch (unit) {
    case Unit::none:
      return "";
    case Unit::mm:
      return "mm";
    case Unit::degree:
      return "degrees";
    case Unit::metre:
      return "m";
    case Unit::second:
      return "s";
    case Unit::newton:
      return "N";
    case Unit::newton_metre:
      return "Nm";
    case Unit::mm_per_s:
      return "mm/s";
    case Unit::mm_per_s2:
      return "mm/s2";
    case Unit::degree_per_s:
      return "degrees/s";
    case Unit::degree_per_s2:
      return "degrees/s2";
    case Unit::byte:
      return "bytes";
    case Unit::joint_position:
    case Unit::by_effector_joint:
      return "mm or degrees, by the kind of joint";
    case Unit::joint_velocity:
      return "mm/s or rad/s, by the kind of joint";
    case Unit::joint_acceleration:
      return "mm/s2 or rad/s2, by the kind of joint";
    case Unit::by_fly_type:
      return "fraction 0..1, mm or degrees, by the fly type";
    case Unit::by_plausibility:
      return "by the token";
  }
  return "";
}

}  // namespace cellmirror::script
