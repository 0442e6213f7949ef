// A place where a deformable surface touches something, or will within a step: what the search finds and the solver
// takes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "rt_core/tissue/contact/surface_point.hpp"

namespace cellmirror::tissue {

// m/s: no surface is pushed faster, whatever touches it.
inline constexpr double kFastestPush = 2.0;

// The same from step to step for the same parts, so that a solution starts from the last one.
struct ContactKey {
  enum class Other : std::uint8_t { instrument, rigid, tissue };
  Other other{};
  std::uint32_t id = 0;  // instrument: 4 * place + capsule; rigid: id of the body; tissue: object
  std::uint32_t object = 0;
  std::uint32_t feature = 0;  // triangle (instruments) or surface point of the object
  auto operator<=>(const ContactKey&) const = default;
};

struct Contact {
  ContactKey key;
  SurfacePoint point;
  SurfacePoint other;   // of kind tissue
  int instrument = -1;  // place in the list of instruments
  // Unit vector: where it pushes the point.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  // On the other surface at the step's start, m; gap = normal . (point - anchor). Unused against tissue.
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, of the anchor
  double gap = 0;                                      // m, at the step's start; negative: overlap
  double friction = 0;
  // N s: what the solver starts with; then what it found, all substeps together.
  double impulse = 0;
  Eigen::Vector3d tangential = Eigen::Vector3d::Zero();
};

// Contacts of the last step, to start from.
class ContactMemory {
 public:
  void clear() { contacts_.clear(); }
  // Copies; the order of contacts does not matter.
  void remember(const std::vector<Contact>& contacts) {
    contacts_.assign(contacts.begin(), contacts.end());
    std::ranges::sort(contacts_, {}, &Contact::key);
  }
  [[nodiscard]] const Contact* find(const ContactKey& key) const {
    const auto at = std::ranges::lower_bound(contacts_, key, {}, &Contact::key);
    return at != contacts_.end() && at->key == key ? &*at : nullptr;
  }

 private:
  std::vector<Contact> contacts_;
};

}  // namespace cellmirror::tissue
