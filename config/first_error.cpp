#include "config/first_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror {

Error first_error(const Diagnostics& diagnostics, const std::filesystem::path& file) {
  const auto& all = diagnostics.all();
  const auto first = std::ranges::find(all, Severity::error, &Diagnostic::severity);
  const std::string what = first == all.end() ? fmt::format("{} is refused", file.string()) : first->text();
  return {diagnostics.errors() > 1 ? fmt::format("{} (and {} more)", what, diagnostics.errors() - 1) : what,
          fmt::format("cellmirror check {} shows all", file.string())};
}

}  // namespace cellmirror
