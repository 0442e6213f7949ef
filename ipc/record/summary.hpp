// The summary at the end of a recording. Takes any bytes.
#pragma once

#include <vector>

#include "ipc/record/record_stream.hpp"
#include "ipc/record/scan.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

struct Summary {
  Footer footer;
  Catalogue catalogue;
  std::optional<Statistics> statistics;
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
};

// Fails where the file has none, or one that is wrong: cut off, with another CRC, with offsets out of the file.
[[nodiscard]] Result<Summary> read_summary(const Source& source, const Limits& limits);

}  // namespace cellmirror::mcap
