// Values of a topic over time as a figure.
#pragma once

#include <string>
#include <vector>

#include "app/plot/figure.hpp"
#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

inline constexpr std::size_t kMostPanels = 12;
inline constexpr std::size_t kMostLines = 32;  // of a panel

// A panel for each of `fields`, with a line for each value of that path ("depth_m", "position[2]") or below it
// ("position", "pose.position"); of a JointState also "position[JOINT]" and "position[ROBOT]", by the names of joints
// and of robots that our recordings have. Of more points than a picture can show the least and the greatest of each
// stretch of time are drawn. Times are seconds after the start of the recording. Fails where the topic is not there, a
// field names no number, or there are more panels or lines than above. Joints of a JointState are called by their
// names.
[[nodiscard]] Result<plot::Figure> recording_figure(mcap::Reader& reader, const std::string& topic,
                                                    const std::vector<std::string>& fields, mcap::Filter filter);

}  // namespace cellmirror::app
