// Any bytes as messages of deformable objects: the first byte chooses which, the second where the bytes are divided
// into two messages.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "app/playback/played_tissue.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

void expect_sound(const TissueView& view) {
  for (const TissueSurface& surface : view.surfaces) {
    CELLMIRROR_EXPECTS(surface.topology && surface.normals.size() == surface.vertices.size());
    for (const auto& triangle : surface.topology->triangles)
      for (const std::uint32_t corner : triangle) CELLMIRROR_EXPECTS(corner < surface.vertices.size());
    for (const Eigen::Vector3f& vertex : surface.vertices) CELLMIRROR_EXPECTS(vertex.allFinite());
  }
  for (const TissueClip& clip : view.clips) {
    CELLMIRROR_EXPECTS(clip.vertices && clip.triangles && clip.X_WC.matrix().allFinite());
    for (const auto& triangle : *clip.triangles)
      for (const std::uint32_t corner : triangle) CELLMIRROR_EXPECTS(corner < clip.vertices->size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const bool effects = (data[0] & 1U) != 0;
  mcap::Channel channel;
  channel.topic = std::string(effects ? app::kTissueEffectsTopic : app::kTissueTopics);
  channel.encoding = std::string(effects ? app::kTissueEffectsEncoding : app::kTissueEncoding);
  const auto bytes = std::as_bytes(std::span(data, size).subspan(2));
  const std::size_t first = bytes.size() * data[1] / 255;
  app::PlayedTissue tissue;
  for (const auto part : {bytes.first(first), bytes.subspan(first)}) {
    tissue.take(channel, part);
    tissue.publish();
    if (const auto view = tissue.view()) expect_sound(*view);
  }
  CELLMIRROR_EXPECTS(tissue.refused() <= 8);
  return 0;
}
