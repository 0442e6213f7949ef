// A number for an object that a file can name in place of its address. Each object has another one as long as the
// process lives; a copy is another object.
#pragma once

#include <atomic>
#include <cstdint>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

class ObjectId {
 public:
  ObjectId() noexcept : value_(next()) {}
  ObjectId(const ObjectId& /*other*/) noexcept : value_(next()) {}
  // What is assigned to is no longer what files named.
  ObjectId& operator=(const ObjectId& /*other*/) noexcept {
    value_ = next();
    return *this;
  }
  ~ObjectId() = default;

  [[nodiscard]] std::uint64_t value() const CELL_RT { return value_; }  // never 0

 private:
  // Relaxed: a counter.
  static std::uint64_t next() noexcept {
    static std::atomic<std::uint64_t> newest{0};
    return newest.fetch_add(1, std::memory_order_relaxed) + 1;
  }

  std::uint64_t value_;
};

}  // namespace cellmirror
