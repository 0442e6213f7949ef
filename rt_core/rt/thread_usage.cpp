#include <fmt/core.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "rt_core/rt/cyclic_thread.hpp"

namespace cellmirror {

namespace {

std::optional<std::string> content(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return file ? std::optional(text.str()) : std::nullopt;
}

// "key:  123" in /proc/.../status.
std::optional<std::uint64_t> number_after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) {
    return std::nullopt;
  }
  std::istringstream rest(std::string(text.substr(at + key.size(), 40)));
  std::uint64_t number = 0;
  rest >> number;
  return rest ? std::optional(number) : std::nullopt;
}

}  // namespace

ThreadUsage operator-(const ThreadUsage& later, const ThreadUsage& earlier) {
  return ThreadUsage{.voluntary_switches = later.voluntary_switches - earlier.voluntary_switches,
                     .involuntary_switches = later.involuntary_switches - earlier.involuntary_switches,
                     .minor_faults = later.minor_faults - earlier.minor_faults,
                     .major_faults = later.major_faults - earlier.major_faults};
}

Result<ThreadUsage> thread_usage(pid_t tid) {
  const std::string folder = fmt::format("/proc/self/task/{}/", tid);
  const auto status = content(folder + "status");
  const auto stat = content(folder + "stat");
  if (!status || !stat) {
    return fail(fmt::format("there is no thread {} in this process, or /proc is not mounted", tid));
  }
  // The leading line end keeps the first key from matching within the second, "nonvoluntary_ctxt_switches".
  const auto voluntary = number_after(*status, "\nvoluntary_ctxt_switches:");
  const auto involuntary = number_after(*status, "\nnonvoluntary_ctxt_switches:");
  // proc(5), stat: "pid (comm) state ..."; comm may hold any character, so the fields are counted from its last
  // parenthesis: 3 state, ..., 10 minflt, 11 cminflt, 12 majflt.
  const std::size_t comm_end = stat->rfind(')');
  if (!voluntary || !involuntary || comm_end == std::string::npos) {
    return fail(fmt::format("{} does not have the format of proc(5)", folder));
  }
  std::istringstream fields(stat->substr(comm_end + 1));
  std::string skipped;
  for (int field = 3; field < 10; ++field) {
    fields >> skipped;
  }
  ThreadUsage usage{.voluntary_switches = *voluntary, .involuntary_switches = *involuntary};
  fields >> usage.minor_faults >> skipped >> usage.major_faults;
  if (!fields) {
    return fail(fmt::format("{}stat does not have the format of proc(5)", folder));
  }
  return usage;
}

}  // namespace cellmirror
