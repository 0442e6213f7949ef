#include "drivers/dds/sender_conflict.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror::dds {

std::string text(const WriterGuid& guid) {
  std::string out;
  for (std::size_t i = 0; i < guid.size(); ++i)
    out += fmt::format("{}{:02x}", i == 0 ? "" : i == 12 ? "|" : ".", guid[i]);
  return out;
}

bool SenderConflict::take(std::uint64_t publisher, const WriterGuid& guid, Timestamp now) {
  if (publisher == 0) return false;
  if (publisher != newest_) {
    const auto again = std::ranges::find(before_, publisher, &Sender::publisher);
    if (again != before_.end() && now - again->heard <= window_) conflict_ = now;
    // The newest one takes the place of this one, or of the one that was heard longest ago.
    const auto place = again != before_.end() ? again : std::ranges::min_element(before_, {}, &Sender::heard);
    if (newest_ != 0) {
      *place = {newest_, newest_heard_};
      other_guid_ = newest_guid_;
    }
    newest_ = publisher;
    newest_guid_ = guid;
  }
  newest_heard_ = now;
  return conflict_.known() && now - conflict_ <= window_;
}

}  // namespace cellmirror::dds
