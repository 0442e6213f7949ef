#include "ipc/sysv/shared_memory_limits.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <sstream>
#include <string>

#include "ipc/sysv/key_lock.hpp"
#include "ipc/sysv/process_watch.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "ipc/sysv/system_file.hpp"

namespace cellmirror {
namespace {

constexpr std::size_t kMostLines = 100'000;  // of a system file; more are not read
constexpr std::size_t kMostLeft = 64;
// Four haptic devices, the TCP force and the foot switches.
constexpr std::uint64_t kSegmentsOfAGateway = 6;

// The columns of /proc/sysvipc/shm, proc(5), as far as they are needed.
struct Segment {
  std::int64_t key = 0;
  std::int64_t id = 0;
  std::string mode;
  std::uint64_t bytes = 0;
  std::uint32_t maker = 0;
  std::uint32_t last = 0;
  std::uint64_t attached = 0;
  std::uint32_t user = 0;
};

std::vector<Segment> read_segments(const std::filesystem::path& root) {
  std::ifstream in(root / "proc/sysvipc/shm");
  std::vector<Segment> segments;
  std::string line;
  std::getline(in, line);  // the heading
  for (std::size_t i = 0; i < kMostLines && std::getline(in, line); ++i) {
    std::istringstream words(line);
    Segment segment;
    if (words >> segment.key >> segment.id >> segment.mode >> segment.bytes >> segment.maker >> segment.last >>
        segment.attached >> segment.user) {
      segments.push_back(std::move(segment));
    }
  }
  return segments;
}

IpcFinding limit(const char* name, std::uint64_t value, std::uint64_t least, const char* what) {
  const bool ok = value >= least;
  return {name, value == 0 ? "unknown" : fmt::format("{} {}", value, what), ok,
          ok ? "" : fmt::format("sysctl -w kernel.{}={}", name, least)};
}

IpcFinding left_finding(const std::vector<LeftSegment>& left) {
  if (left.empty()) return {"shared memory", "no leftovers", true, ""};
  constexpr std::size_t kMostNamed = 8;
  std::string keys;
  std::string command = "ipcrm";
  for (std::size_t i = 0; i < std::min(left.size(), kMostNamed); ++i) {
    keys += fmt::format("{}{}", i == 0 ? "" : ", ", key_text(left[i].key));
    command += fmt::format(" -m {}", left[i].id);
  }
  if (left.size() > kMostNamed) keys += ", ...";
  return {"shared memory", fmt::format("{} left by ended processes: {}", left.size(), keys), false,
          command + " (a gateway with one of these keys takes it over at its start)"};
}

}  // namespace

SharedMemoryLimits read_shared_memory_limits(const std::filesystem::path& root) {
  SharedMemoryLimits limits;
  limits.max_segment_bytes = number_in(root / "proc/sys/kernel/shmmax");
  limits.max_total_pages = number_in(root / "proc/sys/kernel/shmall");
  limits.max_segments = number_in(root / "proc/sys/kernel/shmmni");
  for (const Segment& segment : read_segments(root)) {
    ++limits.segments_in_use;
    limits.bytes_in_use += segment.bytes;
  }
  return limits;
}

std::vector<LeftSegment> read_left_segments(std::uint32_t user, const std::filesystem::path& root) {
  std::vector<LeftSegment> left;
  for (const Segment& segment : read_segments(root)) {
    // Key 0 is private: only processes that were given its number know it, such as a display's client.
    if (segment.user != user || segment.attached != 0 || segment.key == 0 || process_exists(segment.maker)) continue;
    if (left.size() == kMostLeft) break;
    left.push_back({std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(segment.key)),
                    static_cast<std::int32_t>(segment.id), segment.bytes});
  }
  return left;
}

std::vector<IpcFinding> shared_memory_findings(const SharedMemoryLimits& limits, const std::vector<LeftSegment>& left) {
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {limit("shmmax", limits.max_segment_bytes, kMaxSegmentBytes, "bytes per segment"),
          limit("shmall", limits.max_total_pages, (limits.bytes_in_use + kSegmentsOfAGateway * kMaxSegmentBytes) / page,
                "pages of all segments"),
          limit("shmmni", limits.max_segments, limits.segments_in_use + kSegmentsOfAGateway, "segments"),
          left_finding(left)};
}

}  // namespace cellmirror
