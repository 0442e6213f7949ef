// Publishes pictures as ROS 2's sensor_msgs/CompressedImage.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

// Fails as make_dds_output(), on whose participant it is. Whether the topic is switched off is the caller's to check.
// Publishing waits neither for the network nor for readers: a picture that nobody has taken is replaced by the next.
[[nodiscard]] Result<std::unique_ptr<ImageOutput>> make_image_output(const DdsOutputConfig& config);

}  // namespace cellmirror::dds
