// Entries of systemd's journal with fields of their own, by its protocol ("Native Journal Protocol"), without
// libsystemd. Not for the tick.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror {

struct JournalEntry {
  int priority = 6;       // as of syslog: 3 error, 4 warning, 6 information, 7 debugging
  std::string_view kind;  // "can.bus-off PUMA_762": the word is CELLMIRROR_KIND, what follows it CELLMIRROR_SUBJECT
  std::string_view message;
  std::uint64_t swallowed = 0;  // others of this kind that were not written: CELLMIRROR_SWALLOWED
};

// The fields as they are sent. Pure.
[[nodiscard]] std::string journal_text(const JournalEntry& entry);

// Whether standard error is the journal: $JOURNAL_STREAM names its device and inode.
[[nodiscard]] bool standard_error_is_journal(const char* journal_stream);

class Journal {
 public:
  // Sends to the socket at that path; nothing is opened where it is empty.
  explicit Journal(std::string_view socket_path);
  // False where nobody takes it: the caller then writes to standard error. Does not wait. Any thread.
  [[nodiscard]] bool send(const JournalEntry& entry) const;

 private:
  std::string path_;
  Descriptor socket_;
};

}  // namespace cellmirror
