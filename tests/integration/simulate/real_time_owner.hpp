// The owner of a cell and the tick in their threads, as in the gateway, without what is outside of it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "app/owner/cell_owner.hpp"
#include "config/cell_file.hpp"
#include "ipc/wire/script_message.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {

inline LoadedCell load_cell_for_test(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  auto cell = load_cell(file, diagnostics);
  EXPECT_TRUE(cell) << diagnostics.text();
  return std::move(*cell);
}

// The source folder; empty where the environment does not tell it.
inline std::filesystem::path source_folder() {
  const char* folder = std::getenv("CELLMIRROR_SOURCE_DIR");
  return folder == nullptr ? std::filesystem::path() : std::filesystem::path(folder);
}

using Reply = std::function<void(std::int64_t tag, const ScriptReply& reply)>;
using ProgramEvents = std::function<void(const program::ProgramEvent& event)>;

inline CellOwner::Parts owner_parts(LoadedCell loaded, engine::Engine& engine, Board<CellState>& board,
                                    const Clock& clock, ProgramEvents event) {
  return {.cell = std::move(loaded.cell),
          .home = loaded.home,
          .streams = {},
          .haptics = {},
          .views = {},
          .collision = {},
          .foot_switches = {},
          .engine = engine,
          .board = board,
          .clock = clock,
          .instance = {},
          .save_flight_record = [](std::string_view) -> Result<void> { return {}; },
          .program_event = std::move(event)};
}

class RealTimeOwner {
 public:
  RealTimeOwner(LoadedCell loaded, Reply reply, ProgramEvents event)
      : reply_(std::move(reply)), owner_(owner_parts(std::move(loaded), *engine_, board_, clock_, std::move(event))) {}
  ~RealTimeOwner() { stop(); }
  RealTimeOwner(const RealTimeOwner&) = delete;
  RealTimeOwner& operator=(const RealTimeOwner&) = delete;

  // Before start(): it waits in the queue, so that the owner executes what was put together in one turn.
  void put(std::int64_t tag, std::string text) {
    script::ScriptCommand command{
        .text = std::move(text), .source = script::CommandSource::page(), .reply = [this, tag](const auto& result) {
          reply_(tag, result ? ScriptReply{true, *result} : ScriptReply{false, result.error().text()});
        }};
    EXPECT_TRUE(owner_.offer(command));
  }
  // `script`: a path; empty: none.
  void start(const std::string& script) {
    EXPECT_TRUE(owner_.prepare(script, true));
    EXPECT_TRUE(loop_.start());
    owner_.start();
  }
  void stop() {
    owner_.stop();
    loop_.stop();
  }

 private:
  SystemClock clock_;
  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<engine::Engine> engine_ = std::make_unique<engine::Engine>(watchdog_);
  Board<CellState> board_;
  Reply reply_;
  CellOwner owner_;
  CyclicThread loop_{*engine_, {.name = "tick", .period = Nanoseconds(1'000'000), .policy = RealTimePolicy::prefer}};
};

// False: it did not come. How long it takes is the machine's affair.
inline bool await(const std::function<bool()>& condition) {
  constexpr std::chrono::seconds kObserverTimeout{120};
  const auto cancel = std::chrono::steady_clock::now() + kObserverTimeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > cancel) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace cellmirror::app
