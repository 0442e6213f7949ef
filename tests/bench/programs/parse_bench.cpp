// Goal: 500,000 records a second are read, of a program of 100,000 records, in every language. A record of CRCL is a
// move of 16 elements. Then: statements that the machine executes.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>

#include "scripts/programs/languages/languages.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program {
namespace {

constexpr std::int64_t kRecords = 100'000;

// Moves in joint values and poses, settings, outputs, arithmetic and comments, as programs made off line are.
std::string irdata_program() {
  std::string text = "1, HEADER, long\n2, INTEGER, count, 0\n3, END_HEADER\n";
  for (std::int64_t n = 10; n < kRecords + 10; n += 5) {
    text += fmt::format("{}, VEL_LIN, {}\n", n, 100 + n % 500);
    text += fmt::format("{}, PTP, JOINTS({}, -30.5, 12, 100, 0, -45.25), FLY\n", n + 1, n % 90);
    text += fmt::format("{}, LIN, POSE({}.5, {}, 312.25, 180, -12.5, 90) ; down\n", n + 2, n % 700, n % 300);
    text += fmt::format("{}, DOUT, 4, {}\n", n + 3, n % 2 == 0 ? "ON" : "OFF");
    text += fmt::format("{}, LIN, POSE(0, 0, 50, 0, 0, 0) @ POSE({}, 80, 300, 180, 0, 0)\n", n + 4, n % 400);
  }
  return text + fmt::format("{}, END\n", kRecords + 20);
}

std::string srcl_program() {
  std::string text = "PROGRAMM LANG\nGANZ I\n";
  for (std::int64_t n = 0; n < kRecords; n += 5) {
    text += fmt::format("V_BAHN {}\n", 100 + n % 500);
    text += fmt::format("PTP STELLUNG({}, -30.5, 12, 100, 0, -45.25) UEBER\n", n % 90);
    text += fmt::format("LIN LAGE({}.5, {}, 312.25, 180, -12.5, 90) ; down\n", n % 700, n % 300);
    text += fmt::format("AUSGANG(4) = {}\n", n % 2 == 0 ? "EIN" : "AUS");
    text += "I = I + 1\n";
  }
  return text;
}

std::string jet_program(std::string_view header) {
  std::string text = fmt::format("{} 1\nNAME long\nJOINTS 6\nSPEED 60\nTOLERANCE 20 MM\n", header);
  const bool named = header == "JET_TARM";  // its values carry the joint's number
  for (std::int64_t n = 0; n < kRecords; ++n) {
    const std::int64_t speed = 10 + n % 90;
    text += named
                ? fmt::format("POINT P{} J1={} J2=8.5 J3=-4 J4=150 J5=0.25 J6={} SPEED {}\n", n, n % 90, n % 45, speed)
                : fmt::format("POINT P{} {} 8.5 -4 150 0.25 {} SPEED {}\n", n, n % 90, n % 45, speed);
  }
  return text + "END\n";
}

std::string crcl_program() {
  std::string text =
      "<CRCLProgram xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">\n<InitCanon><CommandID>1</CommandID>"
      "</InitCanon>\n";
  for (std::int64_t n = 0; n < kRecords; ++n) {
    text += fmt::format(
        "<MiddleCommand xsi:type=\"MoveToType\"><CommandID>{}</CommandID><MoveStraight>true</MoveStraight><EndPosition>"
        "<Point><X>0.{}</X><Y>0.25</Y><Z>0.5</Z></Point><XAxis><I>1</I><J>0</J><K>0</K></XAxis>"
        "<ZAxis><I>0</I><J>0</J><K>-1</K></ZAxis></EndPosition></MiddleCommand>\n",
        n + 2, n % 1000);
  }
  return text + "<EndCanon><CommandID>999999</CommandID></EndCanon>\n</CRCLProgram>\n";
}

std::string rapid_program() {
  std::string text = "MODULE long\nVAR num i;\nPROC main()\n";
  for (std::int64_t n = 0; n < kRecords; n += 5) {
    text += fmt::format("MoveAbsJ [[{},-30.5,12,100,0,-45.25],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,z10,tool0;\n", n % 90);
    text +=
        fmt::format("MoveL [[{}.5,{},312.25],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v{},fine,tool0; ! down\n",
                    n % 700, n % 300, n % 2 == 0 ? 100 : 200);
    text += fmt::format("SetDO do4,{};\n", n % 2);
    text += "i:=i+1;\n";
    text += "WaitTime 0.5;\n";
  }
  return text + "ENDPROC\nENDMODULE\n";
}

std::string program_in(std::string_view language) {
  if (language == "irdata") return irdata_program();
  if (language == "srcl") return srcl_program();
  if (language == "jet_boom") return jet_program("JET_BOOM");
  if (language == "jet_tarm") return jet_program("JET_TARM");
  if (language == "crcl") return crcl_program();
  if (language == "rapid") return rapid_program();
  return {};
}

void BM_Parse(benchmark::State& state, const Language* language) {
  const std::string text = program_in(language->name);
  if (text.empty()) return state.SkipWithError("program_in() has no program in this language");
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto program = language->parse(text, {.file = "long", .codes = {}}, diagnostics);
    if (program == nullptr) {
      state.SkipWithError(diagnostics.text().substr(0, 200).c_str());
      break;
    }
    benchmark::DoNotOptimize(program);
  }
  state.SetItemsProcessed(state.iterations() * kRecords);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

class World final : public ProgramWorld {
 public:
  [[nodiscard]] JointValues joints() const override { return {}; }
  [[nodiscard]] Result<Pose> position() const override { return Pose::Identity(); }
  [[nodiscard]] bool digital_input(std::size_t /*number*/) const override { return true; }
  [[nodiscard]] double analogue_input(std::size_t /*number*/) const override { return 1; }
  [[nodiscard]] bool digital_output(std::size_t /*number*/) const override { return true; }
  [[nodiscard]] double analogue_output(std::size_t /*number*/) const override { return 1; }
};

// count = count + 1 for ever: what an endless loop costs whoever drives the machine.
void BM_EndlessLoop(benchmark::State& state) {
  ProgramBuilder builder("loop", "bench", "bench");
  const VariableId count = *builder.declare("count", ValueType::integer);
  const auto begin = builder.new_label();
  builder.bind(begin);
  const ExpressionId before = *builder.variable(count);
  const auto sum = builder.operation(Operator::add, {before, builder.integer(1)});
  if (!builder.add(AssignStatement{.variable = count, .value = *sum})) state.SkipWithError("refused");
  builder.jump(begin);
  Diagnostics diagnostics;
  constexpr std::array<JointKind, 1> kJoints = {JointKind::revolute};
  Machine machine(builder.build(diagnostics), kJoints);
  const World world;
  for (auto _ : state) benchmark::DoNotOptimize(machine.next(world, 2000));
  state.SetItemsProcessed(state.iterations() * 2000);
}
BENCHMARK(BM_EndlessLoop);

}  // namespace
}  // namespace cellmirror::program

int main(int argc, char** argv) {
  for (const auto& language : cellmirror::program::languages()) {
    benchmark::RegisterBenchmark(fmt::format("BM_Parse/{}", language.name).c_str(), &cellmirror::program::BM_Parse,
                                 &language)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
