// The description of the robots for programs that draw them themselves.
#pragma once

#include <string>

namespace cellmirror {

// Receives it outside the tick, once it has changed. One calling thread (the publisher).
class DescriptionOutput {
 public:
  virtual ~DescriptionOutput() = default;
  // `urdf`: one robot of all frames that are published, from the link "world" on (app/snapshot/robot_description.hpp).
  virtual void publish_description(const std::string& urdf) = 0;
};

}  // namespace cellmirror
