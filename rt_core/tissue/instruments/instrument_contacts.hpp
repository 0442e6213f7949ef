// Contacts between an instrument's capsules and the surfaces of deformable objects.
//
// Every point of a surface must stay out of a capsule, whatever side of the object it is on: the normal points from the
// capsule's axis to the point. A triangle whose back is towards the axis counts only if it was touched in the last
// step: else it belongs to the far side of something thin, or the instrument appeared within the object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/tissue/contact/contact.hpp"
#include "rt_core/tissue/instruments/instrument.hpp"

namespace cellmirror::tissue {

inline constexpr std::size_t kMostContactsOfCapsule = 32;

class InstrumentContacts {
 public:
  // Appends the contacts of `instrument`, number `place` in the list of instruments, with all objects. Bounded work
  // near the instrument; noexcept but for memory until the largest contact was met.
  void search(const Instrument& instrument, int place, std::span<DeformableObject> objects, const ContactMemory& memory,
              std::vector<Contact>& contacts);
  // Points of surfaces that are nearer than `reach` to the axis of the effector, at least `spacing` apart, nearest
  // first.
  void near_effector(const Instrument& instrument, std::span<DeformableObject> objects, TissueAttribute needed,
                     double reach, double spacing, std::size_t most, std::vector<SurfacePoint>& points);

 private:
  struct Hit {
    double distance = 0;  // m, less a bonus for what was touched before: order in which hits are taken
    std::uint32_t object = 0;
    std::uint32_t triangle = 0;
    Eigen::Vector3d on_surface = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    double gap = 0;
  };

  void collect(const Capsule& capsule, const ContactKey& kind, std::span<DeformableObject> objects, double reach,
               const ContactMemory* memory, TissueAttribute needed);
  // Sorts hits and keeps those that are far enough from each other.
  void thin_out(double spacing, std::size_t most);

  std::vector<Hit> hits_;
  std::vector<Hit> kept_;
  std::vector<std::uint32_t> clusters_;
};

}  // namespace cellmirror::tissue
