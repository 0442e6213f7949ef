#include "scripts/programs/controller/controllers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scripts/programs/controller/virtual_controller.hpp"

namespace cellmirror::program {

namespace {

constexpr std::size_t kLongestName = 255;
// Of programs that hand semaphores to each other; more wait for the next turn.
constexpr int kRounds = 64;

template <class Do>
Result<void> with(const Result<VirtualController*>& controller, Do&& what) {
  if (!controller) return std::unexpected(controller.error());
  return what(**controller);
}

}  // namespace

Controllers::Controllers(ProgramMotion& motion, ProgramScripts& scripts, const Clock& clock)
    : context_{motion, scripts, clock, {}, {}, 0, {}, {}} {}

Controllers::~Controllers() = default;

Result<VirtualController*> Controllers::open(std::string_view robot) {
  if (const auto found = robots_.find(robot); found != robots_.end()) return found->second.get();
  if (context_.motion.joint_kinds(robot).empty()) {
    return fail(fmt::format("{} is not a robot with joints", robot), "`cellmirror status` lists the robots");
  }
  auto made = std::make_shared<VirtualController>(context_, std::string(robot));
  return robots_.emplace(std::string(robot), std::move(made)).first->second.get();
}

Result<VirtualController*> Controllers::find(std::string_view robot) const {
  if (const auto found = robots_.find(robot); found != robots_.end()) return found->second.get();
  return fail(fmt::format("no program is loaded for {}", robot), fmt::format("TF_LOAD <program> {}", robot));
}

Result<void> Controllers::load(std::string_view robot, std::string_view name, std::shared_ptr<const Program> program) {
  if (name.empty() || name.size() > kLongestName) return fail("the name of the program is empty or too long");
  auto opened = open(robot);
  if (!opened) return std::unexpected(std::move(opened.error()));
  VirtualController& controller = **opened;
  if (auto fit = controller.check_load(name, *program); !fit) return fit;
  const auto known = controller.programs().find(name);
  const std::shared_ptr<LoadedProgram> replaced = known == controller.programs().end() ? nullptr : known->second;
  const Semaphores before = context_.semaphores;
  if (replaced) set_back_semaphores(*replaced);
  if (auto declared = declare_semaphores(*program); !declared) {
    context_.semaphores = before;
    return declared;
  }
  controller.put(name, std::move(program));
  alone_since_ = {};
  recheck_deadlock();
  return {};
}

Result<void> Controllers::declare_semaphores(const Program& program) {
  for (const SemaphoreDeclaration& declaration : program.semaphores) {
    if (auto declared = context_.semaphores.declare(declaration.name, declaration.initial); !declared) {
      declared.error().what = Diagnostic{
          Severity::error,
          {program.file, static_cast<int>(declaration.line), 0},
          declared.error().what,
          {}}.text();
      return declared;
    }
  }
  return {};
}

bool Controllers::used(std::string_view semaphore, const LoadedProgram& except, bool by_occupied_ones) const {
  for (const auto& [id, controller] : robots_) {
    for (const auto& [name, program] : controller->programs()) {
      if (program.get() == &except || !program->uses(semaphore)) continue;
      if (!by_occupied_ones || controller->occupied(*program)) return true;
    }
  }
  return false;
}

// For a program being unloaded: its own semaphores are deleted, those that no running program uses are reset, so that a
// stopped script can be repeated.
void Controllers::set_back_semaphores(const LoadedProgram& gone) {
  for (const std::string& semaphore : gone.used) {
    if (!used(semaphore, gone, false)) {
      context_.semaphores.forget(semaphore);
    } else if (!used(semaphore, gone, true)) {
      context_.semaphores.reset(semaphore);
    }
  }
}

Result<void> Controllers::run(std::string_view robot, std::string_view name, Begin begin, Direction direction) {
  const Result<void> begun = with(find(robot), [&](VirtualController& controller) {
    return controller.run(name, begin == Begin::exec_wait, direction);
  });
  alone_since_ = {};
  recheck_deadlock();
  return begun;
}

Result<void> Controllers::remove(std::string_view robot, std::string_view name) {
  auto controller = find(robot);
  if (!controller) return std::unexpected(std::move(controller.error()));
  auto removed = (*controller)->remove(name);
  if (!removed) return std::unexpected(std::move(removed.error()));
  for (const std::string& semaphore : (*removed)->used) {
    if (!used(semaphore, **removed, false)) context_.semaphores.forget(semaphore);
  }
  recheck_deadlock();
  return {};
}

Result<void> Controllers::hold(std::string_view robot) {
  return with(find(robot), [](VirtualController& controller) { return controller.hold(); });
}

Result<void> Controllers::resume(std::string_view robot) {
  return with(find(robot), [](VirtualController& controller) { return controller.resume(); });
}

Result<void> Controllers::step(std::string_view robot, Direction direction) {
  return with(find(robot), [direction](VirtualController& controller) { return controller.step(direction); });
}

Result<void> Controllers::stop(std::string_view robot) {
  const Result<void> stopped = with(find(robot), [](VirtualController& controller) { return controller.stop(); });
  recheck_deadlock();
  return stopped;
}

void Controllers::stop_all() {
  for (const auto& controller : controllers()) {
    if (controller->busy()) static_cast<void>(controller->stop());
  }
  recheck_deadlock();
}

void Controllers::cancel(std::string_view robot, const Error& why, bool forget) {
  const auto found = robots_.find(robot);
  if (found == robots_.end()) return;
  const std::shared_ptr<VirtualController> controller = found->second;
  controller->cancel(why.text());
  if (forget) {
    robots_.erase(found);
    for (const auto& [name, program] : controller->programs()) {
      for (const std::string& semaphore : program->used) {
        if (!used(semaphore, *program, false)) context_.semaphores.forget(semaphore);
      }
    }
  }
  recheck_deadlock();
}

Result<SignalBoard*> Controllers::open_signals(std::string_view robot, std::size_t number) {
  if (number == 0 || number > kMostPorts) {
    return fail(fmt::format("there is no input {}", number), fmt::format("use 1 to {}", kMostPorts));
  }
  auto controller = open(robot);
  if (!controller) return std::unexpected(std::move(controller.error()));
  return &(*controller)->signals();
}

Result<void> Controllers::set_digital_input(std::string_view robot, std::size_t number, bool on) {
  auto signals = open_signals(robot, number);
  if (!signals) return std::unexpected(std::move(signals.error()));
  (*signals)->digital_inputs[number] = on;
  (*signals)->changed = context_.instant();
  return {};
}

Result<void> Controllers::set_analogue_input(std::string_view robot, std::size_t number, double value) {
  if (!std::isfinite(value)) return fail(fmt::format("the value of input {} is not a finite number", number));
  auto signals = open_signals(robot, number);
  if (!signals) return std::unexpected(std::move(signals.error()));
  (*signals)->analogue_inputs[number] = value;
  (*signals)->changed = context_.instant();
  return {};
}

const SignalBoard* Controllers::signals(std::string_view robot) const {
  const auto found = robots_.find(robot);
  return found == robots_.end() ? nullptr : &found->second->signals();
}

bool Controllers::busy() const {
  return std::any_of(robots_.begin(), robots_.end(), [](const auto& robot) { return robot.second->busy(); });
}

bool Controllers::busy(std::string_view robot) const {
  const auto found = robots_.find(robot);
  return found != robots_.end() && found->second->busy();
}

bool Controllers::waits_for_time() const {
  return std::any_of(robots_.begin(), robots_.end(), [](const auto& robot) {
    const ProgramRun* run = robot.second->run();
    return run != nullptr && run->waits_for_time();
  });
}

bool Controllers::moves(std::string_view robot) const {
  const auto found = robots_.find(robot);
  if (found == robots_.end() || found->second->run() == nullptr) return false;
  return !found->second->run()->has_lent_robot();
}

std::vector<ProgramStatus> Controllers::status() const {
  std::vector<ProgramStatus> statuses;
  for (const auto& [robot, controller] : robots_) controller->append_status(statuses);
  return statuses;
}

std::vector<std::shared_ptr<VirtualController>> Controllers::controllers() const {
  std::vector<std::shared_ptr<VirtualController>> all;
  for (const auto& [robot, controller] : robots_) all.push_back(controller);
  return all;
}

bool Controllers::follow() {
  if (following_) return false;  // a command of a program
  following_ = true;
  for (const auto& [robot, controller] : robots_) controller->begin_turn();
  bool any = false;
  for (int round = 0; round < kRounds && follow_once(); ++round) any = true;
  following_ = false;
  changed_ = changed_ || any;
  if (changed_ || alone_since_.known()) search_deadlock();
  changed_ = false;
  return any;
}

bool Controllers::follow_once() {
  bool any = false;
  for (const auto& controller : controllers()) {
    if (controller->follow()) any = true;
  }
  return serve_semaphores() || any;
}

// Served in the order in which the programs reached the semaphore.
bool Controllers::serve_semaphores() {
  std::vector<ProgramRun*> waiting;
  for (const auto& [robot, controller] : robots_) {
    ProgramRun* run = controller->run();
    if (run != nullptr && !run->wanted_semaphore().empty()) waiting.push_back(run);
  }
  std::sort(waiting.begin(), waiting.end(), [](const ProgramRun* a, const ProgramRun* b) {
    return std::pair(a->due(), std::string_view(a->robot())) < std::pair(b->due(), std::string_view(b->robot()));
  });
  bool any = false;
  for (ProgramRun* run : waiting) {
    const std::string semaphore(run->wanted_semaphore());
    if (!context_.semaphores.try_acquire(semaphore)) continue;
    run->grant(context_.semaphores.released(semaphore));
    any = true;
  }
  return any;
}

}  // namespace cellmirror::program
