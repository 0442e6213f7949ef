// The newest small picture of each cell that has one. Bounded in size and rate; only what looks like a JPEG is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

inline constexpr std::size_t kMostThumbnailBytes = 256 * 1024;
inline constexpr Nanoseconds kThumbnailPeriod{1'000'000'000};  // what comes sooner is left out

struct Thumbnail {
  std::uint64_t number = 0;  // of this cell, from 1
  Timestamp receive_time;
  std::shared_ptr<const std::string> jpeg;
};

struct ThumbnailReport {
  std::uint64_t number = 0;  // of the newest; 0: none yet
  Timestamp receive_time;
  std::uint64_t left_out = 0;  // came too soon
  std::uint64_t refused = 0;   // too large, or no JPEG
  std::string refused_why;     // the last one
};

// Any thread.
class Thumbnails {
 public:
  // Pictures of other cells are ignored.
  explicit Thumbnails(const std::vector<std::string>& cells);

  void receive(std::string_view cell, std::span<const std::uint8_t> bytes, Timestamp now);
  // None: there is no picture of that cell.
  [[nodiscard]] std::optional<Thumbnail> newest(std::string_view cell) const;
  // None: no picture of that cell is asked for.
  [[nodiscard]] std::optional<ThumbnailReport> report(std::string_view cell) const;

 private:
  struct Entry {
    Thumbnail newest;
    ThumbnailReport report;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Entry, std::less<>> cells_;
};

}  // namespace cellmirror::app
