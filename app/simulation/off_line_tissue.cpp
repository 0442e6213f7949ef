#include "app/simulation/off_line_tissue.hpp"

#include <bit>
#include <utility>

#include "rt_core/tissue/body/element_kernel.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kStep{1'000'000};

// FNV-1a over the bits of what moves, so that two runs can be compared.
class Digest {
 public:
  void add(float value) {
    for (auto bits = std::bit_cast<std::uint32_t>(value), i = 0U; i < 4U; ++i, bits >>= 8U) {
      hash_ = (hash_ ^ (bits & 0xFFU)) * 0x100000001B3U;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

std::uint64_t digest_of(const tissue::World& world) {
  TissueView view;
  world.view(view, true);
  Digest digest;
  for (const TissueSurface& surface : view.surfaces) {
    for (const Eigen::Vector3f& v : surface.vertices) {
      for (const float coordinate : v) digest.add(coordinate);
    }
    for (const float burn : surface.burn) digest.add(burn);
  }
  for (const Eigen::Vector3f& node : view.network.nodes) {
    for (const float coordinate : node) digest.add(coordinate);
  }
  for (const float height : view.pool.heights_m) digest.add(height);
  digest.add(static_cast<float>(view.pool.level_m));
  return digest.value();
}

}  // namespace

Result<std::unique_ptr<OffLineTissue>> OffLineTissue::make(const TissueSetup& setup, Timestamp begin) {
  if (setup.objects.empty()) return nullptr;
  Result<tissue::World> world = tissue::World::make(setup.objects, setup.connections);
  if (!world) return std::unexpected(world.error());
  return std::make_unique<OffLineTissue>(*std::move(world), begin);
}

OffLineTissue::OffLineTissue(tissue::World world, Timestamp begin)
    : stepper_(std::move(world), std::make_shared<geometry::SolidLibrary>()), begin_(begin), next_(begin + kStep) {}

Result<void> OffLineTissue::request(std::vector<tissue::Command> commands) {
  for (const tissue::Command& command : commands) stepper_.world().apply(command);
  return {};
}

void OffLineTissue::observe(const CellState& cell_state, const engine::TickState& tick) {
  for (; next_ <= tick.time; next_ = next_ + kStep) {
    if (!stepper_.step(cell_state, tick)) continue;
    ++summary_.steps;
    keep_events();
  }
}

void OffLineTissue::keep_events() {
  for (const TissueEvent& event : stepper_.world().events()) {
    if (summary_.events.size() == kMostKeptTissueEvents) {
      ++summary_.more_events;
      continue;
    }
    summary_.events.push_back({seconds(event.time - begin_), event});
  }
}

void OffLineTissue::finish(TissueSummary& summary) const {
  summary = summary_;
  summary.simd = tissue::simd_target();
  stepper_.world().describe(summary.state);
  summary.digest = digest_of(stepper_.world());
}

}  // namespace cellmirror::app
