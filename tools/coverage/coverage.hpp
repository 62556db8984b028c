// What a run has tried of a program: which instructions were executed, how contacts were, which of them decided alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/trace/trace.hpp"
#include "tools/coverage/decisions.hpp"

namespace s7200::tools {

/// What there is to try in a program. It is worked out once and shared by all that watch the program.
class CoverageMap {
 public:
  explicit CoverageMap(std::shared_ptr<const Program> program);

  const Program& program() const { return *program_; }
  const std::shared_ptr<const Program>& shared_program() const { return program_; }
  const ContactForm& form(std::uint32_t op) const { return forms_[op]; }
  const std::vector<Decision>& decisions() const { return decisions_.all; }

  /// The decisions of an op, as numbers: from the first until before the second.
  std::pair<std::uint32_t, std::uint32_t> decisions_at(std::uint32_t op) const { return {first_[op], first_[op + 1]}; }
  /// The decisions that a contact is part of, as numbers.
  const std::vector<std::uint32_t>& decisions_of(std::uint32_t op) const { return decisions_of_[op]; }

  /// Heads of routines and labels are places, and nothing that is executed.
  bool is_instruction(std::uint32_t op) const;
  /// A contact that may be both open and closed.
  bool is_contact(std::uint32_t op) const { return forms_[op].is_contact() && constant_[op].empty(); }
  /// Why a contact is always the same; empty of any other op.
  const std::string& why_constant(std::uint32_t op) const { return constant_[op]; }
  /// Whether it is part of a condition, so that it may decide alone.
  bool may_decide(std::uint32_t op) const { return is_contact(op) && !decisions_of_[op].empty(); }

 private:
  std::shared_ptr<const Program> program_;
  std::vector<ContactForm> forms_;
  Decisions decisions_;
  std::vector<std::uint32_t> first_;  ///< by op, and one more: of its decisions
  std::vector<std::string> constant_;
  std::vector<std::vector<std::uint32_t>> decisions_of_;  ///< by op
};

/// What was tried, by one run or several.
struct Tried {
  enum Mark : std::uint8_t {
    kExecuted = 1,  ///< with power flow, if the instruction needs it
    kSkipped = 2,   ///< it needs power flow and had none
    kClosed = 4,    ///< a contact that let power flow through
    kOpen = 8,
  };
  std::vector<std::uint8_t> marks;               ///< by op
  std::vector<std::vector<std::uint8_t>> alone;  ///< Alone, by decision and contact

  Tried() = default;
  explicit Tried(const CoverageMap& map);

  bool was(std::uint32_t op, Mark mark) const { return marks[op] & mark; }
  /// Of the same program.
  void add(const Tried& other);
  /// The ops that have decided alone.
  std::vector<bool> deciding(const CoverageMap& map) const;
};

/// Watches one CPU with this program, over any number of power-ups. Scans that are all alike may be passed over: they try
/// nothing new.
class CoverageSink final : public TraceSink {
 public:
  explicit CoverageSink(std::shared_ptr<const CoverageMap> map);

  /// The CPU that is watched from now on, before or after it is powered up. It is not owned.
  void begin(const Cpu& cpu);

  const CoverageMap& map() const { return *map_; }
  const std::shared_ptr<const CoverageMap>& shared_map() const { return map_; }
  const Tried& tried() const { return tried_; }

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override { return true; }
  Watch watch() const override { return Watch::Flow; }
  bool wants_scans() const override { return false; }

 private:
  /// How a contact was when it was executed last.
  struct LastSeen {
    bool closed = false;
    bool before = false;  ///< of EU and ED: what had reached it before
    bool now = false;     ///< and what has reached it
    std::uint8_t level = kNever;
    bool operator==(const LastSeen&) const = default;
  };
  static constexpr std::uint8_t kNever = 0xFF;
  static constexpr std::size_t kMostKept = 4096;  ///< combinations that are known to bring nothing new, of a decision
  static constexpr std::size_t kKeyBits = 64;

  struct Known {
    bool changed = true;          ///< a contact of it was otherwise than before, since it was worked out
    std::uint8_t level = kNever;  ///< that it was worked out at
    std::unordered_set<std::uint64_t> keys{};
  };

  std::uint8_t level_now() const;
  void remember_edges();
  bool edge_memory(std::uint32_t op) const;
  void see(const ContactForm& form, const InstructionRecord& record);
  void decide(std::uint32_t number);
  static bool is_known(Known& known, std::uint64_t key);

  std::shared_ptr<const CoverageMap> map_;
  const Cpu* cpu_ = nullptr;
  Tried tried_;
  std::uint8_t level_ = 0;      ///< of calls and interrupts that the next instruction belongs to
  std::vector<LastSeen> seen_;  ///< by op
  std::vector<Known> known_;    ///< by decision
  SeenContacts now_;            ///< kept for its room
};

}  // namespace s7200::tools
