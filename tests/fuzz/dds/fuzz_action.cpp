// Any bytes as the requests of an action, with and without a header in front, and a book of goals that they are put to:
// it never holds more than it says, answers each question once, and forgets nothing that runs. A reply repeats the
// header.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drivers/dds/controller_messages.hpp"
#include "drivers/dds/goal_book.hpp"
#include "drivers/dds/service_mapping.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::dds;

void require(bool condition) {
  if (!condition) std::abort();
}

// The first byte of each step says what is done, the second to which of a few goals.
void use_book(std::span<const std::uint8_t> steps) {
  GoalBook book;
  for (std::size_t i = 0; i + 1 < steps.size(); i += 2) {
    GoalId id{};
    id[0] = static_cast<std::uint8_t>(steps[i + 1] % 48);
    const RequestName from{{{}, static_cast<std::int64_t>(i)}};
    switch (steps[i] % 6) {
      case 0:
        book.ask(id, from, {static_cast<std::int32_t>(i), 0});
        break;
      case 1:
      case 2:
        if (book.answer(id, steps[i] % 6 == 1)) require(!book.answer(id, true));
        break;
      case 3:
        for (const GoalInfo& goal : book.cancel({id, {static_cast<std::int32_t>(steps[i + 1]), 0}}).goals)
          require(goal.status == GoalStatus::canceling);
        break;
      case 4:
        static_cast<void>(book.result_of(id, from));
        break;
      default:
        if (const auto finished = book.finish(id, {GoalEnd::succeeded, 0, {}})) {
          require(finished->waiting.size() <= GoalBook::kMostWaiting);
          require(book.result_of(id, from)->status == GoalStatus::succeeded);
        }
        break;
    }
    require(book.status().size() <= GoalBook::kMostGoals);
  }
}

void read_contents(const CdrReader& content) {
  GoalRequest goal;
  if (decode(content, goal) == CdrFault::none) {
    require(goal.trajectory.joints.size() <= kMaxTrajectoryJoints);
    require(goal.trajectory.points.size() <= kMaxTrajectoryPoints);
    require(goal.goal.path.size() <= 4 * kMaxTrajectoryJoints && goal.goal.goal.size() <= 4 * kMaxTrajectoryJoints);
  }
  CancelRequest cancel;
  static_cast<void>(decode(content, cancel));
  GoalId id{};
  static_cast<void>(decode(content, id));
}

void reply_to(const RequestName& name) {
  std::vector<std::byte> payload;
  CdrWriter out(payload);
  begin_reply(name, out);
  write_result_reply(GoalStatus::succeeded, {GoalEnd::succeeded, 0, "text"}, out);
  end_reply(out);
  const auto again =
      open_request({.payload = payload, .name = name.sample, .announces_client = name.header.has_value()});
  require(again.has_value() && again->name == name);
}

void take_request(std::span<const std::byte> payload, bool announces_client) {
  const auto request = open_request({.payload = payload, .name = {}, .announces_client = announces_client});
  require(request.has_value() || announces_client);
  if (!request) return;
  require(request->name.header.has_value() == announces_client);
  read_contents(request->content);
  reply_to(request->name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> payload(reinterpret_cast<const std::byte*>(data), size);
  take_request(payload, false);
  take_request(payload, true);
  const auto client = client_id({reinterpret_cast<const char*>(data), size});
  require(!client || client->size() <= kMostClientId);
  use_book({data, size});
  return 0;
}
