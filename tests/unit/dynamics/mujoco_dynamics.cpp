#include "tests/unit/dynamics/mujoco_dynamics.hpp"

#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace cellmirror::dynamics {

namespace {

// Without shapes: their meshes would be opened. No links are joined, so that each can be given its moments below.
std::string mechanism_of(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str()) != tinyxml2::XML_SUCCESS) throw std::runtime_error(document.ErrorStr());
  tinyxml2::XMLElement* robot = document.RootElement();
  for (auto* link = robot->FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link")) {
    for (const char* tag : {"visual", "collision"}) {
      while (auto* element = link->FirstChildElement(tag)) link->DeleteChild(element);
    }
  }
  auto* compiler = robot->InsertNewChildElement("mujoco")->InsertNewChildElement("compiler");
  compiler->SetAttribute("fusestatic", "false");
  compiler->SetAttribute("strippath", "true");
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

mjModel* load(const std::string& urdf) {
  const std::string text = mechanism_of(urdf);
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  constexpr const char* kName = "arm.urdf";
  if (mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(text.size())) != 0) {
    throw std::runtime_error("MuJoCo: no file in memory");
  }
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kName)], text.data(), text.size());
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo: ") + error.data());
  return model;
}

Eigen::Vector3d three(const tinyxml2::XMLElement* element, const char* attribute) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (element == nullptr || element->Attribute(attribute) == nullptr) return v;
  std::istringstream text(element->Attribute(attribute));
  text >> v.x() >> v.y() >> v.z();
  return v;
}

// MuJoCo keeps principal moments and their axes. Its reader ends the search for these axes when they turn by some 1e-6
// rad, which shows in the seventh digit of the efforts; here they are set to those of the file.
void set_moments(const std::string& urdf, mjModel& model) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str()) != tinyxml2::XML_SUCCESS) throw std::runtime_error(document.ErrorStr());
  for (auto* link = document.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const auto* inertial = link->FirstChildElement("inertial");
    const int body = mj_name2id(&model, mjOBJ_BODY, link->Attribute("name"));
    if (inertial == nullptr || body <= 0) continue;
    const auto* moments = inertial->FirstChildElement("inertia");
    const auto moment = [&](const char* name) { return moments->DoubleAttribute(name); };
    Eigen::Matrix3d I;
    I << moment("ixx"), moment("ixy"), moment("ixz"), moment("ixy"), moment("iyy"), moment("iyz"), moment("ixz"),
        moment("iyz"), moment("izz");
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(I);
    Eigen::Matrix3d V = axes.eigenvectors();
    if (V.determinant() < 0) V.col(0) *= -1.0;
    const Eigen::Vector3d rpy = three(inertial->FirstChildElement("origin"), "rpy");
    const Eigen::Matrix3d R =
        (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    const Eigen::Quaterniond q(R * V);
    const double quaternion[] = {q.w(), q.x(), q.y(), q.z()};
    for (int i = 0; i < 4; ++i) model.body_iquat[4 * body + i] = quaternion[i];
    for (int i = 0; i < 3; ++i) model.body_inertia[3 * body + i] = axes.eigenvalues()[i];
    model.body_sameframe[body] = 0;
  }
}

}  // namespace

struct MujocoDynamics::Model {
  mjModel* model = nullptr;
  mjData* data = nullptr;
  std::vector<int> dofs;
  std::vector<int> positions;
  std::vector<double> bare;

  ~Model() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
};

MujocoDynamics::MujocoDynamics(const std::string& urdf, const std::vector<std::string>& joints,
                               std::span<const Drive> drives)
    : model_(std::make_unique<Model>()) {
  model_->model = load(urdf);
  mjModel* model = model_->model;
  set_moments(urdf, *model);
  model->opt.gravity[0] = model->opt.gravity[1] = 0;
  model->opt.gravity[2] = -9.80665;
  model->opt.disableflags |= mjDSBL_CONSTRAINT;
  for (int i = 0; i < model->nv; ++i) model->dof_frictionloss[i] = 0;
  model_->data = mj_makeData(model);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const int joint = mj_name2id(model, mjOBJ_JOINT, joints[i].c_str());
    if (joint < 0) throw std::runtime_error("MuJoCo does not know " + joints[i]);
    model_->dofs.push_back(model->jnt_dofadr[joint]);
    model_->positions.push_back(model->jnt_qposadr[joint]);
    model->dof_armature[model_->dofs.back()] = drives[i].reflected_inertia();
    model->dof_damping[model_->dofs.back()] = drives[i].viscous_friction;
  }
  if (model->nv != static_cast<int>(joints.size())) throw std::runtime_error("MuJoCo knows other joints");
  model_->bare.resize(static_cast<std::size_t>(model->nv));
}
MujocoDynamics::~MujocoDynamics() = default;
MujocoDynamics::MujocoDynamics(MujocoDynamics&&) noexcept = default;

void MujocoDynamics::set(std::span<const double> q, std::span<const double> qd, std::span<const double> qdd) {
  for (std::size_t i = 0; i < model_->dofs.size(); ++i) {
    model_->data->qpos[model_->positions[i]] = q[i];
    model_->data->qvel[model_->dofs[i]] = qd[i];
    model_->data->qacc[model_->dofs[i]] = qdd[i];
  }
}

void MujocoDynamics::compute() { mj_inverse(model_->model, model_->data); }

void MujocoDynamics::compute_bare() {
  mj_kinematics(model_->model, model_->data);
  mj_comPos(model_->model, model_->data);
  mj_comVel(model_->model, model_->data);
  mj_rne(model_->model, model_->data, 1, model_->bare.data());
}

double MujocoDynamics::effort(std::size_t variable) const { return model_->data->qfrc_inverse[model_->dofs[variable]]; }
double MujocoDynamics::bare_effort(std::size_t variable) const {
  return model_->bare[static_cast<std::size_t>(model_->dofs[variable])];
}

}  // namespace cellmirror::dynamics
