// A program that is looked into, and how its places are named in all views of it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/analysis/bounds.hpp"
#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/races.hpp"
#include "interpreter/analysis/selection.hpp"
#include "interpreter/analysis/waiter.hpp"

namespace s7200::tools {

/// An instant at which a race loses a word: a run that ends otherwise than with the interrupt before both accesses of the
/// main program, and than with it after both.
struct LostWord {
  std::string situation;                ///< the memory and the inputs that it begins with
  std::uint32_t after = 0;              ///< the op of the main program after which the interrupt comes
  std::string place;                    ///< memory that is different in the end: `VW10`; several: `VW10, VW20`
  std::string between, before, behind;  ///< its values, in hex: of that run and of the two others
};

/// The largest times of a run with random inputs and characters.
struct SeenTimes {
  /// Of an event: how long its routine took, with the entry, and how long it waited.
  struct OfEvent {
    Time longest_routine = 0, latency = 0;
  };
  Time run = 0;  ///< how long it was, in ns of simulated time
  Time scan = 0;
  std::map<std::uint8_t, OfEvent> events;  ///< whose routine ran
};

/// A program with what is known of it, and what was asked about. The program may have errors; then what they are in is
/// unread (interpreter/program/loading/unread.hpp).
struct Inspection {
  std::shared_ptr<const Program> program;
  Waiter waiter;  ///< if it asks to end, views have what is known by then, and say so
  Facts facts;
  bool has_errors = false;  ///< then it is never run, also if all of it could be read
  Selection selection{};
  /// Looks for a run in which a race loses a word. Empty: none is looked for; whoever can run programs sets it.
  std::function<std::optional<LostWord>(const Inspection&, const Race&)> lose_word{};
  StatedLoops stated_loops{};  ///< how often loops run at most, as the user says
  bool ascii = false;          ///< drawings are made of characters that a 7-bit terminal has
  /// Runs the program. Empty, or nothing returned: it cannot be run.
  std::function<std::optional<SeenTimes>(const Inspection&)> see_times{};
  /// The program with the slowest times that are possible by their uncertainty. Empty: they are not known.
  std::function<std::shared_ptr<const Program>()> slowest{};

  explicit Inspection(std::shared_ptr<const Program> inspected, Waiter waits = {})
      : program(std::move(inspected)), waiter(std::move(waits)), facts(facts_of(*program, waiter)) {}

  /// For naming places: where pointers lead is left open.
  enum class WithoutPointers : std::uint8_t { Yes };
  Inspection(std::shared_ptr<const Program> inspected, WithoutPointers)
      : program(std::move(inspected)), facts(facts_without_pointers(*program)) {}

  bool was_interrupted() const { return waiter.stop.stop_requested(); }
};

/// Where an instruction stands, in the columns of Micro/WIN's cross reference: `SBR_3   2  slave.stl:120`.
std::string place_text(const Inspection& inspection, std::uint32_t op);
/// The same in running text: `SBR_3, network 2, slave.stl:120`.
std::string place_in_words(const Inspection& inspection, std::uint32_t op);
/// {"routine", "network", "file", "line", "instruction"}: the network is null in front of the first.
nlohmann::ordered_json place_json(const Inspection& inspection, std::uint32_t op);

/// File and line of an instruction, without the folder: `slave.stl:120`
std::string line_text(const Inspection& inspection, std::uint32_t op);

/// The routine that an instruction is in: `SBR_3`
std::string routine_at(const Inspection& inspection, std::uint32_t op);
/// A routine with the name of its block and its title: `SBR_3 "Pump control"`
std::string routine_in_words(const Inspection& inspection, const Routine& routine);

/// An instruction without the padding of listings: `MOVW Speed:VW10, VW12`
std::string instruction_text(const Inspection& inspection, std::uint32_t op);

/// Text for a column: padded to `width` characters, with at least one blank after it.
std::string column(std::string text, std::size_t width);

/// `text` in lines of up to 100 columns, each but the first after `indent` blanks. `used`: columns of the first line that
/// are taken.
std::string wrapped_at(std::string_view text, std::size_t indent, std::size_t used = 0);

/// `free: VB0, VB2 to VB9`, after `indent` blanks; nothing of an empty list.
std::string list_text(std::size_t indent, std::string_view what, const std::vector<std::string>& all);

/// A line of a table: what is before it, the place of an instruction, the instruction.
std::string row_text(const Inspection& inspection, const std::string& before, std::uint32_t op);

}  // namespace s7200::tools
