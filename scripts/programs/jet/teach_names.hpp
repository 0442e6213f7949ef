// The names of the check points of a file, with their lines. Files have a hundred thousand of them: a flat hash table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace cellmirror::program {

class TeachNames {
 public:
  // The line of an existing name; 0: it is new, and is stored with this one. `name` is used until the last call.
  int note(std::string_view name, int line);

 private:
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t entry = 0;  // index + 1; 0: free
  };
  struct Entry {
    std::string_view name;
    int line = 0;
  };

  void grow();
  // The slot of the name, or its free slot.
  [[nodiscard]] Slot& find(std::uint32_t hash, std::string_view name);

  std::vector<Slot> slots_;  // a power of two, at most half of them taken
  std::vector<Entry> entries_;
};

}  // namespace cellmirror::program
