// The transfer cell for tests of the service, which need none of SCRIPT's names.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/cell_file.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

inline Cell transfer_cell() {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  Diagnostics diagnostics;
  auto loaded = load_cell(
      std::filesystem::path(source == nullptr ? "." : source) / "config" / "cells" / "transfer_cell" / "cell.toml",
      diagnostics);
  EXPECT_TRUE(loaded) << diagnostics.text();
  return std::move(loaded->cell);
}

struct NoNames final : NameDirectory {
  [[nodiscard]] bool knows(NameKind /*kind*/, std::string_view /*name*/) const override { return false; }
  [[nodiscard]] Error explain(NameKind /*kind*/, std::string_view /*name*/) const override { return {}; }
  [[nodiscard]] std::span<const JointKind> joints(std::string_view /*robot*/) const override { return {}; }
  [[nodiscard]] std::vector<std::string> joint_names(std::string_view /*robot*/) const override { return {}; }
  [[nodiscard]] std::string_view active_robot() const override { return {}; }
  [[nodiscard]] std::vector<std::string> all(NameKind /*kind*/) const override { return {}; }
};

}  // namespace cellmirror::app
