#include "ipc/sysv/limits.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>

#include "ipc/sysv/system_file.hpp"
#include "ipc/wire/record.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {
namespace {

constexpr std::size_t kMostLines = 10'000;  // of a system file; more are not read

std::uint64_t lines_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::uint64_t lines = 0;
  std::string line;
  while (lines < 10 * kMostLines && std::getline(in, line)) ++lines;
  return lines;
}

// systemd.syntax(7): 1, yes, true, on and their opposites; "y", "t" and the like too.
std::optional<bool> boolean(std::string_view text) {
  for (const auto* yes : {"1", "yes", "y", "true", "t", "on"}) {
    if (equal_ignoring_case(text, yes)) return true;
  }
  for (const auto* no : {"0", "no", "n", "false", "f", "off"}) {
    if (equal_ignoring_case(text, no)) return false;
  }
  return std::nullopt;
}

// The last RemoveIPC= in section [Login]; none where the file says nothing or gives it back to the default.
void read_login_section(const std::filesystem::path& file, RemoveIpc& setting) {
  std::ifstream in(file);
  std::string line;
  bool in_login = false;
  for (std::size_t i = 0; i < kMostLines && std::getline(in, line); ++i) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#' || text.front() == ';') continue;
    if (text.front() == '[') {
      in_login = text == "[Login]";
      continue;
    }
    const auto equals = text.find('=');
    if (!in_login || equals == std::string_view::npos || trimmed(text.substr(0, equals)) != "RemoveIPC") continue;
    if (const auto value = boolean(trimmed(text.substr(equals + 1)))) {
      setting.enabled = *value;
      setting.set_by = file.native();
    }
  }
}

// Drop-in files by name; of two with the same name, the one in the earlier folder counts (systemd's precedence).
std::map<std::string, std::filesystem::path> drop_ins(const std::filesystem::path& root) {
  std::map<std::string, std::filesystem::path> files;
  for (const auto* folder : {"etc/systemd/logind.conf.d", "run/systemd/logind.conf.d",
                             "usr/local/lib/systemd/logind.conf.d", "usr/lib/systemd/logind.conf.d"}) {
    std::error_code ignored;
    for (std::filesystem::directory_iterator at(root / folder, ignored), end; !ignored && at != end;
         at.increment(ignored)) {
      if (at->path().extension() == ".conf") files.try_emplace(at->path().filename().native(), at->path());
    }
  }
  return files;
}

}  // namespace

SysvLimits read_sysv_limits(const std::filesystem::path& root) {
  SysvLimits limits;
  limits.max_message_bytes = number_in(root / "proc/sys/kernel/msgmax");
  limits.max_queue_bytes = number_in(root / "proc/sys/kernel/msgmnb");
  limits.max_queues = number_in(root / "proc/sys/kernel/msgmni");
  const std::uint64_t lines = lines_in(root / "proc/sysvipc/msg");
  limits.queues_in_use = lines > 0 ? lines - 1 : 0;  // the first is a heading
  return limits;
}

RemoveIpc read_remove_ipc(const std::filesystem::path& root) {
  constexpr uid_t kFirstOrdinaryUser = 1000;
  RemoveIpc setting;
  std::error_code ignored;
  for (const auto* file : {"usr/lib/systemd/logind.conf", "etc/systemd/logind.conf"}) {
    read_login_section(root / file, setting);
  }
  for (const auto& [name, file] : drop_ins(root)) read_login_section(file, setting);
  // logind keeps one folder for its users there while it runs.
  setting.logind_runs = std::filesystem::exists(root / "run/systemd/users", ignored);
  setting.concerns_us = setting.enabled && setting.logind_runs && ::geteuid() >= kFirstOrdinaryUser;
  return setting;
}

std::vector<IpcFinding> ipc_findings(const SysvLimits& limits, const RemoveIpc& remove_ipc) {
  std::vector<IpcFinding> findings;
  const auto limit = [&](std::string name, std::uint64_t value, std::uint64_t least, const char* what) {
    const bool ok = value >= least;
    findings.push_back({name, value == 0 ? "unknown" : fmt::format("{} {}", value, what), ok,
                        ok ? "" : fmt::format("sysctl -w kernel.{}={}", name, least)});
  };
  limit("msgmax", limits.max_message_bytes, kMaxRecordBytes, "bytes per message");
  limit("msgmnb", limits.max_queue_bytes, 2 * kMaxRecordBytes, "bytes per queue");
  // The three queues of one gateway.
  limit("msgmni", limits.max_queues, limits.queues_in_use + 3, "queues");
  const std::string source = remove_ipc.set_by.empty() ? "default" : remove_ipc.set_by;
  std::string value = fmt::format("{} ({})", remove_ipc.enabled ? "yes" : "no", source);
  if (!remove_ipc.logind_runs) value += ", logind is not running";
  findings.push_back({"RemoveIPC", std::move(value), !remove_ipc.concerns_us,
                      remove_ipc.concerns_us
                          ? "printf '[Login]\\nRemoveIPC=no\\n' > /etc/systemd/logind.conf.d/cellmirror.conf && "
                            "systemctl restart systemd-logind, or run the gateway as a system user"
                          : ""});
  return findings;
}

}  // namespace cellmirror
