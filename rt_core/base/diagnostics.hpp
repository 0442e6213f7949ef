// Diagnostics of input text (SCRIPT, cell files, URDF, DBC, ...), collected so that one pass shows all.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace cellmirror {

enum class Severity { note, warning, error };

// "note", "warning", "error"
[[nodiscard]] const char* severity_word(Severity severity);

struct Place {
  std::string file;
  int line = 0;    // from 1; 0: the file as a whole
  int column = 0;  // from 1, counted in bytes; 0: the line as a whole
};

struct Diagnostic {
  Severity severity = Severity::error;
  Place place;
  std::string message;
  std::string remedy;  // may be empty

  // "file:12:3: error: message; remedy"
  [[nodiscard]] std::string text() const;
};

// Collects diagnostics in the order in which they were found. Bounded: beyond kKept they are only counted, so hostile
// input cannot fill the memory.
class Diagnostics {
 public:
  static constexpr std::size_t kKept = 1000;

  void add(Diagnostic diagnostic);
  void error(Place place, std::string message, std::string remedy = {});
  void warning(Place place, std::string message, std::string remedy = {});
  // Appends what another pass found.
  void take(const Diagnostics& other);

  [[nodiscard]] const std::vector<Diagnostic>& all() const { return kept_; }
  [[nodiscard]] std::size_t errors() const { return errors_; }
  [[nodiscard]] std::size_t warnings() const { return warnings_; }
  [[nodiscard]] bool ok() const { return errors_ == 0; }
  // One diagnostic a line, from `least` on, and a last line for those that were only counted.
  [[nodiscard]] std::string text(Severity least = Severity::note) const;

 private:
  std::vector<Diagnostic> kept_;
  std::size_t errors_ = 0;
  std::size_t warnings_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace cellmirror
