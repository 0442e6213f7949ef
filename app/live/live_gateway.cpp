#include "app/live/live_gateway.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/live/asset.hpp"
#include "app/snapshot/robot_description.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kLoopRate = "/cellmirror/loop_rate_hz";
constexpr std::string_view kLiveRate = "/cellmirror/live_rate_hz";
constexpr std::string_view kWarningDistance = "/cellmirror/warning_distance_m";
constexpr std::string_view kDescription = "/robot_description";
constexpr double kLowestRate_hz = 0.1;
constexpr double kLongestDistance_m = 100;  // as SET_COLLPAR warning

}  // namespace

std::string LiveGateway::description() {
  const std::shared_ptr<const CellState> cell_state = parts_.board->latest();
  if (!cell_state || !cell_state->cell) return {};
  const std::scoped_lock lock(mutex_);
  if (described_ == cell_state->cell) return description_;
  const std::vector<bool> all(cell_state->cell->robots.size(), true);
  description_ = robot_description(*cell_state->cell, all,
                                   [this](std::string_view file) { return asset_uri(*parts_.home, file); });
  described_ = cell_state->cell;
  return description_;
}

std::vector<foxglove::Parameter> LiveGateway::parameters() {
  std::vector<foxglove::Parameter> out = {{std::string(kLoopRate), parts_.loop_rate_hz},
                                          {std::string(kLiveRate), parts_.topics->wanted_rate_hz()}};
  const std::shared_ptr<const CellState> cell_state = parts_.board->latest();
  if (cell_state && cell_state->collision)
    out.push_back({std::string(kWarningDistance), cell_state->collision->warning_distance_m});
  out.push_back({std::string(kDescription), description()});
  return out;
}

void LiveGateway::set_parameter(const foxglove::Parameter& parameter, const web::CommandOrigin& origin,
                                std::function<void(const Result<void>&)> reply) {
  const double* value = std::get_if<double>(&parameter.value);
  const auto within = [&](double least, double most) {
    return value != nullptr && std::isfinite(*value) && *value >= least && *value <= most;
  };
  if (parameter.name == kLiveRate) {
    if (!within(kLowestRate_hz, parts_.loop_rate_hz))
      return reply(fail(fmt::format("it is no number from {} to {}", kLowestRate_hz, parts_.loop_rate_hz)));
    parts_.topics->set_rate_hz(*value);
    return reply({});
  }
  if (parameter.name == kWarningDistance) {
    if (!within(0, kLongestDistance_m))
      return reply(fail(fmt::format("it is no number from 0 to {}", kLongestDistance_m)));
    constexpr double kMillimetres = 1000;
    return parts_.execute(fmt::format("SET_COLLPAR warning {:.6f}", kMillimetres * *value), origin,
                          [reply = std::move(reply)](const web::CommandReply& done) {
                            reply(done.done ? Result<void>() : fail(done.text));
                          });
  }
  reply(fail("it cannot be set", fmt::format("parameters that can be: {}, {}", kLiveRate, kWarningDistance)));
}

Result<std::string> LiveGateway::asset(std::string_view uri) {
  if (uri == kDescriptionUri) return description();
  return read_asset(*parts_.home, uri, web::kMaxAssetBytes);
}

}  // namespace cellmirror::app
