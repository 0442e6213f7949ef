#include "app/gateway/picture_outputs.hpp"

#include <utility>

#include "drivers/dds/image_output.hpp"

namespace cellmirror::app {

Result<std::vector<RenderService::Output>> make_picture_outputs(const DdsOutputConfig& config) {
  std::vector<RenderService::Output> outputs;
  if (!config.enabled || config.pictures.topic.empty()) return outputs;
  auto output = dds::make_image_output(config);
  if (!output) return std::unexpected(output.error());
  PictureRequest request;
  request.view = config.pictures.view;
  if (!config.pictures.camera.empty()) request.camera = config.pictures.camera;
  request.width = config.pictures.width;
  request.height = config.pictures.height;
  request.rate_hz = config.pictures.rate_hz;
  request.quality = config.pictures.quality;
  outputs.push_back({std::move(*output), std::move(request)});
  return outputs;
}

}  // namespace cellmirror::app
