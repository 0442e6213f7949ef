// The wall as JSON documents for its page (docs/wall.md): the whole, and what has changed since the last one. Of a tile
// the part that seldom changes, its content, is sent only when it has.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/wall/thumbnails.hpp"
#include "app/wall/wall_cells.hpp"

namespace cellmirror::app {

// One thread at a time.
class WallDocuments {
 public:
  explicit WallDocuments(const std::string& version) : version_(version) {}

  // What has changed since the last call: a page that has "from" has "to" afterwards.
  [[nodiscard]] std::string changes(const WallCells& cells, const Thumbnails& thumbnails, Timestamp now);
  // Everything; a page that has it goes on with the changes "from" its "to".
  [[nodiscard]] std::string whole(const WallCells& cells, const Thumbnails& thumbnails, Timestamp now) const;

 private:
  struct Sent {
    std::uint64_t version = 0;
    std::uint64_t thumbnail = 0;
    std::string content;
  };

  std::string version_;
  std::uint64_t revision_ = 0;
  std::map<std::uint64_t, Sent> sent_;  // by number of the tile
};

}  // namespace cellmirror::app
