// What leaves the gateway as ROS 2 messages on DDS: robot states (sensor_msgs/JointState), frames (tf2_msgs/TFMessage),
// forces at TCPs (geometry_msgs/WrenchStamped), ultrasonic ranges (sensor_msgs/Range), what touches and what is near
// (diagnostic_msgs/DiagnosticArray, visualization_msgs/MarkerArray), deformable objects
// (visualization_msgs/MarkerArray), the description of the robots (std_msgs/String with a URDF).
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/description_output.hpp"
#include "rt_core/ports/force_state.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror::dds {

// All publishing by one thread. The send mode of ranges is the SENSOR channel's: here each sensor has its topic. With
// the ranges the sensors' frames are published on the topic of frames. Values that are not finite are left out and
// counted.
class DdsOutput : public RobotStateOutput,
                  public FindingsOutput,
                  public ForceOutput,
                  public TissueShapeOutput,
                  public DescriptionOutput {};

// Fails where the configuration is wrong, or the interface's address is none of this machine's. Whether the output is
// enabled is the caller's to check. Publishing waits neither for the network nor for readers: what a slow reliable
// reader has not confirmed is overwritten and, up to 100 Hz, counted as "dropped". Not for the tick (DDS allocates).
[[nodiscard]] Result<std::unique_ptr<DdsOutput>> make_dds_output(const DdsOutputConfig& config);

}  // namespace cellmirror::dds
