#include "ipc/sysv/proximity_pacing.hpp"

#include <bit>

namespace cellmirror {
namespace {

// By bits, so that NaN ("not known") equals itself.
bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same(const PointRecord& a, const PointRecord& b) {
  return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]);
}

bool same(const PairRecord& a, const PairRecord& b) {
  return a.touching == b.touching && a.within_warning == b.within_warning && a.doubtful == b.doubtful &&
         a.contacts == b.contacts && same(a.distance, b.distance) && same(a.depth, b.depth) &&
         same(a.point_a, b.point_a) && same(a.point_b, b.point_b) && same(a.normal, b.normal) &&
         same(a.closing_speed, b.closing_speed) && same(a.time_to_contact, b.time_to_contact) && a.a == b.a &&
         a.b == b.b;
}

bool same_sums(const ProximityRecord& a, const ProximityRecord& b) {
  return a.touching == b.touching && a.within_warning == b.within_warning && a.doubts == b.doubts &&
         a.tested == b.tested && same(a.warning_distance, b.warning_distance);
}

bool same_pairs(const ProximityRecord& a, const ProximityRecord& b) {
  if (a.found != b.found || a.pairs.size() != b.pairs.size()) return false;
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    if (!same(a.pairs[i], b.pairs[i])) return false;
  }
  return true;
}

}  // namespace

bool ProximityPacing::is_due(const ProximityRecord& record) {
  const Nanoseconds since(record.header.time_ns - last_.header.time_ns);
  const bool something_near = record.within_warning > 0;
  const bool due = !any_ || since >= kHeartbeat || since < Nanoseconds(0) || !same_sums(record, last_) ||
                   (something_near && !same_pairs(record, last_));
  if (!due) return false;
  any_ = true;
  last_ = record;
  return true;
}

}  // namespace cellmirror
