#include "tests/bench/collision/fcl_naive.hpp"

#include <fcl/fcl.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace cellmirror {

namespace {

using fcl::CollisionObjectd;
using Shape3 = std::shared_ptr<fcl::CollisionGeometryd>;

Shape3 shape_of(const geometry::Solid& solid) {
  const Eigen::Vector3d& s = solid.size;
  if (solid.shape == Shape::box) return std::make_shared<fcl::Boxd>(s);
  if (solid.shape == Shape::sphere) return std::make_shared<fcl::Sphered>(s.x());
  if (solid.shape == Shape::cylinder) return std::make_shared<fcl::Cylinderd>(s.x(), s.y());
  if (solid.shape == Shape::capsule) return std::make_shared<fcl::Capsuled>(s.x(), s.y());
  const auto& mesh = solid.tree->mesh();
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

struct Part {
  std::unique_ptr<CollisionObjectd> object;
  std::size_t body = 0;
  std::int32_t node = 0;
  Pose X_NG = Pose::Identity();
};

}  // namespace

struct FclNaive::State {
  std::shared_ptr<const collision::PairTable> table;
  std::vector<Part> parts;
  std::vector<std::vector<bool>> tested;
  fcl::DynamicAABBTreeCollisionManagerd manager;
  Answer answer;
  double warning = 0;
  double distance = 0;

  static std::pair<std::size_t, std::size_t> pair_of(const CollisionObjectd* a, const CollisionObjectd* b) {
    const auto body = [](const CollisionObjectd* object) {
      return static_cast<const Part*>(object->getUserData())->body;
    };
    return std::minmax(body(a), body(b));
  }
  bool wanted(const CollisionObjectd* a, const CollisionObjectd* b) const {
    const auto [first, second] = pair_of(a, b);
    return tested[first][second];
  }
};

FclNaive::FclNaive(std::shared_ptr<const collision::PairTable> table) : state_(std::make_unique<State>()) {
  state_->table = std::move(table);
  const auto& bodies = state_->table->bodies;
  state_->tested.assign(bodies.size(), std::vector<bool>(bodies.size()));
  for (const auto& pair : state_->table->pairs) {
    if (collision::is_tested(pair.state)) state_->tested[pair.a][pair.b] = state_->tested[pair.b][pair.a] = true;
  }
  std::map<const geometry::Solid*, Shape3> shapes;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const auto& part : bodies[i].parts) {
      Shape3& shape = shapes[part.solid.get()];
      if (!shape) shape = shape_of(*part.solid);
      state_->parts.push_back({std::make_unique<CollisionObjectd>(shape), i, bodies[i].node, part.X_NG});
    }
  }
  for (Part& part : state_->parts) {
    part.object->setUserData(&part);
    state_->manager.registerObject(part.object.get());
  }
  state_->manager.setup();
}

FclNaive::~FclNaive() = default;

const FclNaive::Answer& FclNaive::check(const CellPoses& poses, double warning) {
  State& state = *state_;
  for (Part& part : state.parts) {
    part.object->setTransform(poses.X_WN[static_cast<std::size_t>(part.node)] * part.X_NG);
    part.object->computeAABB();
  }
  state.manager.update();
  state.answer = {};
  state.warning = warning;
  state.distance = std::numeric_limits<double>::infinity();
  state.manager.collide(&state, [](CollisionObjectd* a, CollisionObjectd* b, void* data) {
    auto& self = *static_cast<State*>(data);
    if (!self.wanted(a, b)) return false;
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    fcl::collide(a, b, request, result);
    if (result.isCollision()) self.answer.touching.insert(State::pair_of(a, b));
    return false;  // all that touch are wanted
  });
  state.manager.distance(&state, [](CollisionObjectd* a, CollisionObjectd* b, void* data, double& least) {
    auto& self = *static_cast<State*>(data);
    // The distance between bodies that touch may abort the program.
    if (!self.wanted(a, b) || self.answer.touching.contains(State::pair_of(a, b))) return false;
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    fcl::distance(a, b, request, result);
    double& known = self.answer.apart.try_emplace(State::pair_of(a, b), result.min_distance).first->second;
    known = std::min(known, result.min_distance);
    self.distance = std::min(self.distance, result.min_distance);
    least = std::max(self.warning, self.distance);
    return false;
  });
  return state.answer;
}

}  // namespace cellmirror
