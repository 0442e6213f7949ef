// Reads the summaries of all cells of a domain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/cell_summary.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

struct ReceivedSummary {
  CellSummary summary;
  std::string sender;  // the GUID of the DDS writer
  Timestamp receive_time;
  std::size_t bytes = 0;
};

// The thread of the participant's link calls it, one call at a time. It must not block.
class SummaryInbox {
 public:
  virtual ~SummaryInbox() = default;
  virtual void received(const ReceivedSummary& summary) = 0;
  // What came was no summary.
  virtual void rejected(std::string_view sender, const std::string& why) = 0;
  // The writer was closed, or its lease has ended.
  virtual void gone(std::string_view sender) = 0;
};

struct SummaryReaderConfig {
  int domain = 0;
  std::string interface_address = "127.0.0.1";
  std::string topic = "rt/cellmirror/summary";
  DdsSecurityConfig security = {};
};

class SummaryReader {
 public:
  // `clock` and `inbox` outlive the reader; after its end nothing is called.
  [[nodiscard]] static Result<std::unique_ptr<SummaryReader>> open(const SummaryReaderConfig& config,
                                                                   const Clock& clock, SummaryInbox& inbox);
  virtual ~SummaryReader() = default;

  // Matched now. Any thread.
  [[nodiscard]] virtual std::size_t writers() const = 0;
};

}  // namespace cellmirror::dds
