// cellmirror doctor: what this machine allows, and the command that fixes what it does not.
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"

#include "drivers/display/renderer.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/sandbox/child_process.hpp"
#include "ipc/sysv/limits.hpp"
#include "ipc/sysv/shared_memory_limits.hpp"
#include "ipc/web/web_server.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/rt/memory_lock.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

struct Finding {
  std::string name;
  std::string value;
  bool ok = true;
  std::string remedy;
};

constexpr int kPriority = 80;  // the default of the loop

Finding scheduling_finding() {
  const SchedulingOutcome outcome = probe_real_time_scheduling(kPriority);
  return {"SCHED_FIFO", outcome.ok ? "allowed" : outcome.why_not, outcome.ok, outcome.remedy};
}

Finding memory_finding() {
  const MemoryLockOutcome outcome = probe_memory_lock();
  return {"memory locking", outcome.ok ? "allowed" : outcome.why_not, outcome.ok, outcome.remedy};
}

Finding idle_finding() {
  const CpuLatencyRequest request(0);
  return {"/dev/cpu_dma_latency", request.ok() ? "allowed" : request.why_not(), request.ok(), request.remedy()};
}

Finding can_finding() {
  const Descriptor probe(socket(AF_CAN, SOCK_RAW | SOCK_CLOEXEC, 1));
  if (!probe.valid()) {
    return {"SocketCAN", std::strerror(errno), false,
            "modprobe can_raw; a kernel without CAN can still use the channels udp: and log:"};
  }
  return {"SocketCAN", "available", true, {}};
}

Finding interface_finding() {
  std::string names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/net", error)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("can") || name.starts_with("vcan") || name.starts_with("vxcan"))
      names += (names.empty() ? "" : " ") + name;
  }
  if (!names.empty()) return {"CAN interfaces", names, true, {}};
  return {"CAN interfaces", "none", false,
          "ip link add dev vcan0 type vcan && ip link set vcan0 up (a virtual one, for tests)"};
}

// DDS and udp streams of many robots need a receive buffer that outlasts the moments in which their thread waits.
Finding receive_buffer_finding() {
  constexpr std::uint64_t kWanted = std::uint64_t{4} << 20;
  std::uint64_t bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> bytes;
  return {"net.core.rmem_max", std::to_string(bytes) + " bytes", bytes >= kWanted,
          "sysctl -w net.core.rmem_max=" + std::to_string(kWanted) + " (matters for thousands of samples a second)"};
}

// Where a gateway without a name of its own serves its monitor page.
Finding page_finding() {
  const std::string name = "monitor page";
  if (web::port_is_free("127.0.0.1", web::kDefaultPort))
    return {name, "port " + std::to_string(web::kDefaultPort) + " is free", true, {}};
  const std::string in_use = "port " + std::to_string(web::kDefaultPort) + " is in use";
  const auto gateway = find_instance(kDefaultInstance);
  if (gateway) return {name, in_use + " while a gateway runs", true, {}};
  return {name, in_use + " by another program", false, "cellmirror run ... --port N, or [web] port in the cell file"};
}

// OSMesa draws the pictures; EGL takes its place where it is missing (drivers/display).
Finding renderer_finding(const char* name, display::Backend backend) {
  const auto renderer = display::Renderer::create({.backend = backend});
  if (renderer) return {name, std::string((*renderer)->name()), true, {}};
  return {name, renderer.error().what, false, renderer.error().remedy};
}

// The programs that cellmirror starts for files and networks; a half-done installation lacks some.
std::vector<Finding> confined_program_findings() {
  constexpr std::pair<const char*, std::string_view> kPrograms[] = {
      {"reader of meshes", "cellmirror-mesh-reader"},
      {"reader of DICOM slices", "cellmirror-volume-reader"},
      {"process for DDS", "cellmirror-dds"},
      {"process for MQTT", "cellmirror-mqtt"}};
  std::vector<Finding> findings;
  for (const auto& [name, program] : kPrograms) {
    const auto path = program_beside_this(program);
    const auto found = check_program(path);
    findings.push_back(found ? Finding{name, path.string(), true, {}}
                             : Finding{name, found.error().what, false, found.error().remedy});
  }
  return findings;
}

std::vector<Finding> examine() {
  std::vector<Finding> findings = {scheduling_finding(), memory_finding(),    idle_finding(),
                                   can_finding(),        interface_finding(), receive_buffer_finding()};
  const auto add = [&](const std::vector<IpcFinding>& more) {
    for (const IpcFinding& finding : more) {
      findings.push_back({finding.name, finding.value, finding.ok, finding.remedy});
    }
  };
  findings.push_back(page_finding());
  add(ipc_findings(read_sysv_limits(), read_remove_ipc()));
  add(shared_memory_findings(read_shared_memory_limits(), read_left_segments(::geteuid())));
  for (Finding& finding : confined_program_findings()) findings.push_back(std::move(finding));
  findings.push_back(renderer_finding("GL renderer", display::Backend::osmesa));
  findings.push_back(renderer_finding("GL renderer, instead", display::Backend::egl));
  return findings;
}

int doctor(bool json) {
  const std::vector<Finding> findings = examine();
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Finding& finding : findings) {
      list.push_back(
          {{"name", finding.name}, {"value", finding.value}, {"ok", finding.ok}, {"remedy", finding.remedy}});
    }
    std::printf("%s\n", nlohmann::json{{"findings", list}}.dump().c_str());
    return kExitDone;
  }
  for (const Finding& finding : findings) {
    std::printf("%-4s %-22s %s\n", finding.ok ? "ok" : "--", finding.name.c_str(), finding.value.c_str());
    if (!finding.ok && !finding.remedy.empty()) std::printf("     fix: %s\n", finding.remedy.c_str());
  }
  return kExitDone;
}

}  // namespace

void add_doctor(cli::Command program, Action& action) {
  auto json = std::make_shared<bool>(false);
  cli::Command sub = program.subcommand("doctor", "Check this machine for the gateway; findings have a remedy");
  sub.flag("--json", *json, "one JSON document");
  sub.when_named([json, &action] { action = [json] { return doctor(*json); }; });
}

}  // namespace cellmirror::app
