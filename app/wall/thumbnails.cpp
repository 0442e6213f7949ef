#include "app/wall/thumbnails.hpp"

#include <utility>

#include "app/wall/jpeg_head.hpp"

namespace cellmirror::app {

Thumbnails::Thumbnails(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) cells_[cell];
}

void Thumbnails::receive(std::string_view cell, std::span<const std::uint8_t> bytes, Timestamp now) {
  const bool small = bytes.size() <= kMostThumbnailBytes;
  const bool good = small && jpeg_size(bytes).has_value();
  const std::scoped_lock lock(mutex_);
  const auto found = cells_.find(cell);
  if (found == cells_.end()) return;
  Entry& entry = found->second;
  if (!good) {
    ++entry.report.refused;
    entry.report.refused_why = small ? "the picture is no JPEG of a size that is shown"
                                     : "the picture has more than " + std::to_string(kMostThumbnailBytes) + " bytes";
    return;
  }
  if (entry.newest.jpeg != nullptr && now - entry.newest.receive_time < kThumbnailPeriod) {
    ++entry.report.left_out;
    return;
  }
  entry.newest.jpeg = std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  entry.newest.receive_time = now;
  entry.report.number = ++entry.newest.number;
  entry.report.receive_time = now;
}

std::optional<Thumbnail> Thumbnails::newest(std::string_view cell) const {
  const std::scoped_lock lock(mutex_);
  const auto found = cells_.find(cell);
  if (found == cells_.end() || found->second.newest.jpeg == nullptr) return std::nullopt;
  return found->second.newest;
}

std::optional<ThumbnailReport> Thumbnails::report(std::string_view cell) const {
  const std::scoped_lock lock(mutex_);
  const auto found = cells_.find(cell);
  return found == cells_.end() ? std::nullopt : std::optional(found->second.report);
}

}  // namespace cellmirror::app
