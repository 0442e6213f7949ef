#include "app/wall/wall_memory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>

#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/home.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr int kFormat = 1;

std::string member_text(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_string()) return {};
  const auto& text = found->get_ref<const std::string&>();
  return text.size() <= kMostSummaryText ? text : std::string();
}

}  // namespace

std::string wall_memory_text(const std::vector<RememberedCell>& cells) {
  json list = json::array();
  for (const RememberedCell& cell : cells) {
    list.push_back({{"cell", cell.cell},
                    {"host", cell.host},
                    {"instance", cell.instance},
                    {"last_heard_ns", cell.last_heard_wall_ns}});
  }
  return json{{"format", kFormat}, {"cells", std::move(list)}}.dump(1, ' ', false, json::error_handler_t::replace) +
         "\n";
}

Result<std::vector<RememberedCell>> parse_wall_memory(std::string_view text) {
  const json document = json::parse(text, nullptr, false);
  const bool good = document.is_object() && document.contains("format") && document["format"] == kFormat &&
                    document.contains("cells") && document["cells"].is_array();
  if (!good) return fail("it is not what a wall has written");
  std::vector<RememberedCell> out;
  for (const json& one : document["cells"]) {
    if (out.size() >= kMostWallTiles) break;
    if (!one.is_object()) continue;
    const auto time = one.find("last_heard_ns");
    if (time == one.end() || !time->is_number_integer() || time->is_number_float()) continue;
    RememberedCell cell{member_text(one, "cell"), member_text(one, "host"), member_text(one, "instance"),
                        time->get<std::int64_t>()};
    if (cell.cell.empty() || cell.last_heard_wall_ns <= 0) continue;
    out.push_back(std::move(cell));
  }
  return out;
}

Result<std::vector<RememberedCell>> read_wall_memory(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::vector<RememberedCell>();
  const auto text = read_text_file(file, kLargestWallMemory);
  if (!text) return std::unexpected(text.error());
  auto cells = parse_wall_memory(*text);
  if (!cells)
    return fail(fmt::format("{}: {}", file.native(), cells.error().what),
                "name another file with --state, or remove this one");
  return cells;
}

Result<void> write_wall_memory(const std::filesystem::path& file, const std::vector<RememberedCell>& cells) {
  const std::string text = wall_memory_text(cells);
  const std::filesystem::path beside = file.native() + ".new";
  const auto failed = [&] {
    const int why = errno;
    ::unlink(beside.c_str());
    return fail(fmt::format("cannot write {}: {}", file.native(), system_error_text(why)),
                "name a file in a folder that can be written with --state");
  };
  {
    const Descriptor out(::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!out.valid() || ::write(out.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        ::fsync(out.get()) != 0)
      return failed();
  }
  if (::rename(beside.c_str(), file.c_str()) != 0) return failed();
  return {};
}

}  // namespace cellmirror::app
