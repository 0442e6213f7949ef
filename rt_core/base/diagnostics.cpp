#include "rt_core/base/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace cellmirror {

const char* severity_word(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "error";
}

std::string Diagnostic::text() const {
  std::string out = place.file.empty() ? std::string("input") : place.file;
  if (place.line > 0) out += fmt::format(":{}", place.line);
  if (place.line > 0 && place.column > 0) out += fmt::format(":{}", place.column);
  out += fmt::format(": {}: {}", severity_word(severity), message);
  if (!remedy.empty()) out += "; " + remedy;
  return out;
}

void Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  if (diagnostic.severity == Severity::warning) ++warnings_;
  if (kept_.size() < kKept) {
    kept_.push_back(std::move(diagnostic));
    return;
  }
  ++dropped_;
  // An error after a thousand warnings replaces the last of them. Once errors outnumber the places, no warning is left.
  if (diagnostic.severity != Severity::error || errors_ > kKept) return;
  const auto other = std::find_if(kept_.rbegin(), kept_.rend(),
                                  [](const Diagnostic& kept) { return kept.severity != Severity::error; });
  if (other == kept_.rend()) return;
  kept_.erase(std::next(other).base());
  kept_.push_back(std::move(diagnostic));
}

void Diagnostics::error(Place place, std::string message, std::string remedy) {
  add({Severity::error, std::move(place), std::move(message), std::move(remedy)});
}

void Diagnostics::warning(Place place, std::string message, std::string remedy) {
  add({Severity::warning, std::move(place), std::move(message), std::move(remedy)});
}

void Diagnostics::take(const Diagnostics& other) {
  for (const Diagnostic& diagnostic : other.kept_) add(diagnostic);
  dropped_ += other.dropped_;
  std::size_t kept_errors = 0;
  std::size_t kept_warnings = 0;
  for (const Diagnostic& diagnostic : other.kept_) {
    kept_errors += diagnostic.severity == Severity::error ? 1U : 0U;
    kept_warnings += diagnostic.severity == Severity::warning ? 1U : 0U;
  }
  errors_ += other.errors_ - kept_errors;
  warnings_ += other.warnings_ - kept_warnings;
}

std::string Diagnostics::text(Severity least) const {
  std::string out;
  for (const Diagnostic& diagnostic : kept_) {
    if (diagnostic.severity >= least) out += diagnostic.text() + "\n";
  }
  if (dropped_ > 0) out += fmt::format("... and {} more\n", dropped_);
  return out;
}

}  // namespace cellmirror
