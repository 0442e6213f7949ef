#include "ipc/wire/tcp_force_block.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "ipc/wire/shared_words.hpp"

namespace cellmirror {
namespace {

namespace at = tcp_force_block_offset;
using shared_words::first_of;
using shared_words::pair;
using shared_words::second_of;

constexpr std::size_t kNameBytes = 64;
constexpr std::size_t kWords = (at::kRobot + kNameBytes - at::kSequence) / 8;
constexpr std::uint64_t kNameWord = pair(kTcpForceMagic, kTcpForceVersion | std::uint32_t{at::kSize} << 16);
static_assert(at::kRobot % 8 == 0 && at::kRobot + kNameBytes <= at::kSize && at::kSize <= 0xffff);

bool holds_all(std::span<const std::byte> memory) {
  return memory.size() >= at::kSize && shared_words::is_aligned(memory);
}

void store_values(std::span<std::byte> memory, const std::array<float, 4>& values) {
  const std::size_t fit = std::min(memory.size() / 4, values.size());
  for (std::size_t i = 0; i < fit; ++i) shared_words::store_f32(memory, at::kValues + 4 * i, values[i]);
}

using NameWords = std::array<std::uint64_t, kNameBytes / 8>;

// As much of it as leaves a zero behind it.
NameWords name_words(std::string_view name) {
  std::array<char, kNameBytes> bytes{};
  std::copy_n(name.data(), std::min(name.size(), kNameBytes - 1), bytes.data());
  NameWords words = std::bit_cast<NameWords>(bytes);
  for (auto& word : words) word = shared_words::little(word);
  return words;
}

}  // namespace

void write_tcp_force(std::span<std::byte> memory, const TcpForce& force) {
  if (!shared_words::is_aligned(memory)) return;
  TcpForce written = force;
  if (!std::all_of(force.values.begin(), force.values.end(), [](float value) { return std::isfinite(value); })) {
    written.values = {};
    written.flags &= ~kTcpForceValid;
  }
  if (!holds_all(memory)) {
    store_values(memory, written.values);
    return;
  }
  const NameWords robot = name_words(force.robot.view());
  const shared_words::WriteLock lock(memory, at::kLock);
  store_values(memory, written.values);
  shared_words::store(memory, at::kMagic, kNameWord);
  shared_words::store(memory, at::kSequence, written.sequence);
  shared_words::store(memory, at::kTime, std::bit_cast<std::uint64_t>(written.time.ns));
  shared_words::store(memory, at::kFlags, pair(written.flags, written.process));
  for (std::size_t i = 0; i < robot.size(); ++i) shared_words::store(memory, at::kRobot + 8 * i, robot[i]);
}

void end_tcp_force(std::span<std::byte> memory) {
  TcpForce last;
  if (holds_all(memory)) {
    last.sequence = shared_words::load<std::uint64_t>(memory, at::kSequence) + 1;
    last.time.ns = std::bit_cast<std::int64_t>(shared_words::load<std::uint64_t>(memory, at::kTime));
  }
  write_tcp_force(memory, last);
}

std::uint32_t tcp_force_process(std::span<const std::byte> memory) {
  if (!holds_all(memory) || shared_words::load<std::uint64_t>(memory, at::kMagic) != kNameWord) return 0;
  return second_of(shared_words::load<std::uint64_t>(memory, at::kFlags));
}

bool read_tcp_force(std::span<const std::byte> memory, TcpForce& force) {
  if (!holds_all(memory)) return false;
  std::array<std::uint32_t, 4> values{};
  std::array<std::uint64_t, kWords> words{};
  std::uint64_t name = 0;
  std::uint64_t lock = 0;
  const auto copy = [&]() CELL_RT {
    name = shared_words::load<std::uint64_t>(memory, at::kMagic);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = shared_words::load<std::uint32_t>(memory, at::kValues + 4 * i);
    }
    shared_words::load_words(memory, at::kSequence, words);
  };
  if (!shared_words::read_locked(memory, at::kLock, lock, copy) || name != kNameWord) return false;

  const auto word = [&](std::size_t offset) { return words[(offset - at::kSequence) / 8]; };
  for (std::size_t i = 0; i < values.size(); ++i) force.values[i] = std::bit_cast<float>(values[i]);
  force.sequence = word(at::kSequence);
  force.time.ns = std::max(std::bit_cast<std::int64_t>(word(at::kTime)), std::int64_t{0});  // never before 0
  force.flags = first_of(word(at::kFlags));
  force.process = second_of(word(at::kFlags));
  NameWords robot{};
  for (std::size_t i = 0; i < robot.size(); ++i) robot[i] = shared_words::little(word(at::kRobot + 8 * i));
  const auto bytes = std::bit_cast<std::array<char, kNameBytes>>(robot);
  force.robot.assign({bytes.data(), ::strnlen(bytes.data(), bytes.size())});
  return true;
}

}  // namespace cellmirror
