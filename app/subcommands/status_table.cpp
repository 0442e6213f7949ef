#include "app/subcommands/status_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/subcommands/status_table_controllers.hpp"
#include "app/subcommands/status_table_display.hpp"
#include "app/subcommands/status_table_forces.hpp"
#include "app/subcommands/status_table_haptics.hpp"
#include "app/subcommands/status_table_io.hpp"
#include "app/subcommands/status_table_pictures.hpp"
#include "app/subcommands/status_table_processes.hpp"
#include "app/subcommands/status_table_programs.hpp"
#include "app/subcommands/status_table_recordings.hpp"
#include "app/subcommands/status_table_sensing.hpp"
#include "app/subcommands/status_table_switches.hpp"
#include "app/subcommands/status_table_tissue.hpp"
#include "app/subcommands/status_table_volumes.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kCommandErrorsShown = 5;

class TableWriter {
 public:
  explicit TableWriter(bool colour) : colour_(colour) {}

  std::string write(const json& status) {
    write_head(status);
    write_problems(status);
    write_alarms(status);
    const auto replay = status.find("replay");
    if (replay != status.end() && replay->is_object()) {
      write_replay(*replay);
    } else {
      write_loop(status.at("loop"));
    }
    for (const json& robot : status.at("robots")) write_robot(robot);
    out_ += couplings_table(status);
    out_ += controllers_table(status);
    out_ += io_nodes_table(status);
    out_ += programs_table(status);
    out_ += sensing_table(status);
    out_ += forces_table(status);
    out_ += haptics_table(status);
    out_ += tissue_table(status);
    out_ += volumes_table(status);
    out_ += switches_table(status);
    out_ += display_table(status);
    out_ += pictures_table(status);
    out_ += recordings_table(status);
    out_ += processes_table(status);
    write_page(status);
    write_script(status);
    write_queues(status.at("queues"));
    return std::move(out_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    out_ += fmt::format(format, std::forward<Args>(args)...) + "\n";
  }

  // Clients of the Foxglove protocol; nothing where there were none.
  void write_live(const json& live) {
    const json& topics = live.at("topics");
    if (live.at("clients") == 0 && topics.empty()) return;
    std::string lost;
    for (const json& one : topics) {
      const auto dropped = one.at("dropped").get<std::uint64_t>();
      if (dropped > 0) lost += fmt::format(", {} left out {}", one.at("topic").get<std::string>(), dropped);
    }
    line("foxglove  {}, {}{}", number_of(live.at("clients").get<std::uint64_t>(), "client"),
         number_of(topics.size(), "topic"), lost);
  }

  void write_page(const json& status) {
    if (!status.contains("page")) return;  // an older gateway
    const json& page = status.at("page");
    if (!page.at("on").get<bool>()) return;
    if (page.at("address").is_null()) return line("{}", page.at("problem").get<std::string>());
    line("page      {}  {}, {} sent, {} refused{}", page.at("address").get<std::string>(),
         number_of(page.at("clients").get<std::uint64_t>(), "client"),
         number_of(page.at("pictures").get<std::uint64_t>(), "picture"), page.at("refused").get<std::uint64_t>(),
         page.at("read_only").get<bool>() ? ", read-only" : "");
    // An older gateway does not count them.
    if (const auto wrong = page.value("wrong_tokens", std::uint64_t{0}); wrong > 0) {
      line("          {}, {} more attempts refused without a check: see the log for their addresses",
           number_of(wrong, "wrong token"), page.value("unread_tokens", std::uint64_t{0}));
    }
    if (page.contains("foxglove")) write_live(page.at("foxglove"));
  }

  [[nodiscard]] std::string state(const std::string& word) const {
    if (!colour_ || word == "off" || word == "none") return word;
    if (word == "fresh") return "\x1b[32m" + word + "\x1b[0m";
    if (word == "stale") return "\x1b[33m" + word + "\x1b[0m";
    return "\x1b[31m" + word + "\x1b[0m";
  }

  static std::string age(const json& age_s) {
    if (!age_s.is_number()) return "-";
    const double value = age_s.get<double>();
    return value < 1.0 ? fmt::format("{:.0f} ms", value * 1e3) : fmt::format("{:.1f} s", value);
  }

  void write_head(const json& status) {
    line("cellmirror {}   cell {}   instance {}   up {:.0f} s", status.at("version").get<std::string>(),
         status.at("cell").get<std::string>(), status.at("instance").get<std::string>(),
         status.at("uptime_s").get<double>());
  }

  void write_problems(const json& status) {
    const json problems = status.value("problems", json::array());  // an older gateway has none
    for (const json& problem : problems) {
      const std::string text = "PROBLEM  " + problem.at("text").get<std::string>();
      line("{}", colour_ ? "\x1b[31m" + text + "\x1b[0m" : text);
    }
  }

  void write_alarms(const json& status) {
    const auto alarms = status.find("alarms");  // an older gateway has none
    if (alarms == status.end()) return;
    const auto waiting = alarms->at("unacknowledged").get<std::uint64_t>();
    const auto active = alarms->at("active").get<std::uint64_t>();
    if (waiting == 0 && active == 0) return;
    const json& newest = alarms->at("open").at(0);
    line("alarms    {} active, {} unacknowledged; newest: {} (ALARM_ACK acknowledges)", active, waiting,
         newest.at("text").get<std::string>());
  }

  // In place of the loop, which does not run.
  void write_replay(const json& replay) {
    line("replay    {}: {} at {}, {:.1f} of {:.1f} s, speed {:g}", replay.at("file").get<std::string>(),
         replay.at("state").get<std::string>(), replay.at("now").get<std::string>(),
         replay.at("position_s").get<double>(), replay.at("length_s").get<double>(), replay.at("speed").get<double>());
    if (const auto note = replay.at("note").get<std::string>(); !note.empty()) line("  note: {}", note);
  }

  void write_loop(const json& loop) {
    const json& wake = loop.at("wakeup_latency_us");
    const json& compute = loop.at("compute_us");
    line(
        "loop {:.0f} Hz, {}: {} ticks, {} missed; wake-up p50 {:.0f} p99 {:.0f} max {:.0f} us; tick p50 {:.0f} p99 "
        "{:.0f} us",
        loop.at("rate_hz").get<double>(), loop.at("scheduler").get<std::string>(),
        loop.at("ticks").get<std::uint64_t>(), loop.at("missed").get<std::uint64_t>(), wake.at("p50").get<double>(),
        wake.at("p99").get<double>(), wake.at("max").get<double>(), compute.at("p50").get<double>(),
        compute.at("p99").get<double>());
    for (const char* key : {"scheduler_note", "memory_note"}) {
      if (loop.contains(key) && !loop.at(key).get<std::string>().empty())
        line("  note: {}", loop.at(key).get<std::string>());
    }
    if (loop.at("faults").get<std::uint64_t>() > 0) line("  fault: {}", loop.at("last_fault").get<std::string>());
  }

  static std::string motion_text(const json& robot) {
    if (!robot.contains("motion") || !robot.at("motion").at("moving").get<bool>()) return {};
    const auto waiting = robot.at("motion").at("waiting").get<std::uint64_t>();
    return waiting == 0 ? " moving" : fmt::format(" moving, {} more", waiting);
  }

  void write_robot(const json& robot) {
    const json& stream = robot.at("stream");
    std::string marks;
    if (robot.at("active").get<bool>()) marks += " active";
    if (robot.at("sending").get<bool>()) marks += " sending";
    marks += motion_text(robot);
    line("");
    line("{}  {}{}", robot.at("id").get<std::string>(), robot.at("mode").get<std::string>(), marks);
    const bool mirrored = robot.at("mode").get<std::string>() == "mirrored";
    if (mirrored) {
      line("  {} {}: {}, age {}, {:.1f} Hz, {} received, {} lost, {} rejected; {}",
           stream.at("kind").get<std::string>(), stream.at("endpoint").get<std::string>(),
           state(stream.at("state").get<std::string>()), age(stream.at("age_s")), stream.at("rate_hz").get<double>(),
           stream.at("received").get<std::uint64_t>(), stream.at("lost").get<std::uint64_t>(),
           stream.at("rejected").get<std::uint64_t>(), stream.at("condition").get<std::string>());
      write_trouble(stream);
    }
    std::string joints;
    for (const json& joint : robot.at("joints")) joints += joint_text(joint, mirrored);
    line("  {}", joints);
  }

  // What is behind the counters: the newest error, and how the nodes of a bus are.
  void write_trouble(const json& stream) {
    const bool counted = stream.at("rejected").get<std::uint64_t>() + stream.at("lost").get<std::uint64_t>() > 0;
    if (!counted && stream.at("condition").get<std::string>() == "operational") return;
    const json details = stream.value("details", json::object());
    for (const auto& [key, value] : details.items()) {
      const bool of_node = key.starts_with("node ") || key.starts_with("last EMCY");
      if (of_node) line("    {}: {}", key, value.get<std::string>());
    }
    if (!counted) return;
    const json errors = stream.value("last_errors", json::array());
    const std::string newest =
        errors.empty() ? details.value("last channel error", std::string()) : errors.back().get<std::string>();
    if (!newest.empty()) line("    newest error: {}", newest);
  }

  // " (beyond -110 .. 110 deg)" of a joint that is; empty for the others and from an older gateway.
  static std::string beyond_text(const json& joint, bool angle) {
    if (!joint.value("beyond_range", false)) return {};
    const auto bound = [&](std::size_t i) {
      const double value = joint.at("range").at(i).get<double>();
      return angle ? deg_from_rad(value) : mm_from_m(value);
    };
    return fmt::format(" (beyond {:.6g} .. {:.6g} {})", bound(0), bound(1), angle ? "deg" : "mm");
  }

  [[nodiscard]] std::string joint_text(const json& joint, bool mirrored) const {
    const double position = joint.at("position").get<double>();
    const bool angle = joint.at("unit").get<std::string>() == "rad";
    const std::string value =
        angle ? fmt::format("{:.2f} deg", deg_from_rad(position)) : fmt::format("{:.1f} mm", mm_from_m(position));
    const std::string word = joint.at("state").get<std::string>();
    const bool remarkable = word == "stale" || word == "lost" || word == "invalid" || word == "implausible" ||
                            word == "conflict" || (mirrored && word == "none");
    return fmt::format("{} {}{}{}   ", joint.at("name").get<std::string>(), value,
                       remarkable ? " (" + state(word) + ")" : "", beyond_text(joint, angle));
  }

  void write_script(const json& status) {
    const json& script = status.at("script");
    line("");
    line("SCRIPT  {} received, {} done, {} refused, {} running, language {}",
         script.at("received").get<std::uint64_t>(), script.at("done").get<std::uint64_t>(),
         script.at("refused").get<std::uint64_t>(), number_of(script.at("running").get<std::uint64_t>(), "file"),
         script.at("language").get<std::string>());
    for (const json& run : script.value("runs", json::array())) {
      const json& stack = run.at("stack");
      std::string files;
      for (const json& file : stack) files += (files.empty() ? "" : " > ") + file.get<std::string>();
      line("  run {}: {}{}", run.at("id").get<std::uint64_t>(), files, run.at("waiting").get<bool>() ? ", waits" : "");
    }
    const json& errors = script.at("last_errors");
    const std::size_t first = errors.size() > kCommandErrorsShown ? errors.size() - kCommandErrorsShown : 0;
    for (std::size_t i = first; i < errors.size(); ++i) line("  {}", errors.at(i).get<std::string>());
    for (const json& message : status.at("messages")) {
      line("  message {} ago: {}", age(message.at("age_s")), message.at("text").get<std::string>());
    }
  }

  void write_queues(const json& queues) {
    std::string dropped;
    std::string unread;  // replaced without a reader: nobody has lost it
    for (const json& queue : queues) {
      const auto without_reader = queue.value("unread", std::uint64_t{0});
      const std::uint64_t count = queue.at("dropped").get<std::uint64_t>() - without_reader;
      const auto name = queue.at("name").get<std::string>();
      if (count > 0) dropped += fmt::format("{} {}   ", name, count);
      if (without_reader > 0) unread += fmt::format("; nobody reads {}, so new records replace old ones", name);
    }
    const std::string lost = dropped.empty() ? fmt::format("{}, nothing dropped", queues.size())
                                             : "dropped: " + std::string(trimmed(dropped));
    line("queues  {}{}", lost, unread);
  }

  bool colour_;
  std::string out_;
};

}  // namespace

Result<std::string> status_table(std::string_view text, bool colour) {
  try {
    return TableWriter(colour).write(json::parse(text));
  } catch (const json::exception& error) {
    return fail(fmt::format("the gateway's status cannot be read: {}", error.what()),
                "gateway and this program may be of different versions");
  }
}

}  // namespace cellmirror::app
