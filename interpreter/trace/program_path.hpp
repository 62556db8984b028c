// Which way the main program took in a scan: its networks with power flow, the subroutines it called, the jumps it took.
//
// It must be told every record and every instruction, in their order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

class ProgramPath {
 public:
  /// The program must live as long as this. What is called deeper than `deepest` calls is not described.
  explicit ProgramPath(const Program& program, std::size_t deepest = 8);

  /// `main program: network 2, CALL 51 in line 79 (networks 5-6, JMP 255 in line 141, network 11)` at its end, if it took
  /// another way than in the two scans before: what alternates is the same way. Null otherwise. The text stays until
  /// it is told more.
  const std::string* of(const InstructionRecord& record);

  /// How far it came, if the CPU goes to STOP meanwhile.
  std::string of(const TraceRecord& record);

  /// What it is told next need not follow on what it was told.
  void forget();

 private:
  enum class What : std::uint8_t { Network, Jump, Call, Leave, More };

  struct Step {
    What what{};
    std::uint32_t op = 0;  ///< of a network its first one
    std::uint64_t times = 1;
    std::vector<Step> inside{};  ///< what was called
    bool operator==(const Step&) const = default;
    bool repeats(const Step& other) const { return what == other.what && op == other.op && inside == other.inside; }
  };
  using Way = std::vector<Step>;

  /// What an instruction is for the way.
  enum class Role : std::uint8_t { None, Box, Coil, Jump, Call, Return, ConditionalReturn, End, ConditionalEnd, Leave };

  struct Called {
    std::uint32_t by = 0;
    Way way{};
  };

  /// What the main program did in a scan, in its order: the ops that had power flow, and the RETs. It says more than the
  /// way, which is made of it only if it is another one.
  using Course = std::vector<std::uint32_t>;

  /// The last course that differed from those before it. Whoever asks a slave the same again makes it take that again.
  struct Other {
    Course course{};
    Way way{};
    std::string text{};  ///< if it was told
  };

  static Role role_of(const Op& op);
  bool takes_new_way();
  Way way_of(const Course& course) const;
  static void add(Way& way, Step step);
  static void return_from_subroutine(std::vector<Called>& open);
  void take(std::vector<Called>& open, std::uint32_t op) const;
  std::string text_of(const Way& way, std::size_t depth = 0) const;
  std::string text_of(const Step& step, std::size_t depth) const;

  const Program& program_;
  std::size_t deepest_;
  Networks networks_;
  std::vector<Role> role_;  ///< by op
  bool known_ = false;      ///< the scan, from its beginning on
  bool ended_ = false;      ///< it has come to END or MEND
  bool in_interrupt_ = false, interrupt_ends_ = false;
  bool failed_ = false;  ///< the instruction being executed has caused a run-time error
  Course course_;
  std::array<Course, 2> before_;  ///< in the last scan, and in that before it
  Other other_;
  std::size_t known_before_ = 0;  ///< so many of them
};

}  // namespace s7200
