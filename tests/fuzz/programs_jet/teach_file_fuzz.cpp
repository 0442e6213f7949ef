// Teach files of both dialects. What comes out is written and read again as the same check points.
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/units.hpp"
#include "scripts/programs/jet/jet.hpp"
#include "scripts/programs/jet/teach_writer.hpp"
#include "tests/support/program_fuzz.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

std::vector<JointPosition> check_points(const Program& program) {
  std::vector<JointPosition> points;
  for (const Statement& statement : program.statements) {
    if (const auto* move = std::get_if<MoveStatement>(&statement))
      points.push_back(std::get<JointPosition>(program.constants.at(program.expressions.at(move->target).payload)));
  }
  return points;
}

// All joints slide here: a mm of the file is a mm when it is written.
std::string written(TeachDialect dialect, const std::vector<JointPosition>& points) {
  const std::vector<JointKind> joints(points.front().count, JointKind::prismatic);
  auto writer = TeachWriter::begin(dialect, "fuzz", joints);
  require(writer.has_value());
  for (std::size_t i = 0; i < points.size(); ++i) {
    CheckPoint point;
    point.name = "P" + std::to_string(i);
    for (std::size_t j = 0; j < joints.size(); ++j) point.joints[j] = m_from_mm(points[i].values[j]);
    // The ends of the range may be left by rounding.
    if (!writer->add(point)) return {};
  }
  return writer->text();
}

void read(const Language& language, TeachDialect dialect, std::string_view text) {
  const std::shared_ptr<const Program> program = read_fuzzed(language, text);
  if (!program) return;
  const std::vector<JointPosition> points = check_points(*program);
  require(!points.empty() && program->reversible);
  const std::string again = written(dialect, points);
  if (again.empty()) return;
  Diagnostics findings;
  const auto second = language.parse(again, {"again", {}}, findings);
  require(second != nullptr);
  const std::vector<JointPosition> repeated = check_points(*second);
  require(repeated.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points[i].count; ++j)
      require(std::abs(points[i].values[j] - repeated[i].values[j]) < 1e-5);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read(jet_boom_language(), TeachDialect::boom, text);
  read(jet_tarm_language(), TeachDialect::tarm, text);
  return 0;
}
