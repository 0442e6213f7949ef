#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "config/node_reader.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror {

namespace {

// A continuous joint has no limits; a number this large never acts as one.
constexpr double kNoLimit = 1e6;  // rad

// The keys carry the unit of the joint's type.
struct Keys {
  std::string position;  // "_rad" or "_m"
  std::string velocity;
  std::string acceleration;
  std::string effort;
  std::string viscous;

  explicit Keys(bool prismatic)
      : position(prismatic ? "_m" : "_rad"),
        velocity(prismatic ? "_m_s" : "_rad_s"),
        acceleration(prismatic ? "_m_s2" : "_rad_s2"),
        effort(prismatic ? "_n" : "_nm"),
        viscous(prismatic ? "_n_s_m" : "_nm_s_rad") {}
};

void read_axis(TableReader& reader, JointDefinition& joint) {
  const auto axis = reader.vector3("axis");
  if (!axis) return;
  constexpr double kShortest = 1e-6;
  if (axis->norm() < kShortest) return reader.error("axis", "the axis has length zero", "give e.g. axis = [0, 0, 1]");
  joint.axis = axis->normalized();
}

void read_range(TableReader& reader, const Keys& keys, JointDefinition& joint) {
  const std::string key = "range" + keys.position;
  const auto range = reader.numbers(key, 2);
  if (joint.kind == JointKind::continuous) {
    if (range) reader.error(key, "a continuous joint has no range", "make its type revolute");
    joint.min_position = -kNoLimit;
    joint.max_position = kNoLimit;
    return;
  }
  reader.require(key);
  if (!range) return;
  if ((*range)[0] >= (*range)[1]) {
    return reader.error(key, fmt::format("{} = [{:g}, {:g}]: the lower limit is not below the upper one", key,
                                         (*range)[0], (*range)[1]));
  }
  joint.min_position = (*range)[0];
  joint.max_position = (*range)[1];
}

void read_start(TableReader& reader, const Keys& keys, JointDefinition& joint) {
  const bool zero_inside = joint.min_position <= 0.0 && joint.max_position >= 0.0;
  joint.start_position = zero_inside ? 0.0 : 0.5 * (joint.min_position + joint.max_position);
  const std::string key = "start" + keys.position;
  if (const auto start = reader.number(key)) {
    if (*start < joint.min_position || *start > joint.max_position) {
      reader.error(key, fmt::format("{} is {:g}, outside of the range {:g} to {:g}", key, *start, joint.min_position,
                                    joint.max_position));
    } else {
      joint.start_position = *start;
    }
  }
  joint.reference_position = reader.number("reference" + keys.position).value_or(0.0);
}

void read_mimic(TableReader& reader, const Keys& keys, JointDefinition& joint) {
  auto table = reader.table("mimic");
  if (!table) return;
  Mimic mimic;
  table->require("joint");
  mimic.joint = table->text("joint").value_or("");
  mimic.multiplier = table->number("multiplier").value_or(1.0);
  mimic.offset = table->number("offset" + keys.position).value_or(0.0);
  table->finish();
  joint.mimic = mimic;
}

}  // namespace

JointDefinition read_joint(TableReader& reader) {
  JointDefinition joint;
  reader.require("type");
  joint.kind = reader
                   .choice<JointKind>("type", {{word(JointKind::revolute), JointKind::revolute},
                                               {word(JointKind::continuous), JointKind::continuous},
                                               {word(JointKind::prismatic), JointKind::prismatic}})
                   .value_or(reader.has("range_m") ? JointKind::prismatic : JointKind::revolute);
  const Keys keys(joint.kind == JointKind::prismatic);
  read_axis(reader, joint);
  read_mimic(reader, keys, joint);
  if (!joint.mimic) {
    read_range(reader, keys, joint);
    read_start(reader, keys, joint);
    reader.require("velocity" + keys.velocity);
  }
  joint.max_velocity = reader.number("velocity" + keys.velocity, kPositive).value_or(1.0);
  joint.velocity_given = reader.has("velocity" + keys.velocity);
  joint.acceleration_given = reader.has("acceleration" + keys.acceleration);
  joint.min_velocity = reader.number("min_velocity" + keys.velocity, kNotNegative).value_or(0.0);
  if (joint.min_velocity > joint.max_velocity)
    reader.error("min_velocity" + keys.velocity, "the minimum velocity is above the maximum");
  constexpr double kRampTime = 0.2;  // s to full speed, where the file gives no acceleration
  joint.max_acceleration =
      reader.number("acceleration" + keys.acceleration, kPositive).value_or(joint.max_velocity / kRampTime);
  joint.drive.max_effort = reader.number("effort" + keys.effort, kNotNegative).value_or(0.0);
  joint.drive.gear_ratio = reader.number("gear_ratio").value_or(0.0);
  joint.drive.rotor_inertia = reader.number("rotor_inertia_kg_m2", kNotNegative).value_or(0.0);
  joint.drive.coulomb_friction = reader.number("coulomb_friction" + keys.effort, kNotNegative).value_or(0.0);
  joint.drive.viscous_friction = reader.number("viscous_friction" + keys.viscous, kNotNegative).value_or(0.0);
  reader.finish();
  return joint;
}

}  // namespace cellmirror
