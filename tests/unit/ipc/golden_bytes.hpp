// Places bytes that are written by hand.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace cellmirror::test {

using Bytes = std::vector<std::byte>;

inline void place(Bytes& bytes, std::size_t offset, std::initializer_list<int> values) {
  for (const int value : values) bytes.at(offset++) = static_cast<std::byte>(value);
}

inline void place(Bytes& bytes, std::size_t offset, std::string_view text) {
  for (const char c : text) bytes.at(offset++) = static_cast<std::byte>(c);
}

}  // namespace cellmirror::test
