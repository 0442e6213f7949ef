// Any bytes as the description (instance.json) of a gateway that runs: its data, or a reason.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "ipc/control/instance.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

// This process is the gateway "fuzz", in a runtime folder of its own.
class Claimed {
 public:
  Claimed() {
    std::string pattern = (std::filesystem::temp_directory_path() / "cellmirror-fuzz-XXXXXX").string();
    CELLMIRROR_EXPECTS(mkdtemp(pattern.data()) != nullptr);
    root_ = pattern;
    setenv("CELLMIRROR_RUNTIME_DIR", root_.c_str(), 1);
    auto claimed = Instance::claim({.name = "fuzz", .pid = getpid(), .cell = "cell.toml", .queues = {}});
    CELLMIRROR_EXPECTS(claimed.has_value());
    file_ = claimed->folder() / "instance.json";
    instance_ = std::make_unique<Instance>(std::move(*claimed));
    CELLMIRROR_EXPECTS(find_instance("fuzz")->cell == "cell.toml");
  }
  ~Claimed() {
    instance_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  Claimed(const Claimed&) = delete;
  Claimed& operator=(const Claimed&) = delete;

  void describe(const std::uint8_t* data, std::size_t size) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }

 private:
  std::filesystem::path root_;
  std::filesystem::path file_;
  std::unique_ptr<Instance> instance_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Claimed claimed;
  claimed.describe(data, size);
  const auto found = find_instance("fuzz");
  if (!found) CELLMIRROR_EXPECTS(!found.error().what.empty() && !found.error().remedy.empty());
  return 0;
}
