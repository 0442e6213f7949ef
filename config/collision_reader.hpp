// Reads [collision] of a cell file. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "config/table_reader.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/collision/settings.hpp"

namespace cellmirror {

class CollisionReader {
 public:
  void read(TableReader& top);
  // When the cell is there: the settings, with full paths in the rules; unknown and ambiguous paths are errors. A path
  // into a part that is not in memory is accepted below the part.
  [[nodiscard]] collision::Settings settings(const Cell& cell, Diagnostics& diagnostics) const;

 private:
  struct Places {
    Place a;
    Place b;
  };
  void read_rules(TableReader& table, const char* key, collision::PairRule::Kind kind);

  collision::Settings settings_;
  std::vector<Places> places_;  // of the rules
};

}  // namespace cellmirror
