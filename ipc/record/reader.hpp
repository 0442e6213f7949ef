// Reads messages of a recording by topic and time: by its summary where that is right, else by reading it as a whole
// once, when it is opened.
// Takes any bytes. One thread; not for the tick.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ipc/record/scan.hpp"
#include "ipc/record/summary.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

struct Filter {
  std::vector<std::string> topics;  // none: all
  std::uint64_t from = 0;           // log time, this one included
  std::uint64_t to = std::numeric_limits<std::uint64_t>::max();
};

class Reader {
 public:
  // False ends the reading.
  using Take = std::function<bool(const Message& message, const Channel& channel)>;

  // Fails where `source` is no MCAP file. It outlives the reader.
  [[nodiscard]] static Result<Reader> open(const Source& source, const Limits& limits = {});

  // In the order of the file; chunks by their first time. Fails at the first chunk that cannot be read; with a scan
  // (see indexed()) what is wrong is left out, and is in faults().
  Result<void> read(const Filter& filter, const Take& take);
  // The last attachment or metadata of that name; none where there is none or it is wrong.
  [[nodiscard]] std::optional<std::string> attachment(std::string_view name) const;
  [[nodiscard]] std::optional<Metadata> metadata(std::string_view name) const;

  [[nodiscard]] const Header& header() const { return header_; }
  [[nodiscard]] const Catalogue& catalogue() const { return catalogue_; }
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }
  [[nodiscard]] const std::vector<ChunkIndex>& chunks() const { return chunks_; }
  [[nodiscard]] const std::vector<AttachmentIndex>& attachments() const { return attachments_; }
  [[nodiscard]] const std::vector<MetadataIndex>& metadata_records() const { return metadata_; }
  // Whether a summary was used; else why_not_indexed().
  [[nodiscard]] bool indexed() const { return indexed_; }
  [[nodiscard]] const std::string& why_not_indexed() const { return why_not_; }
  [[nodiscard]] const Faults& faults() const { return faults_; }
  // Number of chunks that are in chunks() but not in the other counts (Limits::leave_out_beyond).
  [[nodiscard]] std::uint64_t chunks_left_out() const { return chunks_left_out_; }

 private:
  Reader(const Source& source, const Limits& limits) : source_(&source), limits_(limits) {}
  [[nodiscard]] Result<Header> read_header() const;
  Result<void> read_by_index(const Filter& filter, const Take& take);
  [[nodiscard]] Result<Bytes> record_at(std::uint64_t offset, std::uint64_t length, Opcode opcode) const;

  const Source* source_;
  Limits limits_;
  Header header_;
  Catalogue catalogue_;
  Statistics statistics_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  Faults faults_;
  std::uint64_t chunks_left_out_ = 0;
  bool indexed_ = false;
  bool chunks_have_all_ = false;  // of a scan: chunks_ are enough to read all messages
  std::string why_not_;
};

}  // namespace cellmirror::mcap
