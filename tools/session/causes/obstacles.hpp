// The tree of an answer of `why not`, from the state of a CPU and what its contacts found lately.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/flow/ways.hpp"
#include "interpreter/analysis/rung_text.hpp"
#include "tools/session/causes/contacts.hpp"
#include "tools/session/causes/obstacle.hpp"

namespace s7200::tools {

class Obstacles {
 public:
  /// All must live as long as this. `fresh_since`: as of Contacts.
  Obstacles(const Cpu& cpu, const Facts& facts, const LatelyExecuted& lately, Time fresh_since);

  /// What keeps a bit from being on, or off.
  Obstacle of_bit(const Bits& bit, bool wanted);

  /// Who writes a word, or other memory that is compared.
  Obstacle of_value(const Bits& bits);

 private:
  /// The instructions that write a bit, in the order of the program.
  struct Writers {
    std::vector<std::uint32_t> deciding{};  ///< make it what is wanted
    std::vector<std::uint32_t> opposing{};  ///< make it the opposite
    std::vector<std::uint32_t> others{};    ///< that may do either: a whole byte, a result, a block
    std::vector<std::uint32_t> calls{};     ///< that get it back from their subroutine
    std::vector<std::uint32_t> messages{};  ///< that let messages be stored there
    std::vector<std::uint32_t> pointers{};  ///< through a pointer
  };

  const Program& program() const { return facts_.program; }
  const Op& op(std::uint32_t number) const { return facts_.program.ops[number]; }

  std::string place_text(std::uint32_t op) const;
  std::string name_of(const Bits& bits) const;
  bool is_on(const Bits& bit) const;
  Obstacle about(std::string_view kind, const Bits& bit, bool wanted) const;

  Obstacle followed(const Bits& bit, bool wanted);
  Obstacle value_followed(const Bits& bits);
  std::optional<Obstacle> told_before(const Bits& bits, bool wanted) const;
  void note_told(const Bits& bits, bool wanted, Obstacle& obstacle);
  Obstacle of_condition(const Condition& found);
  Obstacle of_contact(const Condition& condition);
  Obstacle of_comparison(const Condition& condition);
  Obstacle of_edge(std::uint32_t op);
  Obstacle of_interrupt(std::uint32_t head);
  Obstacle of_timer(const Bits& bit, bool wanted);
  Obstacle of_counter(const Bits& bit, bool wanted);
  Obstacle of_memory(const Bits& bit, bool wanted, std::optional<std::uint32_t> routine);
  std::optional<Bits> moved_from(std::uint32_t op, const Bits& bit) const;
  Obstacle of_writer(std::uint32_t op, const Bits& bit, bool wanted);
  Obstacle of_call(std::uint32_t call, const Bits& bit, bool wanted);
  Obstacle of_input(std::uint32_t op, std::size_t level, bool on, std::string text);

  bool add_forced(Obstacle& obstacle, const Bits& bits) const;
  Writers writers_of(const Bits& bits, bool wanted, std::optional<std::uint32_t> routine) const;
  void note_writer(std::uint32_t op, const Bits& bits, bool wanted, Writers& writers) const;
  std::optional<std::string> why_never(const std::vector<std::uint32_t>& by) const;
  std::optional<std::string> never_executed(std::uint32_t op) const;
  void add_ways(Obstacle& to, const std::vector<Conditions>& ways);
  void add_ways(Obstacle& to, const std::vector<Conditions>& ways, std::string_view never,
                const std::vector<std::uint32_t>& by);
  void add_ways_if_any_changes(Obstacle& to, const std::vector<Conditions>& ways);
  void add_ways_of_edge(Obstacle& to, const std::vector<Conditions>& ways, bool rising);
  void add_ways_of_bit(Obstacle& to, const Writers& writers, const Bits& bit, bool wanted);
  bool is_executed_after(std::uint32_t op, std::uint32_t other) const;
  bool is_so_already(const std::vector<Conditions>& ways) const;
  std::vector<Conditions> kept_harmless(std::uint32_t op, std::uint32_t later, bool power) const;
  void add_rungs(Obstacle& to, const std::vector<std::uint32_t>& writers) const;
  void add_resets(Obstacle& to, const Bits& bit);
  void add_arguments(Obstacle& to, const Bits& local, bool wanted, std::uint32_t routine);
  void add_indirect(Obstacle& to, const Writers& writers, const Bits& bits) const;
  void add_value_of(Obstacle& to, const Condition& condition, std::size_t operand);
  void add_parameter(Obstacle& to, std::uint32_t op, std::size_t operand, const Bits& local);
  void add_edges(Obstacle& to, std::uint32_t counter, std::size_t level, std::int64_t edges);
  void add_timing(Obstacle& to, std::uint32_t by, std::uint32_t number, std::int64_t goal);
  void add_counting(Obstacle& to, std::uint32_t by, std::int64_t away);
  std::optional<std::int64_t> goal_of(const Condition& condition, std::size_t operand) const;
  void count_to(Obstacle& value, const Bits& bits, std::int64_t goal);

  std::string operand_text(std::uint32_t op, std::size_t operand) const;
  std::string rung_text(std::uint32_t op, std::size_t level) const;
  std::string interrupt_text(std::uint32_t op) const;
  bool runs(std::uint32_t op) const;
  bool enters(std::uint32_t call) const;
  std::optional<std::uint32_t> look_within(std::uint32_t routine, std::optional<std::uint32_t> call);
  std::vector<std::uint32_t> calls_that_hand_over(std::uint32_t routine) const;
  std::string several_text(std::uint32_t routine) const;

  const Cpu& cpu_;
  const Facts& facts_;
  Calls calls_;
  Contacts contacts_;
  bool has_run_;  ///< something was executed lately, so that what was not is known
  Ways ways_;
  Ways entries_;  ///< the same of CALLs: asked while `ways_` asks what contacts let through
  mutable std::map<std::uint32_t, bool> enters_{};  ///< by CALL; false while it is being found
  RungText rungs_;
  std::vector<std::pair<Bits, bool>> open_{};  ///< bits that are being followed

  /// What the answer has told already: a node that tells it again would have the same below.
  struct Told {
    Bits bits;
    bool wanted = false;
    std::size_t level = 0;  ///< bits that were being followed: one further in would tell less
    std::uint32_t number = 0;
    std::string_view kind{};
  };
  std::vector<Told> told_{};
  std::uint32_t numbered_ = 0;
};

}  // namespace s7200::tools
