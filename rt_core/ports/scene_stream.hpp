// The cell for clients that draw it themselves: its geometry once, then poses and marks. Between the gateway and its
// clients. Plain data and one interface. Formats: docs/monitor-page.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// All bodies as a glTF 2.0 binary file (.glb). Immutable once shared.
struct SceneGeometry {
  std::string glb;
  std::uint64_t hash = 0;  // of the content: the same file, the same number
};

// Immutable once shared.
struct SceneUpdate {
  std::uint64_t sequence = 0;  // grows, not by one
  Timestamp posture_time;
  std::uint64_t geometry_hash = 0;           // of the file whose nodes the poses belong to
  std::string poses;                         // the message behind its head: counts, then numbers
  std::uint64_t marks_sequence = 0;          // another one where `marks` changed
  std::shared_ptr<const std::string> marks;  // JSON: words and what changes seldom; never null
  // Whole binary messages; null where there is no deformable object.
  std::uint32_t tissue_number = 0;  // another one where `tissue_shape` changed; 0: there is none
  std::shared_ptr<const std::string> tissue_shape;
  std::shared_ptr<const std::string> tissue_motion;
};

// A stream for one client. Any thread.
class SceneStream {
 public:
  virtual ~SceneStream() = default;  // ends the stream
  // The newest update, unless its sequence is `has`; null: there is none yet. Never waits. Nothing is made for clients
  // that do not ask for a second.
  [[nodiscard]] virtual std::shared_ptr<const SceneUpdate> newest(std::uint64_t has) const = 0;
};

using GeometryReply = std::function<void(Result<std::shared_ptr<const SceneGeometry>>)>;

}  // namespace cellmirror
