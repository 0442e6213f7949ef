// Copies what is whole of a recording that was cut off or damaged into a new file with summary. Takes any bytes.
#pragma once

#include <cstdint>

#include "ipc/record/byte_stream.hpp"
#include "ipc/record/scan.hpp"
#include "ipc/record/writer.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

struct RecoverReport {
  Statistics written;             // into the new file
  std::uint64_t chunks_lost = 0;  // that could not be decompressed, or have a wrong CRC
  Faults faults;                  // of the old file
  bool was_whole = false;         // there was nothing to repair
};

// Sequences and times stay as they were; chunks are made again. Ids of schemas and channels stay too, except where
// joined recordings disagree on them. Fails where `source` is no MCAP file, or the new file cannot be written.
[[nodiscard]] Result<RecoverReport> recover(const Source& source, Sink& out, Compression compression,
                                            const Limits& limits = {});

}  // namespace cellmirror::mcap
