// Shorthands for reading SCRIPT in tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/lang/command_table.hpp"
#include "scripts/lang/reader.hpp"
#include "tests/golden/scripts/fake_names.hpp"

namespace cellmirror::script {

inline std::filesystem::path source_folder() {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return source == nullptr ? "." : source;
}

// A command that must be correct. Keeps the text that the command looks into.
struct Read {
  explicit Read(std::string_view source_text, const NameDirectory* names) : text(source_text) {
    Diagnostics findings;
    CommandReader reader(text, "message", TextKind::message);
    fine = reader.next(names, command, findings) == CommandReader::Step::command;
    EXPECT_TRUE(fine) << text << "\n" << findings.text();
  }
  Read(const Read&) = delete;
  Read& operator=(const Read&) = delete;

  std::string text;
  ParsedCommand command;
  bool fine = false;
};

// The findings in a text that is read as a message.
inline std::vector<Diagnostic> findings_of(std::string_view text, const NameDirectory* names = nullptr) {
  Diagnostics findings;
  ParsedCommand command;
  CommandReader reader(text, "message", TextKind::message);
  while (reader.next(names, command, findings) != CommandReader::Step::end) {
  }
  return findings.all();
}

inline std::vector<Diagnostic> findings_of_file(std::string_view text, const NameDirectory* names = nullptr) {
  Diagnostics findings;
  check_script(text, "file.spt", names, findings);
  return findings.all();
}

}  // namespace cellmirror::script
