// Pictures on DDS, where the cell file wants them.
#pragma once

#include <vector>

#include "app/render/render_service.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

Result<std::vector<RenderService::Output>> make_picture_outputs(const DdsOutputConfig& config);

}  // namespace cellmirror::app
