// The chain of Orocos KDL between two links of a URDF, read by urdfdom.
#pragma once

#include <kdl/chain.hpp>
#include <string>

namespace cellmirror {

// Throws where KDL or urdfdom refuse.
[[nodiscard]] KDL::Chain kdl_chain(const std::string& urdf, const std::string& base, const std::string& tip);

}  // namespace cellmirror
