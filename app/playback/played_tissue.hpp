// The deformable objects of a recording that is played, put together again from its messages. Takes any bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/recording_layout/tissue_messages.hpp"
#include "app/snapshot/board.hpp"
#include "ipc/record/layout.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

// Whether the channel has messages for PlayedTissue.
[[nodiscard]] bool is_of_tissue(const mcap::Channel& channel);

// One thread, that of the player, but for view().
class PlayedTissue {
 public:
  static constexpr std::size_t kMostChannels = 128;

  // The objects as their files have them: how they look, and where they are while nothing else is known. Before any
  // other call; null: the cell has none.
  void set_rest(std::shared_ptr<const TissueView> rest) { rest_ = std::move(rest); }

  // What follows is of another time.
  void begin();
  // In the order of the file. Decodes nothing yet: a seek passes over most of them.
  void take(const mcap::Channel& channel, std::span<const std::byte> message);
  // Makes view() what was taken last. What is not sound is left out.
  void publish();

  // Any thread. Null: there are no deformable objects.
  [[nodiscard]] std::shared_ptr<const TissueView> view() const { return views_.latest(); }
  // Messages that were left out because they are not sound.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  struct Stream {
    std::vector<std::byte> shape;   // the newest message with one, not decoded yet
    std::vector<std::byte> newest;  // message of any kind, likewise
  };
  struct Surface : Stream {
    RecordedShape known;
    std::shared_ptr<const TissueSurface> shown;  // null: none yet
  };

  void update(Surface& surface);
  void update_effects();

  std::shared_ptr<const TissueView> rest_;
  std::map<std::string, Surface, std::less<>> surfaces_;  // by topic
  Stream effects_;
  RecordedClipShapes clip_shapes_;
  std::shared_ptr<const TissueView> shown_effects_;  // null: none yet
  bool changed_ = true;
  std::uint64_t step_ = 0;
  std::uint64_t refused_ = 0;
  Board<TissueView> views_;
};

}  // namespace cellmirror::app
