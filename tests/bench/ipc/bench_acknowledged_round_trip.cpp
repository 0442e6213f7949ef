// A command by message and its acknowledgement (client -> receiver thread -> executing thread -> client) against a bare
// msgsnd/msgrcv ping-pong between two processes, in turns in one run. Client and servers are bound to different
// processors, where there are two: left alone, the scheduler now and then puts one of the two pairs on a single
// processor, which makes it five times as fast and says nothing about the other. Prints medians, 99th percentiles and
// the ratio; fails where the ratio of the medians is above the goal.
//   ipc_bench_acknowledged_round_trip [ROUNDS] [GOAL]
#include <sched.h>
#include <signal.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ipc/sysv/script_client.hpp"
#include "ipc/sysv/script_message_receiver.hpp"
#include "tests/unit/ipc/temporary_folder.hpp"

namespace {

using namespace cellmirror;
using SteadyClock = std::chrono::steady_clock;

constexpr std::string_view kCommand = "POS_ROB PUMA_762 JOINT_INC 5";
constexpr int kWarmUp = 200;

struct Message {
  long type;
  char text[512];
};

// Gives every message back, like the plainest server.
[[noreturn]] void echo_for_ever(int to_server, int to_client) {
  Message message;
  while (true) {
    const ssize_t got = ::msgrcv(to_server, &message, sizeof message.text, 0, 0);
    if (got < 0 || ::msgsnd(to_client, &message, static_cast<std::size_t>(got), 0) != 0) _exit(0);
  }
}

// Receives on one thread and executes on another, as the gateway does.
[[noreturn]] void serve_for_ever(const QueueConfig& queues, int ready) {
  std::mutex mutex;
  std::condition_variable came;
  std::deque<ScriptMessage> waiting;
  ScriptMessageReceiver receiver(queues, "bench");
  const auto started = receiver.start([&](ScriptMessage message) {
    const std::lock_guard guard(mutex);
    waiting.push_back(std::move(message));
    came.notify_one();
  });
  if (!started || ::write(ready, "y", 1) != 1) _exit(1);
  while (true) {
    std::unique_lock lock(mutex);
    came.wait(lock, [&] { return !waiting.empty(); });
    const ScriptMessage message = std::move(waiting.front());
    waiting.pop_front();
    lock.unlock();
    receiver.reply(message.tag, {true, ""});
  }
}

constexpr int kClientCpu = 0;
constexpr int kServerCpu = 1;

void bind_to(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (::sched_setaffinity(0, sizeof set, &set) != 0) {
    std::fprintf(stderr, "not bound to processor %d: it will vary from run to run\n", cpu);
  }
}

double microseconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::micro>(SteadyClock::now() - start).count();
}

double quantile(std::vector<double>& values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

bool measure(int rounds, int to_server, int to_client, const QueueConfig& queues, std::vector<double>& bare,
             std::vector<double>& acknowledged) {
  for (int i = -kWarmUp; i < rounds; ++i) {
    Message message;
    message.type = 5;
    std::memcpy(message.text, kCommand.data(), kCommand.size());
    auto start = SteadyClock::now();
    if (::msgsnd(to_server, &message, kCommand.size(), 0) != 0) return false;
    if (::msgrcv(to_client, &message, sizeof message.text, 0, 0) < 0) return false;
    const double bare_us = microseconds_since(start);
    start = SteadyClock::now();
    const auto reply = send_command(queues, kCommand, Nanoseconds{5'000'000'000});
    const double acknowledged_us = microseconds_since(start);
    if (!reply || !reply->done) return false;
    if (i < 0) continue;
    bare.push_back(bare_us);
    acknowledged.push_back(acknowledged_us);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5000;
  const double goal = argc > 2 ? std::atof(argv[2]) : 3.0;
  if (rounds < 1) return 2;
  const test::PrivateRuntimeFolder runtime_folder;
  [[maybe_unused]] const int own_namespace = ::unshare(CLONE_NEWIPC);
  QueueConfig queues;
  queues.script_key = 0x7200'0000 + (::getpid() % 0x10000) * 4;
  queues.sensor_key = queues.script_key + 1;
  queues.reply_key = queues.script_key + 2;

  const int to_server = ::msgget(IPC_PRIVATE, IPC_CREAT | 0600);
  const int to_client = ::msgget(IPC_PRIVATE, IPC_CREAT | 0600);
  const pid_t echo = ::fork();
  if (echo == 0) {
    bind_to(kServerCpu);
    echo_for_ever(to_server, to_client);
  }
  int ready[2];
  if (::pipe(ready) != 0) return 1;
  const pid_t server = ::fork();
  if (server == 0) {
    bind_to(kServerCpu);
    serve_for_ever(queues, ready[1]);
  }
  bind_to(kClientCpu);
  char ok = 'n';
  std::vector<double> bare;
  std::vector<double> acknowledged;
  const bool measured =
      ::read(ready[0], &ok, 1) == 1 && measure(rounds, to_server, to_client, queues, bare, acknowledged);

  ::msgctl(to_server, IPC_RMID, nullptr);
  ::msgctl(to_client, IPC_RMID, nullptr);
  ::kill(server, SIGKILL);
  ::waitpid(server, nullptr, 0);
  ::waitpid(echo, nullptr, 0);
  for (const std::int32_t key : {queues.script_key, queues.reply_key}) {
    const int id = ::msgget(key, 0);
    if (id >= 0) ::msgctl(id, IPC_RMID, nullptr);
    const int semaphore = ::semget(key, 1, 0);
    if (semaphore >= 0) ::semctl(semaphore, 0, IPC_RMID);
  }
  if (!measured) {
    std::fprintf(stderr, "ipc_bench_acknowledged_round_trip: no measurement\n");
    return 1;
  }
  const double bare_median = quantile(bare, 0.5);
  const double acknowledged_median = quantile(acknowledged, 0.5);
  std::printf("bare ping-pong:         median %.1f us, p99 %.1f us\n", bare_median, quantile(bare, 0.99));
  std::printf("acknowledged command:   median %.1f us, p99 %.1f us\n", acknowledged_median,
              quantile(acknowledged, 0.99));
  std::printf("ratio of the medians:   %.2f (goal: at most %.2f), %d rounds in turns\n",
              acknowledged_median / bare_median, goal, rounds);
  return acknowledged_median / bare_median <= goal ? 0 : 1;
}
