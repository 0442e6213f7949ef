#include "drivers/dds/internal/repeated_samples.hpp"

namespace cellmirror::dds {

bool RepeatedSamples::is_repeated(const SampleName& sample, Timestamp now) {
  if (sample.number <= 0) return false;  // it has no name
  const bool watched = until_.known() && now < until_;
  const auto known = newest_.find(sample.guid);
  if (known == newest_.end()) {
    if (newest_.size() < kMostWriters) newest_.emplace(sample.guid, sample.number);
    return false;
  }
  if (watched && sample.number <= known->second) return true;
  known->second = sample.number;
  return false;
}

}  // namespace cellmirror::dds
