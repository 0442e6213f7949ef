#include "app/subcommands/status_table_processes.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

namespace cellmirror::app {

std::string processes_table(const nlohmann::json& status) {
  if (!status.contains("processes")) return {};  // an older gateway
  std::string out;
  for (const nlohmann::json& process : status.at("processes")) {
    out += fmt::format("{}  {}: {}", process.at("program").get<std::string>(), process.at("subject").get<std::string>(),
                       process.at("state").get<std::string>());
    if (process.at("pid").is_number())
      out += fmt::format(", pid {}, {:.0f} MB", process.at("pid").get<int>(),
                         1e-6 * static_cast<double>(process.at("memory_bytes").get<std::uint64_t>()));
    const nlohmann::json& confined = process.at("confined");
    if (process.at("pid").is_number() && !confined.at("system_calls").get<bool>())
      out += ", NOT confined: the kernel or the service manager refuses a filter of system calls";
    if (process.at("pid").is_number() && !confined.at("files").get<bool>())
      out += ", files not restricted: the kernel or the service manager refuses Landlock";
    if (const auto restarts = process.at("restarts").get<std::uint64_t>(); restarts > 0)
      out += fmt::format(", {} restart{}; the last one {}", restarts, restarts == 1 ? "" : "s",
                         process.at("last_exit").get<std::string>());
    out += "\n";
  }
  return out.empty() ? out : "\n" + out;
}

}  // namespace cellmirror::app
