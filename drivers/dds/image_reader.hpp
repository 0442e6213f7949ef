// Reads pictures of ROS 2's sensor_msgs/CompressedImage.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

struct ImageReaderConfig {
  int domain = 0;
  std::string interface_address = "127.0.0.1";
  std::string topic = "rt/cellmirror/picture/compressed";
  std::string partition = {};
  DdsSecurityConfig security = {};
};

class ImageReader {
 public:
  // With the bytes of a picture, whatever they are, valid during the call: by the thread of the participant's link, one
  // call at a time; must not wait. What is no such message is dropped.
  using Receive = std::function<void(std::span<const std::uint8_t> picture, Timestamp receive_time)>;

  // `clock` outlives the reader; after its end nothing is called.
  [[nodiscard]] static Result<std::unique_ptr<ImageReader>> open(const ImageReaderConfig& config, const Clock& clock,
                                                                 Receive receive);
  virtual ~ImageReader() = default;

  // Matched now. Any thread.
  [[nodiscard]] virtual std::size_t writers() const = 0;
};

}  // namespace cellmirror::dds
