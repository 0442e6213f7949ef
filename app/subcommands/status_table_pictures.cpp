#include "app/subcommands/status_table_pictures.hpp"

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/counted.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {

using nlohmann::json;

std::string pictures_table(const json& status) {
  if (!status.contains("pictures")) return {};
  const json& pictures = status.at("pictures");
  const std::string problem = pictures.at("problem").get<std::string>();
  if (!pictures.at("renderer").is_string() && problem.empty()) return {};
  const auto pair = [&](const char* key) {
    const json& times = pictures.at(key);
    return fmt::format("p50 {} p99 {} ms", milliseconds(times.at("p50"), 1), milliseconds(times.at("p99"), 1));
  };
  std::string out = "\npictures  ";
  if (pictures.at("renderer").is_string()) {
    out +=
        fmt::format("{}: {}, {} drawn ({} on demand, {} in haste), {} unchanged; drawn in {}, encoded in {}, age {}\n",
                    pictures.at("renderer").get<std::string>(), number_of(count(pictures.at("streams")), "stream"),
                    count(pictures.at("drawn")), count(pictures.at("on_demand")), count(pictures.at("in_haste")),
                    count(pictures.at("unchanged")), pair("draw_ms"), pair("encode_ms"), pair("posture_age_ms"));
  } else {
    out += "none\n";
  }
  if (!problem.empty()) out += fmt::format("  problem: {}\n", problem);
  return out;
}

}  // namespace cellmirror::app
