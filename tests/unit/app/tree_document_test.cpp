// The names that the page offers.
#include "app/report/tree_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::app {
namespace {

using nlohmann::json;
using testing::ElementsAre;

class NamesDocument : public testing::Test {
 protected:
  void SetUp() override {
    home_ = std::filesystem::temp_directory_path() / ("cellmirror_names_" + std::to_string(::getpid()));
    std::filesystem::create_directories(home_ / "scripts");
  }
  void TearDown() override { std::filesystem::remove_all(home_); }

  [[nodiscard]] json document() {
    CellState cell_state;
    cell_state.cell = std::make_shared<const CompiledCell>(small_.cell);
    cell_state.display = std::make_shared<const DisplayState>(small_.display);
    return json::parse(names_document(cell_state, home_));
  }

  std::filesystem::path home_;
  scene::SmallCell small_;
};

TEST_F(NamesDocument, ViewFilesAreWhereLoadViewsReadsThem) {
  for (const char* name : {"gate.vws", "startup.spt"}) std::ofstream(home_ / "scripts" / name) << "format = 1\n";
  const json sut = document();
  EXPECT_THAT(sut["views"], ElementsAre("gate.vws"));
  EXPECT_THAT(sut["scripts"], ElementsAre("startup.spt"));
}

TEST_F(NamesDocument, CamerasAreNamedAsTheDisplayNamesThem) {
  small_.display.cameras.emplace_back().name = "Left.CAM";
  small_.display.cameras.emplace_back().name = "Right.CAM";
  EXPECT_THAT(document()["cameras"], ElementsAre("Left.CAM", "Right.CAM"));
}

}  // namespace
}  // namespace cellmirror::app
