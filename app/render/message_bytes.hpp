// Appends numbers as they lie in a binary message: little-endian; what is not finite becomes 0.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "rt_core/base/pose.hpp"

namespace cellmirror::app {

class MessageBytes {
 public:
  void put(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) text_ += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void put(std::uint16_t value) {
    text_ += static_cast<char>(static_cast<std::uint8_t>(value));
    text_ += static_cast<char>(static_cast<std::uint8_t>(value >> 8U));
  }
  void put(std::uint8_t value) { text_ += static_cast<char>(value); }
  void put(std::int8_t value) { text_ += static_cast<char>(value); }
  void put(float value) { put(std::bit_cast<std::uint32_t>(std::isfinite(value) ? value : 0.0F)); }
  void put(double value) { put(static_cast<float>(value)); }
  void put(const Eigen::Vector3d& vector) {
    for (int i = 0; i < 3; ++i) put(vector[i]);
  }
  void put(const Eigen::Vector3f& vector) {
    for (int i = 0; i < 3; ++i) put(vector[i]);
  }
  void put(const Pose& pose) {
    put(Eigen::Vector3d(pose.translation()));
    const Eigen::Quaterniond turn(pose.linear());
    for (const double value : {turn.x(), turn.y(), turn.z(), turn.w()}) put(value);
  }
  // Red in the lowest byte.
  void put(const std::array<float, 4>& colour) {
    std::uint32_t packed = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const float value = std::isfinite(colour[i]) ? std::clamp(colour[i], 0.0F, 1.0F) : 1.0F;
      packed |= static_cast<std::uint32_t>(std::lround(255.0F * value)) << (8 * i);
    }
    put(packed);
  }
  void put(std::string_view bytes) { text_ += bytes; }
  // Up to a multiple of 4 bytes.
  void align() { text_.resize((text_.size() + 3) / 4 * 4, '\0'); }
  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace cellmirror::app
