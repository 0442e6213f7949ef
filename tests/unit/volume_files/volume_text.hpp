// Bytes and heads of small volumes for tests.
#pragma once

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror {

template <class T>
std::string bytes_of(const std::vector<T>& values, bool big_endian = false) {
  std::string out;
  for (const T value : values) {
    std::string one(sizeof(T), '\0');
    std::memcpy(one.data(), &value, sizeof(T));
    if (big_endian) one.assign(one.rbegin(), one.rend());
    out += one;
  }
  return out;
}

template <class T>
std::vector<T> counting(std::size_t count, T first = T{}) {
  std::vector<T> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<T>(first + static_cast<T>(i));
  return out;
}

inline std::string gzip(std::string_view bytes) {
  z_stream state{};
  constexpr int kGzip = 16;
  deflateInit2(&state, Z_BEST_SPEED, Z_DEFLATED, MAX_WBITS + kGzip, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&state, bytes.size()), '\0');
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  state.avail_in = static_cast<uInt>(bytes.size());
  state.next_out = reinterpret_cast<Bytef*>(out.data());
  state.avail_out = static_cast<uInt>(out.size());
  deflate(&state, Z_FINISH);
  out.resize(state.total_out);
  deflateEnd(&state);
  return out;
}

// A head of 4 x 3 x 2 voxels of 16 bits with these lines in addition.
inline std::string nrrd_head(const std::string& more = "spacings: 0.5 0.7 1.5\n", const std::string& type = "short",
                             const std::string& encoding = "raw") {
  return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 4 3 2\nendian: little\nencoding: " + encoding + "\n" +
         more;
}

}  // namespace cellmirror
