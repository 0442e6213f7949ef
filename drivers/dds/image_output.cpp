#include "drivers/dds/image_output.hpp"

#include <fmt/core.h>

#include <utility>

#include "drivers/dds/image_message.hpp"
#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/message/dds_message.hpp"

namespace cellmirror::dds {

namespace {

// The newest pictures are of use, older ones are not.
constexpr CountingWriter::Options kNewest{.depth = 2, .counts_overwritten = true, .large = true};
constexpr std::size_t kMostBytes = kMaxPayloadBytes - 1024;  // beside the header

class PictureOutput final : public ImageOutput {
 public:
  PictureOutput(const DdsOutputConfig& config, std::unique_ptr<CountingWriter> writer)
      : name_(fmt::format("dds pictures {}", config.pictures.topic)), writer_(std::move(writer)) {
    message_.header.frame_id = config.pictures.camera;
    if (config.pictures.camera.empty())
      message_.header.frame_id = config.pictures.view ? fmt::format("view_{}", *config.pictures.view) : "display";
  }

  [[nodiscard]] bool watched() const override { return writer_->readers() > 0; }

  void publish_image(const EncodedImage& picture) override {
    if (picture.bytes.size() > kMostBytes) {
      too_large_.add();
      return;
    }
    message_.header.stamp = ros_time(to_wall_clock_ns(picture.posture_time));
    message_.format = picture.format == ImageFormat::jpeg ? "jpeg" : "png";
    message_.data = picture.bytes;
    encode(message_, writer_->payload());
    message_.data = {};
    writer_->write();
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override {
    return {{"sent", writer_->sent()},
            {"dropped", writer_->dropped() + too_large_.get()},
            {"too_large", too_large_.get()},
            {"readers", writer_->readers()}};
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::string name_;
  std::unique_ptr<CountingWriter> writer_;
  CompressedImage message_;
  Counter too_large_;
};

}  // namespace

Result<std::unique_ptr<ImageOutput>> make_image_output(const DdsOutputConfig& config) {
  auto participant = Participant::shared(config.domain, config.interface_address, config.security, config.partition);
  if (!participant) return std::unexpected(participant.error());
  auto writer = CountingWriter::make(*participant, config.pictures.topic, kCompressedImageType, kNewest);
  if (!writer) return std::unexpected(writer.error());
  return std::make_unique<PictureOutput>(config, std::move(*writer));
}

}  // namespace cellmirror::dds
