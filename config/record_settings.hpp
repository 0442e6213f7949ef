// The black box ([record] of a cell file). Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror {

struct RecordSettings {
  bool present = false;  // the cell file has the table
  bool enabled = true;   // from the start; RECORD ON and OFF switch it
  double length_s = 600;
  double file_s = 60;                // of one file of the ring
  std::uint64_t most_mb = 1024;      // 10^6 bytes, of all files of the ring
  std::uint64_t attach_mb = 64;      // 10^6 bytes of the cell's files in each file, and at most a quarter of it
  double keep_after_s = 5;           // so long behind what it is kept for
  double rate_hz = 100;              // robot states
  std::string compression = "zstd";  // zstd, lz4, none
  std::vector<std::string> topics;   // none: all
  bool keep_on_fault = true;
  bool keep_on_collision = true;
};

}  // namespace cellmirror
