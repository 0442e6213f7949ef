// The black box ([record] of a cell file). Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror {

// A view that is recorded as pictures: "VIEW@HZ".
struct RecordedPicture {
  std::string view;    // "0" to "6", or the name of a camera
  double rate_hz = 1;  // at most
  bool operator==(const RecordedPicture&) const = default;
};
inline constexpr std::size_t kMostRecordedPictures = 8;

// None: it is not "VIEW@HZ" with 0.01 to 10 Hz.
[[nodiscard]] std::optional<RecordedPicture> recorded_picture(std::string_view text);

struct RecordSettings {
  bool present = false;  // the cell file has the table
  bool enabled = true;   // from the start; RECORD ON and OFF switch it
  double length_s = 600;
  double file_s = 60;                     // of one file of the ring
  std::uint64_t most_mb = 1024;           // 10^6 bytes, of all files of the ring
  std::uint64_t attach_mb = 64;           // 10^6 bytes of the cell's files in each file, and at most a quarter of it
  double keep_after_s = 5;                // how much is kept after the cause
  double rate_hz = 100;                   // robot states
  double tissue_rate_hz = 10;             // deformable objects; 0: none
  std::string compression = "zstd";       // zstd, lz4, none
  std::vector<std::string> topics;        // none: all
  std::vector<RecordedPicture> pictures;  // each of another view; none: no pictures
  bool keep_on_fault = true;
  bool keep_on_collision = true;
};

}  // namespace cellmirror
