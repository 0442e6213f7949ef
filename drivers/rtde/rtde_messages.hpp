// Packages of the Real-Time Data Exchange (RTDE) of Universal Robots' controllers, protocol version 2: TCP, big endian,
// a head of 3 bytes (length of the package, type). Both roles. No I/O, no clock.
// Source: Universal Robots, "Real-Time Data Exchange (RTDE) guide".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror::rtde {

inline constexpr std::uint16_t kPort = 30004;
inline constexpr std::uint16_t kProtocolVersion = 2;
inline constexpr std::size_t kJoints = 6;

enum class PackageType : std::uint8_t {
  version = 86,  // 'V'
  text = 77,     // 'M'
  data = 85,     // 'U'
  outputs = 79,  // 'O'
  start = 83,    // 'S'
};

// What the gateway asks for, in this order, and its types as the controller answers them.
inline constexpr std::string_view kVariables = "timestamp,actual_q,actual_qd,robot_mode,safety_mode";
inline constexpr std::string_view kVariableTypes = "DOUBLE,VECTOR6D,VECTOR6D,INT32,INT32";
// The same, plus the variables that older controllers do not have.
inline constexpr std::string_view kAllVariables =
    "timestamp,actual_q,actual_qd,robot_mode,safety_mode,actual_current,target_moment,speed_scaling,runtime_state";
inline constexpr std::string_view kAllVariableTypes =
    "DOUBLE,VECTOR6D,VECTOR6D,INT32,INT32,VECTOR6D,VECTOR6D,DOUBLE,UINT32";

struct RobotData {
  double timestamp_s = 0;            // since the controller was started
  std::array<double, kJoints> q{};   // rad
  std::array<double, kJoints> qd{};  // rad/s
  std::int32_t robot_mode = 7;       // 7: running
  std::int32_t safety_mode = 1;      // 1: normal
  // The following values are valid only if `has_all`: the package has kAllVariables.
  bool has_all = false;
  std::array<double, kJoints> current{};  // A
  std::array<double, kJoints> moment{};   // Nm: target of the controller, without contact forces
  double speed_scaling = 1;               // of the trajectory; 1: programmed speed
  std::uint32_t runtime_state = 0;        // state of the robot program
};

[[nodiscard]] std::string robot_mode_text(std::int32_t mode);
[[nodiscard]] std::string safety_mode_text(std::int32_t mode);
[[nodiscard]] std::string runtime_state_text(std::uint32_t state);

struct Package {
  std::uint8_t type = 0;
  std::span<const std::uint8_t> payload;  // until the splitter is used again
};

// Divides the bytes of a connection into packages.
class PackageSplitter {
 public:
  // What is added beyond kMostWaiting is refused: the stream is broken then.
  void add(std::span<const std::uint8_t> bytes);
  // The next whole package; none: more bytes are needed, or broken().
  [[nodiscard]] std::optional<Package> next();
  // A length field is smaller than a head or larger than any package: the stream can no longer be divided.
  [[nodiscard]] bool broken() const { return broken_; }
  void clear();

 private:
  static constexpr std::size_t kMostWaiting = 1 << 20;
  static constexpr std::size_t kLongestPackage = 8192;  // data and text packages have some hundred bytes

  std::vector<std::uint8_t> bytes_;
  std::size_t used_ = 0;
  bool broken_ = false;
};

using Bytes = std::vector<std::uint8_t>;

// The client's side.
[[nodiscard]] Bytes version_request(std::uint16_t version);
[[nodiscard]] Bytes outputs_request(double rate_hz, std::string_view variables);
[[nodiscard]] Bytes start_request();

// Of the answers to `version` and `start`. None: another length.
[[nodiscard]] std::optional<bool> decode_accepted(std::span<const std::uint8_t> payload);

struct OutputsAnswer {
  std::uint8_t recipe = 0;
  std::string types;  // comma separated; NOT_FOUND where the controller does not know a variable
};
[[nodiscard]] std::optional<OutputsAnswer> decode_outputs(std::span<const std::uint8_t> payload);
// Decodes a package of kVariables or kAllVariables, depending on its length. None: another length or recipe.
[[nodiscard]] std::optional<RobotData> decode_data(std::span<const std::uint8_t> payload, std::uint8_t recipe);
// The message of a text package and who sent it, as one printable line.
[[nodiscard]] std::string decode_text(std::span<const std::uint8_t> payload);

// The controller's side.
struct OutputsRequest {
  double rate_hz = 0;
  std::string variables;
};
[[nodiscard]] std::optional<std::uint16_t> decode_version_request(std::span<const std::uint8_t> payload);
[[nodiscard]] std::optional<OutputsRequest> decode_outputs_request(std::span<const std::uint8_t> payload);
[[nodiscard]] Bytes accepted(PackageType type, bool yes);
[[nodiscard]] Bytes outputs_answer(const OutputsAnswer& answer);
// Encodes kAllVariables if `data.has_all`, else kVariables.
[[nodiscard]] Bytes data_package(const RobotData& data, std::uint8_t recipe);

}  // namespace cellmirror::rtde
