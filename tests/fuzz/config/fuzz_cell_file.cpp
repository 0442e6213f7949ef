// Any bytes as a cell file in a home of its own, with a component and a URDF to refer to: findings or a cell, never a
// crash. What loads is changed by every operation on every node.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "config/cell_file.hpp"
#include "rt_core/base/contract.hpp"

namespace {

namespace fs = std::filesystem;

class Home {
 public:
  Home() : root_(fs::temp_directory_path() / ("cellmirror_fuzz_" + std::to_string(getpid()))) {
    unsetenv("kis_home");
    for (const char* folder : {"envlib", "scripts", "robots"}) fs::create_directories(root_ / folder);
    write(
        "envlib/arm.mpc",
        "format = 1\n[[node]]\nname = \"J\"\njoint = { type = \"continuous\", axis = [0, 0, 1], velocity_rad_s = 1 }\n"
        "[[node]]\nname = \"T\"\nparent = \"J\"\n[robot]\nid = \"ARM\"\nflange = \"T\"\n");
    write("envlib/part.mpc",
          "format = 1\ngeometry = [{ sphere_m = 1, stands_for = [\"D\"] }]\n[[node]]\nname = \"D\"\nabstract = "
          "\"deep.mpc\"\nshown = \"coarse\"\n");
    write("envlib/deep.mpc", "format = 1\n[[node]]\nname = \"P\"\nabstract = \"part.mpc\"\nshown = \"hidden\"\n");
    write("robots/arm.urdf",
          "<robot name=\"u\"><link name=\"a\"/><link name=\"b\"/><joint name=\"j\" type=\"continuous\"><parent "
          "link=\"a\"/><child link=\"b\"/><limit velocity=\"1\"/></joint></robot>");
    write("envlib/o.mpo", "format = 1\n[volume]\nmsh = \"o.msh\"\nscale = 0.1\n");
    write("envlib/o.msh",
          "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n");
    write("envlib/o.hyper",
          "format = 1\n[[connection]]\nobject_a = \"o.mpo\"\npoint_a_m = [0, 0, 0]\npoint_b_m = [0, 0, 0]\n");
    write("robots/a.eds", "[x]\n");
    write("robots/a.dbc", "VERSION \"\"\n");
    write("scripts/s.spt", "#\n");
  }
  ~Home() {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }
  Home(const Home&) = delete;
  Home& operator=(const Home&) = delete;
  fs::path write(const char* name, std::string_view text) const {
    std::ofstream(root_ / name, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
    return root_ / name;
  }

 private:
  fs::path root_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  static const Home home;
  constexpr std::size_t kLargest = 16UL << 10U;
  if (size > kLargest) return 0;
  const fs::path file = home.write("cell.toml", {reinterpret_cast<const char*>(data), size});
  Diagnostics diagnostics;
  auto loaded = load_cell(file, diagnostics);
  CELLMIRROR_EXPECTS(loaded.has_value() == diagnostics.ok());
  if (!loaded) return 0;
  Cell& cell = loaded->cell;
  const auto paths = cell.paths(PathKind::any);
  constexpr std::size_t kMost = 40;
  for (std::size_t i = 0; i < paths.size() && i < kMost; ++i) {
    const std::string& path = paths[i];
    const std::string& other = paths[paths.size() - 1 - i];
    static_cast<void>(cell.level_down(path));
    static_cast<void>(cell.connect(path, other, cell.start_positions()));
    static_cast<void>(cell.swap_node(other));
    static_cast<void>(cell.deactivate(path));
    static_cast<void>(cell.delete_node(other));
    static_cast<void>(cell.activate(path));
    static_cast<void>(cell.level_up(path));
    CellPoses poses;
    compute_poses(*cell.compile(), cell.start_positions(), poses);
  }
  return 0;
}
