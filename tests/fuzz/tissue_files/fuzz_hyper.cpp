// Any bytes as a hyper file: findings, or connections within their limits.
#include <cstddef>
#include <cstdint>

#include "config/hyper_file.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  static const std::vector<std::string> objects{"liver.mpo", "gallbladder.mpo"};
  Diagnostics diagnostics;
  const auto hyper = parse_hyper({reinterpret_cast<const char*>(data), size}, "fuzz.hyper", &objects, diagnostics);
  CELLMIRROR_EXPECTS(hyper.has_value() == diagnostics.ok());
  if (!hyper) return 0;
  CELLMIRROR_EXPECTS(hyper->connections.size() <= kMostConnections);
  for (const tissue::Connection& connection : hyper->connections) {
    CELLMIRROR_EXPECTS(connection.object_a == objects[0] || connection.object_a == objects[1]);
    CELLMIRROR_EXPECTS(connection.object_a != connection.object_b);
    CELLMIRROR_EXPECTS(connection.point_a.allFinite() && connection.point_b.allFinite());
    CELLMIRROR_EXPECTS(connection.radius_m >= 0 && connection.stiffness_n_m > 0 && connection.tear_force_n >= 0);
  }
  return 0;
}
