// What the sources of the Cyclone DDS peer have in common.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sensor_msgs.h"

namespace cellmirror::dds::test {

inline dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity < 0) throw std::runtime_error(std::string(what) + ": " + dds_strretcode(-entity));
  return entity;
}

inline dds_sequence_double view(const std::vector<double>& values) {
  const auto n = static_cast<std::uint32_t>(values.size());
  return {n, n, const_cast<double*>(values.data()), false};
}

template <class Sample, class Use>
void take_all(dds_entity_t reader, Use use) {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    const dds_return_t taken = dds_take(reader, &sample, &info, 1, 1);
    if (taken <= 0) return;
    if (info.valid_data) use(*static_cast<const Sample*>(sample));
    dds_return_loan(reader, &sample, taken);
  }
}

}  // namespace cellmirror::dds::test
