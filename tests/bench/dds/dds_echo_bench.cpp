// DDS sample in to DDS sample out: through the gateway's reader, routing and output, and through a bare Fast DDS echo,
// interleaved sample by sample in one run. The echoes are processes of their own. Round trips, in microseconds.
//   dds_echo_bench [ROUNDS=5000] [PERIOD_US=1000]
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bare_fastdds.hpp"
#include "drivers/dds/dds_output.hpp"
#include "drivers/dds/dds_stream.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "own_network.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::dds;
using namespace cellmirror::dds::bench;
using SteadyClock = std::chrono::steady_clock;

constexpr int kJoints = 7;

std::string joint_name(int i) { return "joint_" + std::to_string(i); }

// The gateway's path without its tick: what arrives is published at once.
class EchoingSink final : public JointSampleSink {
 public:
  explicit EchoingSink(RobotStateOutput& output) : output_(output), robots_(1) {
    robots_[0].id = "echo";
    robots_[0].joints.resize(kJoints);
    for (int i = 0; i < kJoints; ++i) robots_[0].joints[static_cast<std::size_t>(i)].name = joint_name(i);
  }
  bool push(const JointSample& sample) noexcept override {
    for (std::size_t i = 0; i < kJoints; ++i) robots_[0].joints[i].position = sample.position[i];
    output_.publish(sample.receive_time, robots_, {});
    return true;
  }

 private:
  RobotStateOutput& output_;
  std::vector<RobotState> robots_;
};

// Until SIGTERM, so that the library can clear its shared memory away.
void wait_for_the_end() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  int number = 0;
  sigwait(&set, &number);
}

void serve_gateway(int domain) {
  static SystemClock clock;
  DdsOutputConfig out;
  out.domain = domain;
  out.joint_states_topic = "rt/pong_gateway";
  out.rate_hz = 1000;
  const auto output = make_dds_output(out).value();
  EchoingSink sink(*output);
  DdsStreamConfig in;
  in.domain = domain;
  in.topic = "rt/ping_gateway";
  for (int i = 0; i < kJoints; ++i) in.joints.push_back({joint_name(i), static_cast<std::size_t>(i), 1.0, 0.0});
  const auto stream = make_dds_stream(in, clock).value();
  if (!stream->open(sink)) std::exit(1);
  wait_for_the_end();
}

void serve_bare(int domain, bool shared_memory, const std::string& name) {
  const BareEndpoint echo(domain, shared_memory, "rt/ping_" + name, "rt/pong_" + name,
                          [](BareEndpoint& self, BytesSample& sample) { self.write(sample); });
  wait_for_the_end();
}

// The same way for all: pinger on the first core, echoes on the second. Left to itself the scheduler keeps each process
// where it once put it, which makes one echo's round trip half as long again as another's.
void run_on_core(unsigned core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core % std::thread::hardware_concurrency(), &set);
  sched_setaffinity(0, sizeof set, &set);
}

template <class Serve>
pid_t start(Serve serve) {
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    run_on_core(1);
    serve();
    std::exit(0);
  }
  return pid;
}

// Sends and waits for what comes back.
class Pinger {
 public:
  Pinger(int domain, bool shared_memory, std::string name)
      : name_(std::move(name)),
        endpoint_(domain, shared_memory, "rt/pong_" + name_, "rt/ping_" + name_,
                  [this](BareEndpoint&, BytesSample& sample) { receive(sample); }) {
    for (int i = 0; i < kJoints; ++i) message_.name.push_back(joint_name(i));
    message_.position.assign(kJoints, 0.0);
    message_.velocity.assign(kJoints, 0.0);
    message_.effort.assign(kJoints, 0.0);
  }

  [[nodiscard]] bool matched() const { return endpoint_.matched(); }
  [[nodiscard]] const std::string& name() const { return name_; }
  void round() {
    message_.position[0] = ++sent_;
    encode(message_, sample_.payload);
    std::unique_lock lock(mutex_);
    const auto begin = SteadyClock::now();
    lock.unlock();
    endpoint_.write(sample_);
    lock.lock();
    if (!came_.wait_for(lock, std::chrono::milliseconds(100), [&] { return received_ == sent_; })) {
      ++missed_;
      return;
    }
    round_trips_us_.push_back(std::chrono::duration<double, std::micro>(received_at_ - begin).count());
  }
  [[nodiscard]] double quantile_us(double q) {
    if (round_trips_us_.empty()) return 0;
    std::sort(round_trips_us_.begin(), round_trips_us_.end());
    return round_trips_us_[static_cast<std::size_t>(q * static_cast<double>(round_trips_us_.size() - 1))];
  }
  [[nodiscard]] int missed() const { return missed_; }
  void forget() {
    round_trips_us_.clear();
    missed_ = 0;
  }

 private:
  void receive(const BytesSample& sample) {
    const auto now = SteadyClock::now();
    if (decode(sample.payload, answer_) != CdrFault::none || answer_.position.empty()) return;
    const std::scoped_lock lock(mutex_);
    received_ = answer_.position[0];
    received_at_ = now;
    came_.notify_one();
  }

  std::string name_;
  JointState message_;
  BytesSample sample_;
  JointStateView answer_;
  std::mutex mutex_;
  std::condition_variable came_;
  double sent_ = 0;
  double received_ = 0;
  SteadyClock::time_point received_at_;
  std::vector<double> round_trips_us_;
  int missed_ = 0;
  BareEndpoint endpoint_;  // last: its thread uses what stands above
};

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5000;
  const std::chrono::microseconds period(argc > 2 ? std::atoi(argv[2]) : 1000);
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);  // before threads and echoes start
  test::enter_own_network();
  const int domain = test::test_domain(6);
  const std::vector<pid_t> echoes = {
      start([=] { serve_bare(domain, false, "bare_udp"); }),
      start([=] { serve_bare(domain, true, "bare_shared_memory"); }),
      start([=] { serve_gateway(domain); }),
  };
  run_on_core(0);
  int failed = 0;
  {
    std::vector<std::unique_ptr<Pinger>> pingers;
    pingers.push_back(std::make_unique<Pinger>(domain, false, "bare_udp"));
    pingers.push_back(std::make_unique<Pinger>(domain, true, "bare_shared_memory"));
    pingers.push_back(std::make_unique<Pinger>(domain, false, "gateway"));
    const auto patience = SteadyClock::now() + std::chrono::seconds(20);
    for (const auto& pinger : pingers) {
      while (!pinger->matched() && SteadyClock::now() < patience) std::this_thread::sleep_for(period);
      if (!pinger->matched()) failed = 1;
    }
    for (int i = 0; i < rounds + 200 && failed == 0; ++i) {
      for (const auto& pinger : pingers) {
        if (i == 200) pinger->forget();  // warm from here on
        pinger->round();
        std::this_thread::sleep_for(period);
      }
    }
    for (const auto& pinger : pingers) {
      std::printf("%-20s median %7.1f us  p99 %7.1f us  missed %d of %d\n", pinger->name().c_str(),
                  pinger->quantile_us(0.5), pinger->quantile_us(0.99), pinger->missed(), rounds);
    }
    if (failed == 0) {
      std::printf("gateway / bare_udp (medians): %.3f\n", pingers[2]->quantile_us(0.5) / pingers[0]->quantile_us(0.5));
      std::printf("gateway / bare_shared_memory (medians): %.3f\n",
                  pingers[2]->quantile_us(0.5) / pingers[1]->quantile_us(0.5));
    } else {
      std::fprintf(stderr, "dds_echo_bench: an echo was not found\n");
    }
  }
  for (const pid_t pid : echoes) kill(pid, SIGTERM);
  for (const pid_t pid : echoes) waitpid(pid, nullptr, 0);
  return failed;
}
