// A writer with its counters.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/dds/internal/bytes_writer.hpp"

namespace cellmirror::dds {

// Relaxed: counters for people, each on its own.
class Counter {
 public:
  void add(std::uint64_t n = 1) { value_.fetch_add(n, std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t get() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

// Reliable; knows when it overwrites what a reliable reader has not confirmed yet. One calling thread, but for the
// counters.
class CountingWriter {
 public:
  struct Options {
    int depth = 1;
    // At high rates there is always a sample on its way, so that a reader that stands still cannot be distinguished
    // from one that follows.
    bool counts_overwritten = true;
    bool large = false;            // as EndpointConfig
    bool transient_local = false;  // likewise
  };

  [[nodiscard]] static Result<std::unique_ptr<CountingWriter>> make(const std::shared_ptr<Participant>& participant,
                                                                    const std::string& topic, std::string_view type,
                                                                    Options options) {
    auto writer = BytesWriter::make(participant, {topic, type, true, options.depth, options.large,
                                                  options.transient_local, options.counts_overwritten});
    if (!writer) return std::unexpected(writer.error());
    return std::unique_ptr<CountingWriter>(new CountingWriter(std::move(*writer)));
  }

  [[nodiscard]] std::vector<std::byte>& payload() { return writer_->payload(); }
  void write() {
    if (writer_->write()) {
      sent_.add();
    } else {
      refused_.add();
    }
  }
  [[nodiscard]] std::uint64_t sent() const { return sent_.get(); }
  [[nodiscard]] std::uint64_t dropped() const { return refused_.get() + writer_->dropped(); }
  [[nodiscard]] std::uint64_t readers() const {
    return static_cast<std::uint64_t>(std::max(writer_->matched_readers(), 0));
  }

 private:
  explicit CountingWriter(std::unique_ptr<BytesWriter> writer) : writer_(std::move(writer)) {}

  std::unique_ptr<BytesWriter> writer_;
  Counter sent_;
  Counter refused_;
};

}  // namespace cellmirror::dds
