#include "drivers/can/stream/identifier_routes.hpp"

#include <algorithm>

namespace cellmirror::can {

void IdentifierRoutes::clear() {
  routes_.clear();
  all_.clear();
}

void IdentifierRoutes::add(CanListener listener, std::span<const std::uint32_t> identifiers) {
  for (auto at = identifiers.begin(); at != identifiers.end(); ++at) {
    const bool before = std::find(identifiers.begin(), at, *at) != at;
    if (*at < kIdentifiers && !before) routes_.push_back({*at, listener});
  }
}

void IdentifierRoutes::build() {
  std::ranges::stable_sort(routes_, {}, &Route::identifier);
  listeners_.clear();
  auto next = routes_.begin();
  for (std::uint32_t identifier = 0; identifier < kIdentifiers; ++identifier) {
    first_.at(identifier) = static_cast<std::uint32_t>(listeners_.size());
    for (; next != routes_.end() && next->identifier == identifier; ++next) listeners_.push_back(next->listener);
    listeners_.insert(listeners_.end(), all_.begin(), all_.end());
  }
  first_.at(kIdentifiers) = static_cast<std::uint32_t>(listeners_.size());
  listeners_.insert(listeners_.end(), all_.begin(), all_.end());
  first_.at(kIdentifiers + 1) = static_cast<std::uint32_t>(listeners_.size());
}

std::span<const CanListener> IdentifierRoutes::of(const CanFrame& frame) const {
  const std::size_t place = frame.extended || frame.id >= kIdentifiers ? kIdentifiers : frame.id;
  return std::span(listeners_).subspan(first_.at(place), first_.at(place + 1) - first_.at(place));
}

}  // namespace cellmirror::can
