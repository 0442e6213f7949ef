// Gives deformable objects to the recordings that want them: the surface of each when it has moved, at a bounded rate,
// what is beside surfaces, and surfaces as markers for people's tools.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/recorder/recording_hub.hpp"
#include "app/recorder/topic.hpp"
#include "app/recording_layout/tissue_messages.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_sources.hpp"
#include "drivers/dds/tissue_markers.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// The recorder's thread.
class TissueRecorder {
 public:
  // Does nothing where `sources` is empty. `hub` outlives it.
  TissueRecorder(TissueSources sources, RecordingHub& hub);

  // `cell`: the names of the robots; null: events are not recorded.
  void look(Timestamp now, const CellState* cell = nullptr);
  // To be called while nothing is recorded: the next recording starts with the shapes and with later events.
  void forget();

 private:
  // What was written last of a surface, or of all clips.
  struct Written {
    TopicPtr topic;
    std::vector<std::shared_ptr<const void>> shape;  // held, so that no other gets the same address
    std::uint32_t revision = 0;
    Timestamp with_shape;           // when it was written with its shape; never: it is due
    std::vector<std::byte> moving;  // the last message without a shape
  };

  void record_events(const CellState& cell);
  // The next message of each surface has its shape, for the start of a file. Events go on.
  void repeat_shapes();
  [[nodiscard]] bool wanted() const;
  // Whether the shape is due: it has changed, is that of another file, or was written too long ago.
  bool take_shape(Written& written, std::vector<std::shared_ptr<const void>> shape, Timestamp now) const;
  void record_surface(const TissueSurface& surface, TissueHead head, Timestamp now, std::int64_t wall_ns);
  void record_effects(const TissueView& view, TissueHead head, Timestamp now, std::int64_t wall_ns);
  void record_markers(const TissueView& view, Timestamp now, std::int64_t wall_ns);

  TissueSources sources_;
  RecordingHub& hub_;
  std::map<std::string, Written, std::less<>> surfaces_;  // by object
  Written effects_;
  TopicPtr events_topic_;
  std::optional<std::uint64_t> newest_event_;  // none: earlier events do not belong to the recording
  TopicPtr markers_topic_;
  dds::TissueMarkers markers_;
  dds::MarkerArray marker_message_;
  std::vector<std::byte> bytes_;
  Timestamp last_look_;
  Timestamp last_markers_;
  Timestamp last_shapes_;  // of any object
  std::uint64_t last_step_ = 0;
  std::uint64_t files_ = 0;
};

}  // namespace cellmirror::app
