// Maps the ids of schemas and channels of one recording to those of the whole file. In a file that holds several
// recordings, one behind the other, each of them numbers its channels on its own. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "ipc/record/scan.hpp"

namespace cellmirror::mcap {

class JoinedIds {
 public:
  // The ids that follow are those of another recording.
  void begin_recording();
  // Gives it an id of its own in the catalogue, or that of an equal one. Empty, or what is wrong with it.
  std::string add(Schema& schema, Catalogue& catalogue);
  std::string add(Channel& channel, Catalogue& catalogue);
  // None where this recording has not described the channel.
  [[nodiscard]] std::optional<std::uint16_t> channel(std::uint16_t id) const;

 private:
  using Ids = std::map<std::uint16_t, std::uint16_t>;

  Ids schemas_;
  Ids channels_;
  bool first_ = true;
};

}  // namespace cellmirror::mcap
