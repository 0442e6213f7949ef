#include "ipc/sandbox/sandbox_report.hpp"

#include <utility>

namespace cellmirror {

namespace {

struct Registry {
  std::mutex mutex;
  std::vector<std::weak_ptr<SandboxRecord>> records;
};

// Never destroyed, since records of objects with static lifetime may outlive the objects of this file.
Registry& registry() {
  static auto* const registry = new Registry;
  return *registry;
}

}  // namespace

const char* words(SandboxState state) {
  switch (state) {
    case SandboxState::starting:
      return "starting";
    case SandboxState::running:
      return "running";
    case SandboxState::restarting:
      return "restarting";
    case SandboxState::stopped:
      return "stopped";
  }
  return "unknown";
}

std::shared_ptr<SandboxRecord> SandboxRecord::make(std::string program, std::string subject,
                                                   std::uint64_t memory_limit_bytes, std::string consequence) {
  SandboxReport report;
  report.program = std::move(program);
  report.subject = std::move(subject);
  report.memory_limit_bytes = memory_limit_bytes;
  report.consequence = std::move(consequence);
  std::shared_ptr<SandboxRecord> made(new SandboxRecord(std::move(report)));
  const std::scoped_lock lock(registry().mutex);
  std::erase_if(registry().records, [](const auto& record) { return record.expired(); });
  registry().records.push_back(made);
  return made;
}

SandboxReport SandboxRecord::report() const {
  const std::scoped_lock lock(mutex_);
  return report_;
}

void SandboxRecord::started(pid_t pid) {
  const std::scoped_lock lock(mutex_);
  report_.state = SandboxState::running;
  report_.pid = pid;
}

void SandboxRecord::measured(std::uint64_t memory_bytes, const ConfinementOutcome& confinement) {
  const std::scoped_lock lock(mutex_);
  report_.memory_bytes = memory_bytes;
  report_.confinement = confinement;
}

void SandboxRecord::ended(const std::string& why, bool again) {
  const std::scoped_lock lock(mutex_);
  report_.state = again ? SandboxState::restarting : SandboxState::stopped;
  report_.pid = 0;
  report_.memory_bytes = 0;
  report_.last_exit = why;
  if (again) ++report_.restarts;
}

void SandboxRecord::stopped() {
  const std::scoped_lock lock(mutex_);
  report_.state = SandboxState::stopped;
  report_.pid = 0;
  report_.memory_bytes = 0;
}

std::vector<SandboxReport> sandbox_reports() {
  std::vector<std::shared_ptr<SandboxRecord>> there;
  {
    const std::scoped_lock lock(registry().mutex);
    for (const auto& record : registry().records) {
      if (auto found = record.lock()) there.push_back(std::move(found));
    }
  }
  std::vector<SandboxReport> reports;
  for (const auto& record : there) reports.push_back(record->report());
  return reports;
}

}  // namespace cellmirror
