// What is left of a recording that is cut off at random bytes, as a killed process or a full disk leaves it: the time
// between the last message that can be read and the last one of the chunk that was being written. One line on standard
// output; 1 where a rest could not be read or repaired.
//   record_cuts FILE CUTS
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "ipc/record/reader.hpp"
#include "ipc/record/recover.hpp"
#include "rt_core/base/home.hpp"

namespace {

using namespace cellmirror;

struct Lost {
  double seconds = 0;
  bool readable = false;  // as it is
  bool whole = false;     // after recover
};

// Log time of the last message among those of chunks that begin before `cut`.
std::uint64_t last_before(const std::vector<mcap::ChunkIndex>& chunks, std::uint64_t cut) {
  std::uint64_t last = 0;
  for (const mcap::ChunkIndex& chunk : chunks)
    if (chunk.offset < cut) last = std::max(last, chunk.end_time);
  return last;
}

Lost lost_at(mcap::View whole, const std::vector<mcap::ChunkIndex>& chunks, std::uint64_t cut) {
  const mcap::MemorySource source(whole.first(cut));
  Lost out;
  std::uint64_t last = 0;
  if (auto reader = mcap::Reader::open(source)) {
    out.readable = reader
                       ->read({},
                              [&](const mcap::Message& message, const mcap::Channel&) {
                                last = std::max(last, message.log_time);
                                return true;
                              })
                       .has_value();
  }
  mcap::MemorySink repaired;
  if (mcap::recover(source, repaired, mcap::Compression::none)) {
    mcap::Visitor nobody;
    const auto check = mcap::scan(mcap::MemorySource(repaired.bytes), {}, nobody);
    out.whole = check && check->ended && check->faults.count() == 0;
  }
  const std::uint64_t written = last_before(chunks, cut);
  const std::uint64_t start = chunks.empty() ? written : chunks.front().start_time;
  if (written > 0) out.seconds = 1e-9 * static_cast<double>(written - std::min(written, std::max(last, start)));
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const auto content = read_text_file(arguments[1], std::size_t{1} << 30);
  if (!content) return std::fprintf(stderr, "%s\n", content.error().text().c_str()), 1;
  const mcap::View whole = mcap::view_of(*content);
  const mcap::MemorySource source(whole);
  const auto reader = mcap::Reader::open(source);
  if (!reader || !reader->indexed()) return std::fprintf(stderr, "no whole recording\n"), 1;
  std::mt19937_64 random(1);
  std::vector<double> seconds;
  std::size_t readable = 0;
  std::size_t repaired = 0;
  const auto cuts = static_cast<std::size_t>(std::atoi(arguments[2]));
  // Behind the magic and the header there is a file at all.
  std::uniform_int_distribution<std::uint64_t> bytes(64, whole.size());
  for (std::size_t i = 0; i < cuts; ++i) {
    const Lost lost = lost_at(whole, reader->chunks(), bytes(random));
    seconds.push_back(lost.seconds);
    readable += lost.readable ? 1 : 0;
    repaired += lost.whole ? 1 : 0;
  }
  std::ranges::sort(seconds);
  std::printf("%zu cuts: lost %.2f s (median), %.2f s at most; %zu readable as they were, %zu whole after recover\n",
              cuts, seconds[seconds.size() / 2], seconds.back(), readable, repaired);
  return repaired == cuts ? 0 : 1;
}
