#include "tests/unit/kinematics/mujoco_peer.hpp"

#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <array>
#include <cstring>
#include <stdexcept>

namespace cellmirror {

namespace {

// Only the mechanism: no shapes (their meshes would be opened), and every link with some mass, which MuJoCo asks for.
std::string mechanism_of(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str()) != tinyxml2::XML_SUCCESS) throw std::runtime_error(document.ErrorStr());
  tinyxml2::XMLElement* robot = document.RootElement();
  for (auto* link = robot->FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link")) {
    for (const char* tag : {"visual", "collision", "inertial"}) {
      while (auto* element = link->FirstChildElement(tag)) link->DeleteChild(element);
    }
    auto* inertial = link->InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", 1.0);
    auto* inertia = inertial->InsertNewChildElement("inertia");
    for (const char* moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1.0);
    for (const char* product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0.0);
  }
  auto* compiler = robot->InsertNewChildElement("mujoco")->InsertNewChildElement("compiler");
  compiler->SetAttribute("fusestatic", "false");
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

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

struct MujocoChain::Model {
  mjModel* model = nullptr;
  mjData* data = nullptr;
  int base = 0;  // the root link is the world
  int tip = 0;
  std::vector<int> joints;

  ~Model() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  [[nodiscard]] Pose X_WB(int body) const {
    Pose X = Pose::Identity();
    X.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * body);
    X.translation() = Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * body);
    return X;
  }
};

MujocoChain::MujocoChain(const std::string& urdf, const std::string& base, const std::string& tip,
                         const std::vector<std::string>& joints)
    : model_(std::make_unique<Model>()) {
  model_->model = load(urdf);
  model_->data = mj_makeData(model_->model);
  const auto body = [&](const std::string& name) { return mj_name2id(model_->model, mjOBJ_BODY, name.c_str()); };
  model_->base = body(base) < 0 ? 0 : body(base);
  model_->tip = body(tip);
  if (model_->tip < 0) throw std::runtime_error("MuJoCo does not know " + tip);
  for (const std::string& joint : joints) {
    model_->joints.push_back(mj_name2id(model_->model, mjOBJ_JOINT, joint.c_str()));
    if (model_->joints.back() < 0) throw std::runtime_error("MuJoCo does not know " + joint);
  }
}
MujocoChain::~MujocoChain() = default;

void MujocoChain::move_to(std::span<const double> q) {
  for (std::size_t i = 0; i < model_->joints.size(); ++i) {
    model_->data->qpos[model_->model->jnt_qposadr[model_->joints[i]]] = q[i];
  }
  mj_kinematics(model_->model, model_->data);
  mj_comPos(model_->model, model_->data);  // the Jacobian is made from what it computes
}

Pose MujocoChain::pose() const { return model_->X_WB(model_->base).inverse() * model_->X_WB(model_->tip); }

Eigen::MatrixXd MujocoChain::jacobian() const {
  const int n = model_->model->nv;
  RowMajor linear(3, n);
  RowMajor angular(3, n);
  mj_jacBody(model_->model, model_->data, linear.data(), angular.data(), model_->tip);
  const Eigen::Matrix3d R_BW = model_->X_WB(model_->base).linear().transpose();
  Eigen::MatrixXd jacobian(6, model_->joints.size());
  for (std::size_t i = 0; i < model_->joints.size(); ++i) {
    const int column = model_->model->jnt_dofadr[model_->joints[i]];
    jacobian.col(static_cast<Eigen::Index>(i)) << R_BW * linear.col(column), R_BW * angular.col(column);
  }
  return jacobian;
}

}  // namespace cellmirror
