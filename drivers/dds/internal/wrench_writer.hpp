// Writes the forces at the TCPs of robots to their DDS topics.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/wrench_message.hpp"
#include "rt_core/ports/force_state.hpp"

namespace cellmirror::dds {

// One calling thread, but for add_counters().
class WrenchWriter {
 public:
  // A robot's topic is <prefix>/<robot>, created with the first value; an empty prefix: never.
  WrenchWriter(std::shared_ptr<Participant> participant, std::string prefix, CountingWriter::Options options)
      : participant_(std::move(participant)), prefix_(std::move(prefix)), options_(options) {}

  void publish(const ForceState& state);
  // Any thread. Adds to the sums, too.
  void add_counters(std::vector<std::pair<std::string, std::uint64_t>>& counters, std::uint64_t& sent,
                    std::uint64_t& dropped) const;

 private:
  [[nodiscard]] CountingWriter* writer_of(const std::string& robot);

  std::shared_ptr<Participant> participant_;
  std::string prefix_;
  CountingWriter::Options options_;
  mutable std::mutex mutex_;                                        // the map grows while another thread counts
  std::map<std::string, std::unique_ptr<CountingWriter>> writers_;  // by robot; null where DDS refused the topic
  WrenchStamped message_;                                           // reused
};

}  // namespace cellmirror::dds
