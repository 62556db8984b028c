// Runs the instruction vectors of tests/vectors on the interpreter. Their format is described there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "tests/reference_model/silent_port.hpp"
#include "tests/support/source_path.hpp"
#include "tests/vectors/vector_file.hpp"

namespace s7200::vectors_test {
namespace {

using vectors::Vector;

const std::filesystem::path kFolder = test::source_path("tests/vectors");

std::vector<std::string> vector_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    if (entry.path().extension() == ".txt" && entry.path().filename() != "CMakeLists.txt")
      names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

std::uint32_t base_of(const std::string& area) {
  static const std::map<std::string, std::uint32_t> kBases{
      {"V", image::kV},         {"L", image::kL},       {"I", image::kI},   {"Q", image::kQ},         {"M", image::kM},
      {"SM", image::kSM},       {"S", image::kS},       {"T", image::kT},   {"T.bit", image::kTBits}, {"C", image::kC},
      {"C.bit", image::kCBits}, {"HC", image::kHC},     {"AC", image::kAC}, {"AI", image::kAI},       {"AQ", image::kAQ},
      {"PI", image::kInputs},   {"PQ", image::kOutputs}};
  return kBases.at(area);
}

std::string name_of_place(std::uint32_t at) {
  static const std::pair<std::uint32_t, std::string_view> kNames[] = {{image::kL, "LB"},
                                                                      {image::kV, "VB"},
                                                                      {image::kOutputs, "PQB"},
                                                                      {image::kInputs, "PIB"},
                                                                      {image::kCBits, "C bits, byte "},
                                                                      {image::kTBits, "T bits, byte "},
                                                                      {image::kAC, "AC byte "},
                                                                      {image::kHC, "HC byte "},
                                                                      {image::kC, "C byte "},
                                                                      {image::kT, "T byte "},
                                                                      {image::kAQ, "AQ byte "},
                                                                      {image::kAI, "AI byte "},
                                                                      {image::kS, "SB"},
                                                                      {image::kSM, "SMB"},
                                                                      {image::kM, "MB"},
                                                                      {image::kQ, "QB"},
                                                                      {image::kI, "IB"}};
  for (const auto& [base, name] : kNames)
    if (at >= base) return fmt::format("{}{}", name, at - base);
  return {};
}

using Image = std::array<std::uint8_t, image::kSize>;

void assign(Image& image, const vectors::Assignment& a) {
  std::uint8_t* const to = &image[base_of(a.area) + a.at];
  if (a.width == 0) *to = static_cast<std::uint8_t>(a.value != 0 ? *to | 1 << a.bit : *to & ~(1 << a.bit));
  for (std::size_t i = 0; i < a.width; ++i) to[i] = static_cast<std::uint8_t>(a.value >> (8 * (a.width - 1u - i)));
}

std::uint16_t bits_of(const vectors::Levels& levels) {
  std::uint16_t bits = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) bits = static_cast<std::uint16_t>(bits | (levels[i] ? 1 : 0) << i);
  return bits;
}

const TimeTable& default_times_of(const CpuModel& model) {
  static std::map<std::string_view, TimeTable> tables;
  const auto found = tables.find(model.name);
  return found != tables.end() ? found->second : tables.emplace(model.name, default_times(model)).first->second;
}

/// Lets one instruction through at a time.
class OneInstruction : public TraceSink {
 public:
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !std::exchange(done_, true); }
  void rearm() { done_ = false; }

 private:
  bool done_ = false;
};

/// One vector on a CPU of its own.
class Execution {
 public:
  explicit Execution(const Vector& vector) : vector_(vector) {
    const std::string text = program_text();
    const CpuModel& model = *find_cpu(vector.cpu);
    checked_ = check_text(text, "vector", model, default_times_of(model));
  }

  /// What is wrong; empty if nothing is.
  std::string result() {
    if (!checked_.program) return "the checker refuses it: " + checked_.diagnostics.at(0).message + "\n";
    const Outcome outcome = execute({});
    Image expected = outcome.before;
    for (const auto& assignment : vector_.after) assign(expected, assignment);
    compare_memory(expected, outcome.state.image);
    if (is_one_instruction() && !vector_.stops) compare_with_effects(outcome);  // a stop is the system's
    compare_state(outcome.state);
    if (vector_.time) compare("time in ns", *vector_.time, outcome.time);
    return wrong_;
  }

 private:
  /// Before a single instruction there are as many loads as the checker demands.
  std::string program_text() {
    std::string text;
    if (!vector_.is_program()) {
      const std::string mnemonic = vector_.ops[0].substr(0, vector_.ops[0].find(' '));
      const Instruction* instruction = find_instruction(mnemonic);
      prefix_ = instruction ? static_cast<std::uint32_t>(std::max<int>(0, instruction->rung.stack.needs)) : 0;
      if (mnemonic == "LDS") prefix_ += static_cast<std::uint32_t>(std::stoul(vector_.ops[0].substr(4)));  // its level
      for (std::uint32_t i = 0; i < prefix_; ++i) text += "LD SM0.0\n";
    }
    for (const std::string& op : vector_.ops) text += op + "\n";
    return vector_.is_program() ? text : text + "MEND\n";
  }

  bool is_one_instruction() const { return !vector_.is_program() && vector_.steps == 1 && !vector_.until; }

  struct Outcome {
    Image before{};
    State state{};
    Time time = 0;
    bool powered = true;
  };

  /// From the memory of the vector, or from `memory`.
  Outcome execute(const std::optional<Image>& memory) {
    queue_ = {};
    Cpu cpu(checked_.program, queue_, EventOwner{}, {&port_});
    cpu.power_up();
    cpu.run(checked_.program->scan_phase[Program::kReadInputs]);
    prepare(cpu, memory);
    const Time start = cpu.time();
    const Image before = cpu.state().image;
    const bool powered = cpu.state().stack.top() || checked_.program->ops[cpu.state().pc].power_mask == 0;
    if (vector_.until)
      run_until(cpu, *vector_.until);
    else
      run_steps(cpu);
    return {before, cpu.state(), cpu.time() - start, powered};
  }

  void prepare(Cpu& cpu, const std::optional<Image>& memory) const {
    Image image = memory.value_or(cpu.state().image);
    if (!memory)
      for (const auto& assignment : vector_.before) assign(image, assignment);
    cpu.poke(0, image);
    State state = cpu.state();
    state.pc = prefix_;
    state.stack = {};
    for (std::size_t i = vector_.stack.size(); i > 0; --i) state.stack.push(vector_.stack[i - 1]);
    cpu.restore(state);
  }

  void run_until(Cpu& cpu, Time limit) {
    while (cpu.time() < limit) {
      cpu.run(limit);
      handle_events(cpu);
    }
  }

  void handle_events(Cpu& cpu) {
    while (queue_.next() <= cpu.time()) cpu.handle(queue_.pop());
  }

  /// The system's part of a scan counts as a step.
  void run_steps(Cpu& cpu) {
    const auto& phases = checked_.program->scan_phase;
    const Time system_part = phases[0] + phases[1] + phases[2] + phases[3];
    cpu.set_sink(&one_);
    for (std::uint32_t i = 0; i < vector_.steps; ++i) {
      one_.rearm();
      if (cpu.state().phase == Phase::Program || cpu.state().in_interrupt)
        cpu.run(cpu.time() + 1);
      else
        run_until(cpu, cpu.time() + system_part);
      handle_events(cpu);
    }
  }

  template <class T>
  void compare(std::string_view what, const T& expected, const T& found) {
    if (expected != found) wrong_ += fmt::format("  {}: expected {}, found {}\n", what, expected, found);
  }

  void compare_memory(const Image& expected, const Image& found) {
    for (std::uint32_t at = 0; at < image::kConstants; ++at) {
      if (at == image::kEdges) at = image::kV;  // edge memories only show in what EU and ED do
      if (expected[at] != found[at])
        wrong_ += fmt::format("  {}: expected 16#{:02X}, found 16#{:02X}\n", name_of_place(at), expected[at], found[at]);
    }
  }

  // --- what interpreter/analysis/effects/effects.hpp says of the instruction ---

  using Mask = Image;  // with a 1 for each bit that is meant

  template <class Condition>
  static Mask bits_with(const std::vector<MemoryAccess>& effects, const Condition& condition) {
    Mask mask{};
    for (const MemoryAccess& access : effects)
      for (std::uint64_t bit = access.bits.first; condition(access) && bit < access.bits.end(); ++bit)
        mask[bit / 8] = static_cast<std::uint8_t>(mask[bit / 8] | 1 << bit % 8);
    return mask;
  }

  void complain_of(std::uint32_t at, int bits, std::string_view when, std::string_view what) {
    if (bits != 0) wrong_ += fmt::format("  {}, bits 2#{:b}: {} ({})\n", name_of_place(at), bits, what, when);
  }

  void compare_with_effects(const Outcome& outcome) {
    const Program& program = *checked_.program;
    compare_with_effects(outcome, effects_now(program, prefix_, outcome.before), "now");
    compare_with_effects(outcome, effects_of(program, prefix_, Pointers::nothing_known(program)), "ever");
  }

  /// With all memory inverted that it does not read, the instruction does the same.
  void compare_with_effects(const Outcome& outcome, const std::vector<MemoryAccess>& effects, std::string_view when) {
    const Mask written = bits_with(effects, [](const MemoryAccess& access) { return access.writes(); });
    const Mask read = bits_with(effects, [](const MemoryAccess& access) { return access.reads(); });
    const Mask surely = bits_with(effects, [&](const MemoryAccess& access) {
      return access.writes() && access.certainty == Certainty::Must && does_its_work(outcome);
    });
    Image inverted = outcome.before;
    for (std::uint32_t at = 0; at < image::kConstants; ++at)
      if (at < image::kSM || at >= image::kS) inverted[at] = static_cast<std::uint8_t>(inverted[at] ^ ~read[at]);
    const Outcome other = execute(inverted);
    for (std::uint32_t at = 0; at < image::kConstants; ++at) {
      const int changed = outcome.before[at] ^ outcome.state.image[at], changed_too = inverted[at] ^ other.state.image[at];
      const int different = outcome.state.image[at] ^ other.state.image[at];
      complain_of(at, (changed | changed_too) & ~written[at], when, "changed, and no effect says so");
      complain_of(at, different & surely[at], when, "an effect says that it is written, and it is not");
      complain_of(at, different & changed_too, when, "depends on what no effect says is read");
    }
    const State &one = outcome.state, &two = other.state;
    const bool same =
        other.time == outcome.time && one.pc == two.pc && one.stack == two.stack && one.error_count == two.error_count;
    if (!same) wrong_ += fmt::format("  what it does besides depends on what no effect says is read ({})\n", when);
  }

  /// Not without power flow, with an error, RTA with a size that it cannot write, or RCV that ends a reception.
  bool does_its_work(const Outcome& outcome) const {
    const bool may_do_less = vector_.ops[0].starts_with("RTA ") || vector_.ops[0].starts_with("RCV ");
    const bool failed = outcome.state.error_count != 0 || (outcome.state.image[sm::kFlags] & kFailures) != 0;
    return outcome.powered && !failed && !may_do_less;
  }

  void compare_state(const State& state) {
    compare("error", vector_.error, state.error_count == 0 ? 0 : static_cast<int>(state.errors[0].code));
    compare("fatal error", vector_.fatal, static_cast<int>(state.fatal_code));
    compare("STOP", vector_.stops, state.mode == Mode::Stop);
    if (vector_.stops) return;
    compare("program ended", vector_.ends, state.phase != Phase::Program);
    if (vector_.ends) return;
    compare("next", vector_.next.value_or(1) + prefix_, state.pc);
    compare("logic stack", bits_of(vector_.leaves.value_or(vector_.stack)), state.stack.bits());
  }

  const Vector& vector_;
  CheckResult checked_;
  EventQueue queue_;
  reference::SilentPort port_;
  OneInstruction one_;
  std::uint32_t prefix_ = 0;
  std::string wrong_;
};

class VectorFile : public testing::TestWithParam<std::string> {};

TEST_P(VectorFile, HoldsOnTheInterpreter) {
  const std::string path = (kFolder / (GetParam() + ".txt")).string();
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const vectors::File file = vectors::parse(text, path);
  EXPECT_FALSE(file.vectors.empty());
  for (const Vector& vector : file.vectors) {
    EXPECT_FALSE(vector.source.empty()) << path << ":" << vector.line;
    const std::string wrong = vectors::judged(vector, Execution(vector).result());
    EXPECT_TRUE(wrong.empty()) << path << ":" << vector.line << ": " << vector.ops[0] << "\n" << wrong;
  }
  const auto marked = std::ranges::count_if(file.vectors, [](const Vector& v) { return !v.expected_failure.empty(); });
  if (marked > 0) fmt::print("{}: {} expected failure{}\n", GetParam(), marked, marked == 1 ? "" : "s");
}

/// Of a vector that fails, or passes, with this line at its end.
std::string judged(const std::string& value, const std::string& mark) {
  const std::string text = "op MOVB 5, VB0\nafter VB0=" + value + "\nsource here\n" + mark;
  const vectors::File file = vectors::parse(text, "text");
  return vectors::judged(file.vectors.at(0), Execution(file.vectors.at(0)).result());
}

TEST(ExpectedFailure, AVectorThatIsAKnownGapMustFail) {
  EXPECT_EQ(judged("5", ""), "");
  EXPECT_EQ(judged("6", ""), "  VB0: expected 16#06, found 16#05\n");
  EXPECT_EQ(judged("6", "expected_failure the interpreter does not do so yet\n"), "");
  EXPECT_EQ(judged("5", "expected_failure the interpreter does not do so yet\n"),
            "  passes although it is an expected failure: remove the mark\n");
  EXPECT_THROW(vectors::parse("op NOP\nexpected_failure\n", "text"), std::runtime_error) << "without a reason";
}

TEST(ExpectedFailure, VectorsThatAreGeneratedAnewKeepTheirMarks) {
  const std::string marked = "# head\n\nop NOP\nsource a\nexpected_failure why\n\nop NOP\nsource b\n";
  vectors::File file = vectors::parse("# head\n\nop NOP\nsource a\n\nop NOP\nsource b\n", "text");
  vectors::keep_marks(vectors::parse(marked, "text"), file);
  EXPECT_EQ(file.vectors[0].expected_failure, "why");
  EXPECT_EQ(file.vectors[1].expected_failure, "");
  EXPECT_EQ(vectors::parse(vectors::to_text(file), "text").vectors[0].expected_failure, "why");
}

std::string test_name(const testing::TestParamInfo<std::string>& file) {
  std::string name = file.param;
  std::ranges::replace(name, '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Vectors, VectorFile, testing::ValuesIn(vector_files()), test_name);

}  // namespace
}  // namespace s7200::vectors_test
