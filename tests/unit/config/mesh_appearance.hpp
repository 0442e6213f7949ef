// The look of the only mesh of a cell in a home of its own, and what is said of it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "config/cell_file.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/mesh_appearance.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {

struct MeshLooks : testing::Test {
  // The look of the only mesh of a cell.
  std::shared_ptr<const MeshAppearance> look_of(const std::string& mesh) {
    diagnostics = {};
    loaded =
        load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n[[node]]\nname = \"A\"\ngeometry = [{ mesh = \"" +
                                              mesh + "\" }]\n"),
                  diagnostics);
    EXPECT_TRUE(loaded) << diagnostics.text();
    return loaded ? geometry().look : nullptr;
  }
  [[nodiscard]] const Geometry& geometry() const {
    return loaded->cell.node(loaded->cell.find("A").value()).definition->geometry.at(0);
  }
  [[nodiscard]] std::string finding() const {
    std::string text = diagnostics.text();
    for (std::size_t at = 0; (at = text.find(home.root().string())) != std::string::npos;)
      text.replace(at, home.root().string().size(), "HOME");
    return text;
  }
  TemporaryHome home;
  Diagnostics diagnostics;
  std::optional<LoadedCell> loaded;
};

}  // namespace cellmirror
