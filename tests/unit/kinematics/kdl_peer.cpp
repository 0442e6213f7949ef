#include "tests/unit/kinematics/kdl_peer.hpp"

#include <urdf_parser/urdf_parser.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/tree.hpp>
#include <stdexcept>
#include <vector>

#include "tests/unit/kinematics/kdl_chain.hpp"

namespace cellmirror {

namespace {

KDL::Segment segment_of(const urdf::Joint& joint) {
  const urdf::Pose& at = joint.parent_to_joint_origin_transform;
  const KDL::Frame origin(KDL::Rotation::Quaternion(at.rotation.x, at.rotation.y, at.rotation.z, at.rotation.w),
                          KDL::Vector(at.position.x, at.position.y, at.position.z));
  const KDL::Vector axis = origin.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
  KDL::Joint kdl(joint.name, KDL::Joint::Fixed);
  if (joint.type == urdf::Joint::PRISMATIC) kdl = KDL::Joint(joint.name, origin.p, axis, KDL::Joint::TransAxis);
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
    kdl = KDL::Joint(joint.name, origin.p, axis, KDL::Joint::RotAxis);
  }
  return KDL::Segment(joint.child_link_name, kdl, origin);
}

KDL::Tree tree_of(const urdf::ModelInterface& model) {
  KDL::Tree tree(model.getRoot()->name);
  std::vector<urdf::LinkConstSharedPtr> open{model.getRoot()};
  while (!open.empty()) {
    const auto link = open.back();
    open.pop_back();
    for (const auto& joint : link->child_joints) {
      if (!tree.addSegment(segment_of(*joint), link->name)) throw std::runtime_error("KDL refuses " + joint->name);
      open.push_back(model.getLink(joint->child_link_name));
    }
  }
  return tree;
}

KDL::JntArray array_of(std::span<const double> q, std::size_t count) {
  KDL::JntArray array(static_cast<unsigned>(count));
  for (std::size_t i = 0; i < count; ++i) array(static_cast<unsigned>(i)) = q[i];
  return array;
}

}  // namespace

KDL::Chain kdl_chain(const std::string& urdf, const std::string& base, const std::string& tip) {
  const auto model = urdf::parseURDF(urdf);
  if (!model) throw std::runtime_error("urdfdom refuses the text");
  KDL::Chain chain;
  if (!tree_of(*model).getChain(base, tip, chain)) throw std::runtime_error("no chain from " + base + " to " + tip);
  return chain;
}

struct KdlChain::Solvers {
  explicit Solvers(const KDL::Chain& from) : chain(from) {}
  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive pose{chain};
  KDL::ChainJntToJacSolver jacobian{chain};
};

KdlChain::KdlChain(const std::string& urdf, const std::string& base, const std::string& tip)
    : solvers_(std::make_unique<Solvers>(kdl_chain(urdf, base, tip))) {}
KdlChain::~KdlChain() = default;

std::size_t KdlChain::joint_count() const { return solvers_->chain.getNrOfJoints(); }

Pose KdlChain::forward(std::span<const double> q) {
  KDL::Frame frame;
  if (solvers_->pose.JntToCart(array_of(q, joint_count()), frame) < 0) throw std::runtime_error("KDL: no pose");
  Pose X = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    X.translation()[row] = frame.p[row];
    for (int column = 0; column < 3; ++column) X.linear()(row, column) = frame.M(row, column);
  }
  return X;
}

Eigen::MatrixXd KdlChain::jacobian(std::span<const double> q) {
  KDL::Jacobian jacobian(static_cast<unsigned>(joint_count()));
  if (solvers_->jacobian.JntToJac(array_of(q, joint_count()), jacobian) < 0)
    throw std::runtime_error("KDL: no Jacobian");
  return jacobian.data;
}

}  // namespace cellmirror
