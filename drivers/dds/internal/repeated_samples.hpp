// Finds samples that a writer sends a second time after the process of a reader was replaced: a reliable writer keeps
// what the reader that ended had not acknowledged, and some DDS products give that to the new reader as well. A
// trajectory or a goal would be executed again. Pure. One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "drivers/dds/message/guid.hpp"
#include "drivers/dds/sample_name.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

class RepeatedSamples {
 public:
  static constexpr std::size_t kMostWriters = 4096;
  // Longer than a writer keeps samples for a reader whose lease it waits for (10 s in Cyclone DDS, 20 s in Fast DDS).
  // Afterwards no number is refused, so that a made-up number does not refuse a writer for ever.
  static constexpr Nanoseconds kWatched{30'000'000'000};

  // Returns true if the reader had this sample, or a later one of the same writer, before the newest restart().
  [[nodiscard]] bool is_repeated(const SampleName& sample, Timestamp now);
  void restart(Timestamp now) { until_ = now + kWatched; }
  // The writer was closed: it sends nothing any more.
  void forget(const Guid& writer) { newest_.erase(writer); }

 private:
  std::map<Guid, std::int64_t> newest_;  // number of the newest sample, by writer
  Timestamp until_;                      // never: there was no restart
};

}  // namespace cellmirror::dds
