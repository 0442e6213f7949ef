#include "ipc/record/joined_ids.hpp"

#include <fmt/format.h>

#include <limits>

namespace cellmirror::mcap {

namespace {

// The id for `one` among `known`: its own, that of an equal one, or a free one. None where all ids are taken.
template <class Record>
std::optional<std::uint16_t> joined_id(const std::map<std::uint16_t, Record>& known, Record one) {
  const auto own = known.find(one.id);
  if (own == known.end() || own->second == one) return one.id;
  for (const auto& [id, other] : known) {
    one.id = id;
    if (other == one) return id;
  }
  constexpr auto kLast = std::numeric_limits<std::uint16_t>::max();
  if (known.rbegin()->first < kLast) return static_cast<std::uint16_t>(known.rbegin()->first + 1);
  for (std::uint16_t id = 1; id < kLast; ++id) {
    if (!known.contains(id)) return id;
  }
  return std::nullopt;
}

}  // namespace

void JoinedIds::begin_recording() {
  schemas_.clear();
  channels_.clear();
  first_ = false;
}

std::string JoinedIds::add(Schema& schema, Catalogue& catalogue) {
  const std::uint16_t own = schema.id;
  const auto known = schemas_.find(own);
  const auto id = known != schemas_.end() ? std::optional(known->second) : joined_id(catalogue.schemas, schema);
  if (!id) return fmt::format("there is no free id for the schema {}", own);
  schemas_.emplace(own, *id);
  schema.id = *id;
  return catalogue.add(schema);
}

std::string JoinedIds::add(Channel& channel, Catalogue& catalogue) {
  const std::uint16_t own = channel.id;
  std::string wrong;
  if (const auto schema = schemas_.find(channel.schema); schema != schemas_.end()) {
    channel.schema = schema->second;
  } else if (channel.schema != 0 && !first_) {
    // The schema of this id belongs to another recording.
    wrong = fmt::format("the channel {} has a schema {} that is not there", own, channel.schema);
    channel.schema = 0;
  }
  const auto known = channels_.find(own);
  const auto id = known != channels_.end() ? std::optional(known->second) : joined_id(catalogue.channels, channel);
  if (!id) return fmt::format("there is no free id for the channel {}", own);
  channels_.emplace(own, *id);
  channel.id = *id;
  std::string differs = catalogue.add(channel);
  return differs.empty() ? wrong : differs;
}

std::optional<std::uint16_t> JoinedIds::channel(std::uint16_t id) const {
  const auto found = channels_.find(id);
  return found == channels_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace cellmirror::mcap
