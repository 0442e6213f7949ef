#include "app/report/status_pictures.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "app/report/status_collisions.hpp"

namespace cellmirror::app {

nlohmann::json pictures_json(const RenderReport& report) {
  using nlohmann::json;
  json traces = json::array();
  for (const TraceSummary& trace : report.traces) {
    traces.push_back(
        {{"robot", trace.robot}, {"points", trace.points}, {"frames", trace.frames}, {"length_m", trace.length_m}});
  }
  constexpr Nanoseconds kMillisecond{1'000'000};
  return {{"on", report.on},
          {"renderer", report.renderer.empty() ? json(nullptr) : json(report.renderer)},
          {"problem", report.problem},
          {"rate_hz", report.rate_hz},
          {"size", {report.width, report.height}},
          {"streams", report.streams},
          {"updates", report.updates},
          {"drawn", report.drawn},
          {"unchanged", report.unchanged},
          {"on_demand", report.on_demand},
          {"in_haste", report.in_haste},
          {"failed", report.failed},
          {"bodies_drawn", report.counters.bodies_drawn},
          {"bodies_left_out", report.counters.bodies_left_out},
          {"meshes", report.counters.meshes},
          {"mesh_uploads", report.counters.uploads},
          {"textures", report.counters.textures},
          {"tissue_uploads", report.counters.tissue_uploads},
          {"texture_uploads", report.counters.texture_uploads},
          {"texture_bytes", report.counters.texture_bytes},
          {"volumes",
           {{"drawn", report.counters.volumes},
            {"bricks", report.counters.volume_bricks},
            {"bricks_drawn", report.counters.volume_bricks_drawn},
            {"reduction", report.counters.volume_reduction},
            {"in_haste", report.counters.volume_in_haste},
            {"cast_ms", static_cast<double>(report.counters.volume_ns) * 1e-6}}},
          {"traces", std::move(traces)},
          {"scene_ms", percentiles_json(report.scene, kMillisecond)},
          {"draw_ms", percentiles_json(report.draw, kMillisecond)},
          {"encode_ms", percentiles_json(report.encode, kMillisecond)},
          {"posture_age_ms", percentiles_json(report.age, kMillisecond)}};
}

}  // namespace cellmirror::app
