// Sends numbered joint states on one topic and waits for each number on another: the round trip through whatever joins
// the two. Prints medians and percentiles in microseconds.
//   dds_client DOMAIN SEND_TOPIC RECEIVE_TOPIC ROUNDS
#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "drivers/dds/dds_stream.hpp"
#include "drivers/dds/joint_state_publisher.hpp"

using namespace cellmirror;

namespace {

constexpr int kJoints = 7;

std::string joint_name(int i) { return "J_" + std::to_string(i + 1); }

// Numbers are positions: k milliradians.
class Awaited final : public JointSampleSink {
 public:
  bool push(const JointSample& sample) noexcept override {
    const std::scoped_lock lock(mutex_);
    newest_ = std::lround(sample.position[0] * 1e3);
    received_ = sample.receive_time;
    came_.notify_one();
    return true;
  }
  // When `number` came; never where it did not come in time.
  Timestamp wait_for(long number) {
    std::unique_lock lock(mutex_);
    const bool came = came_.wait_for(lock, std::chrono::milliseconds(200), [&] { return newest_ == number; });
    return came ? received_ : Timestamp{};
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  long newest_ = -1;
  Timestamp received_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: dds_client DOMAIN SEND_TOPIC RECEIVE_TOPIC ROUNDS\n");
    return 2;
  }
  const SystemClock clock;
  DdsStreamConfig config;
  config.domain = std::atoi(argv[1]);
  config.topic = argv[3];
  for (int i = 0; i < kJoints; ++i) config.joints.push_back({joint_name(i), static_cast<std::size_t>(i), 1.0, 0.0});
  auto stream = dds::make_dds_stream(config, clock);
  auto publisher = dds::JointStatePublisher::make({.domain = config.domain, .topic = argv[2]});
  Awaited awaited;
  if (!stream || !publisher || !(*stream)->open(awaited)) {
    std::fprintf(stderr, "dds_client: cannot set up\n");
    return 1;
  }
  dds::JointState message;
  for (int i = 0; i < kJoints; ++i) message.name.push_back(joint_name(i));
  message.position.assign(kJoints, 0.0);
  std::vector<double> us;
  long missed = 0;
  std::mt19937 chance(3);
  std::uniform_int_distribution<int> pause_us(3000, 7000);  // in no step with the loop
  const int rounds = std::atoi(argv[4]);
  constexpr int kWarmUp = 400;  // the peers find each other meanwhile
  for (int round = -kWarmUp; round < rounds; ++round) {
    const long number = 1 + (round + kWarmUp) % 1000;
    message.position.assign(kJoints, 1e-3 * static_cast<double>(number));
    const Timestamp sent = clock.now();
    (*publisher)->publish(message);
    const Timestamp received = round < 0 ? Timestamp{} : awaited.wait_for(number);
    if (round >= 0 && received.known()) us.push_back(1e-3 * static_cast<double>((received - sent).count()));
    if (round >= 0 && !received.known()) ++missed;
    std::this_thread::sleep_for(std::chrono::microseconds(pause_us(chance)));
  }
  (*stream)->close();
  if (us.empty()) {
    std::fprintf(stderr, "dds_client: nothing came back\n");
    return 1;
  }
  std::sort(us.begin(), us.end());
  const auto at = [&us](double p) { return us[static_cast<std::size_t>(p * static_cast<double>(us.size() - 1))]; };
  std::printf("{\"median_us\": %.1f, \"p99_us\": %.1f, \"missed\": %ld}\n", at(0.5), at(0.99), missed);
  return 0;
}
