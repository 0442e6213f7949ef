#include "drivers/dds/image_reader.hpp"

#include <algorithm>
#include <utility>

#include "drivers/dds/image_message.hpp"
#include "drivers/dds/internal/bytes_reader.hpp"

namespace cellmirror::dds {

namespace {

class BytesImageReader final : public ImageReader {
 public:
  explicit BytesImageReader(std::unique_ptr<BytesReader> reader) : reader_(std::move(reader)) {}
  [[nodiscard]] std::size_t writers() const override {
    return static_cast<std::size_t>(std::max(reader_->matched_writers(), 0));
  }

 private:
  std::unique_ptr<BytesReader> reader_;
};

}  // namespace

Result<std::unique_ptr<ImageReader>> ImageReader::open(const ImageReaderConfig& config, const Clock& clock,
                                                       Receive receive) {
  auto participant = Participant::shared(config.domain, config.interface_address, config.security, config.partition);
  if (!participant) return std::unexpected(participant.error());
  // Best effort matches every publisher; only the newest picture is of use.
  auto reader = BytesReader::make(*participant, {.topic = config.topic, .type = kCompressedImageType},
                                  [&clock, receive = std::move(receive)](const ReceivedSample& sample) {
                                    CompressedImageView message;
                                    if (decode(sample.payload, message) != CdrFault::none) return;
                                    receive(message.data, clock.now());
                                  });
  if (!reader) return std::unexpected(reader.error());
  return std::make_unique<BytesImageReader>(std::move(*reader));
}

}  // namespace cellmirror::dds
