#include "scripts/programs/irdata/words.hpp"

#include <algorithm>

#include "rt_core/base/contract.hpp"

namespace cellmirror::program::irdata {

namespace {

constexpr std::size_t kLongestWord = 32;

constexpr char upper_of(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

// FNV-1a over upper case letters.
std::size_t hash_of_word(std::string_view word) {
  std::uint32_t hash = 2166136261U;
  for (const char c : word) hash = (hash ^ static_cast<unsigned char>(upper_of(c))) * 16777619U;
  return hash ^ (hash >> 15);
}

}  // namespace

WordTable::WordTable(std::span<const std::string_view> words) : words_(words) {
  CELLMIRROR_EXPECTS(words.size() <= 200);
  for (std::size_t i = 0; i < words.size(); ++i) {
    CELLMIRROR_EXPECTS(!words[i].empty() && words[i].size() <= kLongestWord);
    std::size_t slot = hash_of_word(words[i]) % kSlots;
    while (slots_[slot] != 0) slot = (slot + 1) % kSlots;
    slots_[slot] = static_cast<std::uint8_t>(i + 1);
  }
}

std::size_t WordTable::find(std::string_view word) const {
  if (word.empty() || word.size() > kLongestWord) return kNone;
  for (std::size_t slot = hash_of_word(word) % kSlots; slots_[slot] != 0; slot = (slot + 1) % kSlots) {
    const std::size_t index = slots_[slot] - std::size_t{1};
    if (std::ranges::equal(words_[index], word, {}, {}, upper_of)) return index;
  }
  return kNone;
}

}  // namespace cellmirror::program::irdata
