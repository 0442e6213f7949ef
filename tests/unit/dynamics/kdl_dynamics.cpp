#include "tests/unit/dynamics/kdl_dynamics.hpp"

#include <urdf_parser/urdf_parser.h>

#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/tree.hpp>
#include <stdexcept>

namespace cellmirror::dynamics {

namespace {

KDL::Frame frame_of(const urdf::Pose& at) {
  return {KDL::Rotation::Quaternion(at.rotation.x, at.rotation.y, at.rotation.z, at.rotation.w),
          KDL::Vector(at.position.x, at.position.y, at.position.z)};
}

KDL::RigidBodyInertia inertia_of(const urdf::Link& link) {
  if (!link.inertial) return KDL::RigidBodyInertia::Zero();
  const urdf::Inertial& body = *link.inertial;
  // In a frame at the centre of mass, then in the link's.
  const KDL::RigidBodyInertia in_C(body.mass, KDL::Vector::Zero(),
                                   KDL::RotationalInertia(body.ixx, body.iyy, body.izz, body.ixy, body.ixz, body.iyz));
  return frame_of(body.origin) * in_C;
}

KDL::Segment segment_of(const urdf::Joint& joint, const urdf::Link& child) {
  const KDL::Frame origin = frame_of(joint.parent_to_joint_origin_transform);
  const KDL::Vector axis = origin.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
  KDL::Joint kdl(joint.name, KDL::Joint::Fixed);
  if (joint.type == urdf::Joint::PRISMATIC) kdl = KDL::Joint(joint.name, origin.p, axis, KDL::Joint::TransAxis);
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
    kdl = KDL::Joint(joint.name, origin.p, axis, KDL::Joint::RotAxis);
  }
  return KDL::Segment(child.name, kdl, origin, inertia_of(child));
}

KDL::Chain chain_of(const std::string& text, const std::string& base, const std::string& tip) {
  const auto model = urdf::parseURDF(text);
  if (!model) throw std::runtime_error("urdfdom refuses the text");
  KDL::Tree tree(model->getRoot()->name);
  std::vector<urdf::LinkConstSharedPtr> open{model->getRoot()};
  while (!open.empty()) {
    const auto link = open.back();
    open.pop_back();
    for (const auto& joint : link->child_joints) {
      const auto child = model->getLink(joint->child_link_name);
      if (!tree.addSegment(segment_of(*joint, *child), link->name)) throw std::runtime_error("KDL: " + joint->name);
      open.push_back(child);
    }
  }
  KDL::Chain chain;
  if (!tree.getChain(base, tip, chain)) throw std::runtime_error("no chain from " + base + " to " + tip);
  return chain;
}

}  // namespace

struct KdlDynamics::Solver {
  explicit Solver(const KDL::Chain& from)
      : chain(from), q(chain.getNrOfJoints()), qd(q), qdd(q), effort(q), external(chain.getNrOfSegments()) {}
  KDL::Chain chain;
  KDL::ChainIdSolver_RNE rne{chain, KDL::Vector(0, 0, -9.80665)};
  KDL::JntArray q;
  KDL::JntArray qd;
  KDL::JntArray qdd;
  KDL::JntArray effort;
  KDL::Wrenches external;
};

KdlDynamics::KdlDynamics(const std::string& urdf, const std::string& base, const std::string& tip)
    : solver_(std::make_unique<Solver>(chain_of(urdf, base, tip))) {}
KdlDynamics::~KdlDynamics() = default;
KdlDynamics::KdlDynamics(KdlDynamics&&) noexcept = default;

std::size_t KdlDynamics::joint_count() const { return solver_->chain.getNrOfJoints(); }

void KdlDynamics::set(std::span<const double> q, std::span<const double> qd, std::span<const double> qdd) {
  for (unsigned i = 0; i < joint_count(); ++i) {
    solver_->q(i) = q[i];
    solver_->qd(i) = qd[i];
    solver_->qdd(i) = qdd[i];
  }
}

void KdlDynamics::compute(const Eigen::Vector3d& f, const Eigen::Vector3d& t) {
  solver_->external.back() = KDL::Wrench(KDL::Vector(f.x(), f.y(), f.z()), KDL::Vector(t.x(), t.y(), t.z()));
  if (solver_->rne.CartToJnt(solver_->q, solver_->qd, solver_->qdd, solver_->external, solver_->effort) < 0) {
    throw std::runtime_error("KDL: no efforts");
  }
}

double KdlDynamics::effort(std::size_t joint) const { return solver_->effort(static_cast<unsigned>(joint)); }

}  // namespace cellmirror::dynamics
