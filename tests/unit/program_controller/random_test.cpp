// Random programs, random commands at random times, and comments that do anything: what must hold whatever happens.
#include <map>
#include <random>

#include "tests/unit/program_controller/cell_of_programs.hpp"

namespace cellmirror::program::test {
namespace {

using Kind = ProgramEvent::Kind;

class Chaos {
 public:
  explicit Chaos(std::uint32_t seed) : random_(seed) {
    cell_.look = 1 + number(10);
    cell_.scripts.answer = [this](std::string_view) { return answer(); };
    for (const char* robot : kRobots) {
      for (int i = 0; i < 4; ++i) load(robot, i);
    }
  }

  void act() {
    command();
    if (number(4) == 0) finish_activity();
    if (number(60) == 0) cell_.motion.block(robot());
    cell_.pass(0.001 * number(400));
    check_states();
  }

  void end() {
    ending_ = true;
    cell_.sut.stop_all();
    EXPECT_FALSE(cell_.sut.busy());
    cell_.pass(0.2);
    for (const char* id : kRobots) {
      const FakeMotion::Robot& robot = cell_.motion.robot(id);
      EXPECT_TRUE(robot.queue.empty());
      EXPECT_EQ(robot.wanted_pace, 1);
      EXPECT_EQ(robot.gate, 0U);
      EXPECT_FALSE(robot.X_PT);
      EXPECT_FALSE(cell_.sut.moves(id));
    }
    EXPECT_FALSE(cell_.sut.deadlock());
    check_events();
  }

 private:
  static constexpr std::array kRobots = {"A", "B", "C"};

  int number(int below) { return static_cast<int>(random_() % static_cast<std::uint32_t>(below)); }
  std::string robot() { return kRobots[static_cast<std::size_t>(number(3))]; }
  static std::string name(int i) { return "p" + std::to_string(i); }

  void load(const std::string& robot, int i) {
    ProgramMaker maker(name(i));
    const bool reversible = number(3) == 0;
    if (reversible) maker.reversible();
    const int length = 1 + number(20);
    for (int k = 0; k < length; ++k) reversible ? check_point(maker) : statement(maker);
    static_cast<void>(cell_.sut.load(robot, name(i), maker.make()));
  }

  void check_point(ProgramMaker& maker) {
    if (number(5) == 0) maker.script("S");
    if (number(5) == 0) maker.delay(0.1);
    maker.move(0.1 * number(20), number(2) == 0);
  }

  void statement(ProgramMaker& maker) {
    const std::string semaphore = "S" + std::to_string(number(3));
    switch (number(14)) {
      case 0:
        maker.delay(0.01 * number(30));
        return;
      case 1:
        maker.script("S");
        return;
      case 2:
        maker.out(1 + number(3), number(2) == 0);
        return;
      case 3:
        maker.acquire(semaphore);
        return;
      case 4:
        maker.release(semaphore);
        return;
      case 5:
        maker.wait_for_input(1, 0.2);
        return;
      case 6:
        maker.pause();
        return;
      case 7:
        maker.tool(Pose::Identity());
        return;
      case 8:
        if (number(4) == 0) maker.move(99);
        return;
      case 9:
        if (number(4) == 0) maker.divide_by_zero();
        return;
      default:
        maker.move(0.1 * number(20), number(2) == 0);
        return;
    }
  }

  Result<ActivityHandle> answer() {
    if (number(3) == 0) command();
    if (ending_ || number(4) != 0) return nullptr;
    if (number(5) == 0) return fail("refused");
    activities_.push_back(std::make_shared<Activity>());
    return activities_.back();
  }

  void finish_activity() {
    if (activities_.empty()) return;
    if (number(5) == 0) {
      activities_.front()->refuse({"refused later", {}});
    } else {
      activities_.front()->finish();
    }
    activities_.pop_front();
  }

  void command() {
    const std::string where = robot();
    const auto begin = number(2) == 0 ? Controllers::Begin::now : Controllers::Begin::exec_wait;
    switch (number(16)) {
      case 0:
        static_cast<void>(cell_.sut.stop(where));
        return;
      case 1:
      case 2:
        static_cast<void>(cell_.sut.hold(where));
        return;
      case 3:
      case 4:
      case 5:
        static_cast<void>(cell_.sut.resume(where));
        return;
      case 6:
      case 7:
        static_cast<void>(cell_.sut.step(where, number(2) == 0 ? Direction::forward : Direction::backward));
        return;
      case 8:
        static_cast<void>(cell_.sut.set_digital_input(where, 1, number(2) == 0));
        return;
      case 9:
        if (number(8) == 0) cell_.sut.cancel(where, {"gone", {}}, number(2) == 0);
        return;
      case 10:
        load(where, number(4));
        return;
      case 11:
        if (number(4) == 0) static_cast<void>(cell_.sut.remove(where, name(number(4))));
        return;
      case 12:
        static_cast<void>(cell_.sut.run(where, name(number(4)), begin, Direction::backward));
        return;
      default:
        static_cast<void>(cell_.sut.run(where, name(number(4)), begin));
        return;
    }
  }

  void check_states() {
    std::map<std::string, int> running;
    for (const ProgramStatus& status : cell_.sut.status()) {
      const bool runs = status.state == ProgramState::delayed || status.state == ProgramState::running ||
                        status.state == ProgramState::waiting || status.state == ProgramState::held;
      if (runs) {
        EXPECT_EQ(++running[status.robot], 1);
      }
      EXPECT_EQ(status.state == ProgramState::failed, !status.error.empty()) << status.name;
      EXPECT_GE(status.elapsed_s, 0);
      if (status.state == ProgramState::waiting) {
        EXPECT_FALSE(status.waits_for.empty());
      }
    }
    for (const char* id : kRobots) EXPECT_LE(cell_.motion.robot(id).most_ahead, 8U);
  }

  // Each run begins, has its commands, and ends once.
  void check_events() const {
    std::map<std::string, bool> runs;
    std::map<std::string, std::uint32_t> ticket;
    for (const ProgramEvent& event : cell_.events) {
      if (event.kind == Kind::deadlock) continue;
      const std::string who = event.robot + " " + event.program;
      const bool never_began = (event.kind == Kind::failed || event.kind == Kind::stopped) && !runs[who];
      if (never_began) continue;  // it was queued
      EXPECT_EQ(runs[who], event.kind != Kind::started) << who << " " << name_of(event.kind);
      if (event.kind == Kind::started) runs[who] = true;
      if (event.kind == Kind::ended || event.kind == Kind::stopped || event.kind == Kind::failed) runs[who] = false;
      if (event.kind == Kind::move_ended) {
        EXPECT_GT(event.ticket, ticket[event.robot]);
        ticket[event.robot] = event.ticket;
      }
    }
    for (const auto& [who, goes_on] : runs) EXPECT_FALSE(goes_on) << who;
  }

  std::mt19937 random_;
  CellOfPrograms cell_;
  std::deque<std::shared_ptr<Activity>> activities_;
  bool ending_ = false;
};

TEST(RandomPrograms, KeepTheirPromises) {
  for (std::uint32_t seed = 1; seed <= 40 && !::testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    for (int i = 0; i < 100; ++i) chaos.act();
    chaos.end();
  }
}

}  // namespace
}  // namespace cellmirror::program::test
