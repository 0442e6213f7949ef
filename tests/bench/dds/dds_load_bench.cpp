// What the gateway's DDS side costs and loses under many robots: dds_load in another process, one stream a robot here.
//   dds_load_bench [SECONDS=10] [TOPICS=1] [burst]
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/dds/dds_stream.hpp"
#include "own_network.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::dds;

constexpr int kRobots = 32;
constexpr int kJoints = 7;

class CountingSink final : public JointSampleSink {
 public:
  bool push(const JointSample& sample) noexcept override {
    count.fetch_add(1, std::memory_order_relaxed);
    const std::int64_t age_ns = (sample.receive_time - sample.source_time).count();
    if (age_ns > oldest_ns.load(std::memory_order_relaxed)) oldest_ns.store(age_ns, std::memory_order_relaxed);
    return true;
  }
  std::atomic<std::uint64_t> count{0};
  std::atomic<std::int64_t> oldest_ns{0};
};

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

pid_t start_load(int domain, const std::string& seconds, const std::string& topics, bool burst, int& output) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "dds_load";
  const std::string in_domain = std::to_string(domain);
  int ends[2];
  if (pipe(ends) != 0) return -1;
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], STDOUT_FILENO);
    execl(program.c_str(), program.c_str(), "--domain", in_domain.c_str(), "--seconds", seconds.c_str(), "--topics",
          topics.c_str(), burst ? "--burst" : nullptr, nullptr);
    _exit(127);
  }
  close(ends[1]);
  output = ends[0];
  return pid;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string seconds = argc > 1 ? argv[1] : "10";
  const std::string topics = argc > 2 ? argv[2] : "1";
  const bool burst = argc > 3;
  const int topic_count = std::atoi(topics.c_str());
  test::enter_own_network();
  const int domain = test::test_domain(7);

  SystemClock clock;
  std::vector<std::unique_ptr<CountingSink>> sinks;
  std::vector<std::unique_ptr<JointStream>> streams;
  for (int r = 0; r < kRobots; ++r) {
    DdsStreamConfig config;
    config.domain = domain;
    if (topic_count > 1) config.topic = "rt/robot_" + std::to_string(r % topic_count) + "/joint_states";
    for (int j = 0; j < kJoints; ++j) {
      config.joints.push_back(
          {"robot_" + std::to_string(r) + "/joint_" + std::to_string(j), static_cast<std::size_t>(j), 1.0, 0.0});
    }
    sinks.push_back(std::make_unique<CountingSink>());
    streams.push_back(make_dds_stream(config, clock).value());
    if (!streams.back()->open(*sinks.back())) return 1;
  }
  int output = -1;
  const double cpu_before = cpu_seconds();
  const pid_t load = start_load(domain, seconds, topics, burst, output);
  char line[128] = {};
  if (read(output, line, sizeof line - 1) <= 0) return 1;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const double cpu = cpu_seconds() - cpu_before;
  unsigned long long sent = 0;
  unsigned long long refused = 0;
  double took_s = 0;
  std::sscanf(line, "%llu %llu %lf", &sent, &refused, &took_s);
  waitpid(load, nullptr, 0);

  std::uint64_t received = 0;
  std::uint64_t lost = 0;
  std::uint64_t rejected = 0;
  std::int64_t oldest_ns = 0;
  for (int r = 0; r < kRobots; ++r) {
    const auto i = static_cast<std::size_t>(r);
    received += sinks[i]->count;
    oldest_ns = std::max(oldest_ns, sinks[i]->oldest_ns.load());
    lost += streams[i]->status().lost;
    rejected += streams[i]->status().rejected;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%d robots of %d joints, %s topic(s)%s: sent %llu (%.0f/s, %llu refused), received %llu, lost %llu, "
      "rejected %llu, oldest at arrival %.2f ms, %.1f %% of a core, %ld MB\n",
      kRobots, kJoints, topics.c_str(), burst ? ", in bursts" : "", sent, static_cast<double>(sent) / took_s, refused,
      static_cast<unsigned long long>(received), static_cast<unsigned long long>(lost),
      static_cast<unsigned long long>(rejected), 1e-6 * static_cast<double>(oldest_ns), 100.0 * cpu / took_s,
      usage.ru_maxrss / 1024);
  return received == sent ? 0 : 1;
}
