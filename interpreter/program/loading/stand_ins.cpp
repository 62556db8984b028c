#include "interpreter/program/loading/stand_ins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/loading/embedded_libraries.hpp"
#include "interpreter/stl/blocks.hpp"
#include "interpreter/stl/tables/project.hpp"
#include "interpreter/stl/tables/symbol_table.hpp"
#include "interpreter/stl/tables/symbols.hpp"

namespace s7200 {
namespace {

/// A library at one of the ports.
struct Library {
  std::string_view file;  ///< in stl_programs/libraries, with the suffix
  std::string_view text, symbols;
  std::string_view suffix;  ///< of the names of its routines
  std::string_view port;    ///< symbols of what belongs to the port
  CpuSet cpus;              ///< that can have it
  std::span<const std::string_view> routines;
  std::string_view memory;  ///< the symbol by which a program says where the library's variables are
};

constexpr std::array<std::string_view, 2> kSlaveRoutines{"MBUS_INIT", "MBUS_SLAVE"};
constexpr std::array<std::string_view, 2> kMasterRoutines{"MBUS_CTRL", "MBUS_MSG"};

constexpr std::array kLibraries{
    Library{"modbus_slave.awl", embedded::kModbusSlave, embedded::kModbusSlaveSymbols, "", embedded::kPort0Symbols, kCpu22x,
            kSlaveRoutines, "Modbus_Slave_Memory"},
    Library{"modbus_slave_P1.awl", embedded::kModbusSlave, embedded::kModbusSlaveSymbols, "_P1", embedded::kPort1Symbols,
            kCpu22x& kTwoPorts, kSlaveRoutines, "Modbus_Slave_Memory_P1"},
    Library{"modbus_master.awl", embedded::kModbusMaster, embedded::kModbusMasterSymbols, "", embedded::kPort0Symbols,
            kCpu22xRelease2, kMasterRoutines, "Modbus_Master_Memory"},
    Library{"modbus_master_P1.awl", embedded::kModbusMaster, embedded::kModbusMasterSymbols, "_P1", embedded::kPort1Symbols,
            kCpu22xRelease2& kTwoPorts, kMasterRoutines, "Modbus_Master_Memory_P1"},
};

// Symbols of a stand-in that depend on the CPU, or say how much memory it takes.
constexpr std::string_view kMemory = "mbMemory", kMemorySize = "mbMemorySize", kCpuMemory = "mbCpuMemory",
                           kCpuFastest = "mbCpuFastest";
/// Symbols of the library that programs use.
constexpr std::string_view kPublic = "mModbus";

constexpr std::string_view kStandIn = "stand-in:";

std::string name_of(const Library& library) { return fmt::format("{}{}", kStandIn, library.file); }

std::string text_of(const Library& library) { return fmt::format("{}\n{}", library.text, embedded::kModbusCrc); }

std::string qualified(std::string_view file, std::string_view symbol) { return fmt::format("{}:{}", file, symbol); }

/// The name that a CALL is written with: MBUS_INIT of `"MBUS_INIT":SBR1`.
std::string_view routine_name(std::string_view written) {
  if (written.starts_with('"')) return written.substr(1, written.find('"', 1) - 1);
  return written.substr(0, written.find(':'));
}

/// The number at the end of `SBR_0`, `INT3` or `MBUS_INIT:SBR1`.
std::optional<std::uint32_t> number_at_end(std::string_view text) {
  const std::size_t digits = text.find_last_not_of("0123456789") + 1;
  std::uint32_t number = 0;
  const auto [end, trouble] = std::from_chars(text.data() + digits, text.data() + text.size(), number);
  return trouble == std::errc{} ? std::optional(number) : std::nullopt;
}

/// Calls `see(kind, operand)` for each operand of a statement that is a number of its own kind: a label, a routine.
template <typename Statement, typename See>
void for_each_number(Statement& statement, const See& see) {
  const Instruction* const instruction = find_instruction(statement.mnemonic);
  if (!instruction) return;
  const auto rules = instruction->rules();
  for (std::size_t i = 0; i < std::min(rules.size(), statement.operands.size()); ++i)
    see(rules[i].kind, statement.operands[i]);
}

/// The numbers of one kind that a program uses, and free ones.
class Numbers {
 public:
  explicit Numbers(std::uint32_t count) : count_(count) {}

  void take(std::uint32_t number) { taken_.insert(number); }

  /// The highest that is free, which is taken from now on. Nothing if there is none.
  std::optional<std::uint32_t> next() {
    for (std::uint32_t number = count_; number-- > 0;)
      if (taken_.insert(number).second) return number;
    return {};
  }

 private:
  std::uint32_t count_;
  std::set<std::uint32_t> taken_;
};

/// The bytes of V memory that a program names.
class UsedMemory {
 public:
  explicit UsedMemory(std::uint32_t size) : used_(size) {}

  void take(std::size_t first, std::size_t bytes) {
    for (std::size_t i = first; i < std::min(first + bytes, used_.size()); ++i) used_[i] = true;
  }

  /// The highest place with so many free bytes.
  std::optional<std::uint32_t> free_place(std::size_t bytes) const {
    std::size_t free = 0;
    for (std::size_t i = used_.size(); i-- > 0;) {
      free = used_[i] ? 0 : free + 1;
      if (free == bytes) return static_cast<std::uint32_t>(i);
    }
    return {};
  }

 private:
  std::vector<bool> used_;
};

constexpr std::size_t kFromPointer = 256;  // a frame, a string, a table: nobody knows how long

/// Bytes from an address on that an operand may reach.
std::size_t reach(const stl::Statement& statement, std::size_t i) {
  const Instruction* const instruction = find_instruction(statement.mnemonic);
  const auto rules = instruction ? instruction->rules() : std::span<const OperandRule>{};
  const bool frame = std::ranges::find(rules, OperandKind::Port, &OperandRule::kind) != rules.end();
  if (frame) return kFromPointer;
  if (i >= rules.size()) return 0;  // a parameter
  if (rules[i].counted == 0) return std::size_t{rules[i].elements} * bytes_of(rules[i].width);
  const auto counts = std::ranges::find_if(rules, &OperandRule::count);
  const auto* const count =
      counts == rules.end() || statement.operands.size() != rules.size()
          ? nullptr
          : std::get_if<stl::Integer>(&statement.operands[static_cast<std::size_t>(counts - rules.begin())].value);
  if (!count) return kFromPointer * bytes_of(rules[i].width);
  return static_cast<std::size_t>(rules[i].reach(std::abs(count->value))) * bytes_of(rules[i].width);
}

/// Libraries of Siemens for Micro/WIN that have no stand-in, by how the names of their routines begin.
struct OtherLibrary {
  std::string_view prefix, name;
};

constexpr std::array kOtherLibraries{
    OtherLibrary{"USS4", "USS protocol"}, OtherLibrary{"USS_", "USS protocol"}, OtherLibrary{"MBUS_", "Modbus protocol"},
    OtherLibrary{"S_ITR", "Scaling"},     OtherLibrary{"S_RTI", "Scaling"},     OtherLibrary{"S_ITI", "Scaling"},
};

bool is_routine_of(const Library& library, std::string_view routine) {
  return std::ranges::any_of(library.routines, [&](std::string_view each) {
    return routine.starts_with(each) && routine.substr(each.size()) == library.suffix;
  });
}

bool is_routine_of_any(std::string_view routine) {
  return std::ranges::any_of(kLibraries, [&](const Library& library) { return is_routine_of(library, routine); });
}

/// The routine that a CALL calls by a name that is not resolved, in capitals; empty if it is no such CALL.
std::string called_by_name(const stl::Statement& statement) {
  if (statement.mnemonic != "CALL" || statement.operands.empty()) return {};
  const auto* name = std::get_if<stl::Name>(&statement.operands.front().value);
  return name ? stl::upper_case(routine_name(name->text)) : std::string();
}

/// Notes what a CALL outside of the stand-in calls of it.
void add_call(const stl::Line& line, const stl::Source& program, StandIn& stand_in) {
  const auto* statement = std::get_if<stl::Statement>(&line);
  if (!statement || statement->mnemonic != "CALL" || statement->operands.empty()) return;
  const auto* number = std::get_if<stl::Integer>(&statement->operands.front().value);
  if (!number || stl::in_file(program, statement->position.line).file == stand_in.file) return;
  const auto routine = std::ranges::find_if(program.blocks, [&](const stl::Block& block) {
    return block.kind == stl::Block::Kind::Subroutine && block.number == number->value &&
           stl::in_file(program, block.position.line).file == stand_in.file;
  });
  if (routine == program.blocks.end()) return;
  if (stand_in.routines.empty()) stand_in.call = statement->operands.front().position;
  if (std::ranges::find(stand_in.routines, routine->name) == stand_in.routines.end())
    stand_in.routines.push_back(routine->name);
}

constexpr std::string_view kWriteYourOwn =
    "write a subroutine of this name with the same parameters (SUBROUTINE_BLOCK …) and give its file too";

class Linker {
 public:
  Linker(stl::ParseResult& program, const CpuModel& model)
      : program_(program),
        model_(model),
        subroutines_(model.subroutines),
        interrupts_(model.interrupts),
        labels_(model.labels),
        memory_(model.size_of(Area::V)) {
    for (const stl::Symbol& symbol : program.source.symbols) symbols_.emplace(stl::upper_case(symbol.name), &symbol);
  }

  StandInFiles result() && {
    for (const Library& library : kLibraries)
      if (const auto calls = calls_of(library); !calls.empty() && (library.cpus & model_.self)) link(library, calls);
    auto& symbols = source().symbols;
    symbols.insert(symbols.end(), published_.begin(), published_.end());
    return std::move(files_);
  }

 private:
  struct Call {
    stl::Statement* statement;
    std::string routine;  // in capitals
  };

  stl::Source& source() { return program_.source; }

  template <typename See>
  void for_each_statement(const See& see) {
    for (stl::Line& line : source().lines)
      if (auto* statement = std::get_if<stl::Statement>(&line)) see(*statement);
  }

  // --- what the program calls, and has ---

  std::vector<Call> calls_of(const Library& library) {
    std::vector<Call> calls;
    for_each_statement([&](stl::Statement& statement) {
      std::string routine = called_by_name(statement);
      if (routine.empty() || !is_routine_of(library, routine)) return;
      if (!has(routine, std::get<stl::Name>(statement.operands.front().value).text))
        calls.push_back({&statement, std::move(routine)});
    });
    return calls;
  }

  /// The program's symbol of this name, in any capitals; null if it has none.
  const stl::Symbol* own_symbol(std::string_view name) const {
    const auto found = symbols_.find(stl::upper_case(name));
    return found == symbols_.end() ? nullptr : found->second;
  }

  /// Whether the program has a block of this name, or a subroutine with the number that its name stands for.
  bool has(const std::string& routine, std::string_view written) {
    const auto& blocks = source().blocks;
    if (std::ranges::any_of(blocks, [&](const stl::Block& b) { return stl::upper_case(b.name) == routine; })) return true;
    std::optional<std::uint32_t> number;
    if (written.find(':') != std::string_view::npos) number = number_at_end(written);
    if (const stl::Symbol* symbol = number ? nullptr : own_symbol(routine))
      if (const auto* block = symbol->value ? std::get_if<stl::Name>(&*symbol->value) : nullptr)
        number = number_at_end(block->text);
    return number && has_subroutine(*number);
  }

  bool has_subroutine(std::uint32_t number) {
    bool found = false;
    for_each_statement([&](const stl::Statement& statement) {
      if (statement.mnemonic != "SBR" || statement.operands.empty()) return;
      const auto* written = std::get_if<stl::Integer>(&statement.operands.front().value);
      found |= written && written->value == number;
    });
    return found;
  }

  void note_what_is_taken() {
    for_each_statement([&](const stl::Statement& statement) {
      for_each_number(statement, [&](OperandKind kind, const stl::Operand& operand) { take_number(kind, operand); });
      for (std::size_t i = 0; i < statement.operands.size(); ++i)
        take_memory(resolved(statement.operands[i].value), reach(statement, i));
      if (statement.mnemonic == "CALL") take_holding_registers(statement);
    });
    for (const stl::Block& block : source().blocks)
      if (Numbers* numbers = numbers_of(block.kind)) numbers->take(block.number);
    for (const stl::Symbol& symbol : source().symbols)
      if (symbol.value) take_memory(*symbol.value, 0);
    for (const stl::DataLine& line : source().data)
      if (line.address) take_memory(line.address->value, kFromPointer);
  }

  Numbers* numbers_of(OperandKind kind) {
    switch (kind) {
      case OperandKind::Subroutine:
        return &subroutines_;
      case OperandKind::Interrupt:
        return &interrupts_;
      case OperandKind::Label:
        return &labels_;
      default:
        return nullptr;
    }
  }

  Numbers* numbers_of(stl::Block::Kind kind) {
    return kind == stl::Block::Kind::Subroutine  ? &subroutines_
           : kind == stl::Block::Kind::Interrupt ? &interrupts_
                                                 : nullptr;
  }

  void take_number(OperandKind kind, const stl::Operand& operand) {
    Numbers* const numbers = numbers_of(kind);
    if (!numbers) return;
    if (const auto* integer = std::get_if<stl::Integer>(&operand.value))
      numbers->take(static_cast<std::uint32_t>(integer->value));
    if (const auto* name = std::get_if<stl::Name>(&operand.value))
      if (const auto number = number_at_end(name->text)) numbers->take(*number);
  }

  /// The address that the symbol in an operand stands for; a name that is not in the symbol table stays one.
  stl::OperandValue resolved(const stl::OperandValue& value) const {
    const auto* name = std::get_if<stl::Name>(&value);
    if (!name || name->text.empty()) return value;
    const bool marked = name->text.front() == '&' || name->text.front() == '*';
    const stl::Symbol* symbol = own_symbol(routine_name(std::string_view(name->text).substr(marked ? 1 : 0)));
    if (!symbol || !symbol->value) return value;
    const auto* address = std::get_if<stl::Address>(&*symbol->value);
    if (!marked || !address) return *symbol->value;
    return name->text.front() == '&' ? stl::OperandValue{stl::AddressOf{*address}} : stl::Indirect{*address};
  }

  static std::size_t bytes_of_size(stl::Size size) {
    return size == stl::Size::Double ? 4 : size == stl::Size::Word ? 2 : 1;
  }

  void take_memory(const stl::OperandValue& value, std::size_t reach) {
    const auto* address = std::get_if<stl::Address>(&value);
    if (address && address->area == "V") memory_.take(address->number, std::max(reach, bytes_of_size(address->size)));
    if (const auto* pointer = std::get_if<stl::Indirect>(&value); pointer && pointer->pointer.area == "V")
      memory_.take(pointer->pointer.number, 4);
    if (const auto* target = std::get_if<stl::AddressOf>(&value); target && target->target.area == "V")
      memory_.take(target->target.number, kFromPointer);
  }

  /// MBUS_INIT, …, MaxHold, HoldStart, Done, Error
  void take_holding_registers(const stl::Statement& call) {
    constexpr std::size_t kMaxHold = 8, kHoldStart = 9;
    if (call.operands.size() <= kHoldStart) return;
    const stl::OperandValue first = resolved(call.operands[kHoldStart].value),
                            size = resolved(call.operands[kMaxHold].value);
    const auto* const start = std::get_if<stl::AddressOf>(&first);
    const auto* const count = std::get_if<stl::Integer>(&size);
    if (start && count && start->target.area == "V")
      memory_.take(start->target.number, 2 * static_cast<std::size_t>(std::max<std::int64_t>(count->value, 0)));
  }

  // --- a stand-in ---

  void link(const Library& library, const std::vector<Call>& calls) {
    if (!std::exchange(noted_, true)) note_what_is_taken();
    stl::ParseResult file = read(library);
    const auto place = place_memory(library, size_of_memory(file.source), calls.front());
    if (!renumber(library, file.source, calls)) return;
    fit(file.source.symbols, place.value_or(0));
    stl::resolve_symbols(file);
    publish(file.source.symbols);
    for (const Call& call : calls) {
      stl::Operand& callee = call.statement->operands.front();
      callee.symbol = std::get<stl::Name>(callee.value).text;
      callee.value = stl::Integer{number_of(call.routine, file.source)};
    }
    keep_memory_symbols(file.source);
    files_.push_back(std::move(file));
  }

  /// Under names that no program can have: modbus_slave.awl:mbMemory.
  static void keep_memory_symbols(stl::Source& file) {
    std::erase_if(file.symbols,
                  [](const stl::Symbol& symbol) { return symbol.name != kMemory && symbol.name != kMemorySize; });
    for (stl::Symbol& symbol : file.symbols) symbol.name = qualified(file.name, symbol.name);
  }

  static stl::ParseResult read(const Library& library) {
    stl::ParseResult file = stl::read_blocks(text_of(library), name_of(library));
    for (const std::string_view table : {library.symbols, library.port}) {
      const stl::ParseResult symbols = stl::read_symbol_table(table, {});
      file.source.symbols.insert(file.source.symbols.end(), symbols.source.symbols.begin(), symbols.source.symbols.end());
    }
    for (stl::Block& block : file.source.blocks)
      if (std::ranges::find(library.routines, block.name) != library.routines.end()) block.name += library.suffix;
    return file;
  }

  static std::uint32_t size_of_memory(const stl::Source& source) {
    return static_cast<std::uint32_t>(std::get<stl::Integer>(*stl::find_symbol(source.symbols, kMemorySize)->value).value);
  }

  /// The address of the library's memory: where the program puts it, or a free place. Nothing after a message.
  std::optional<std::uint32_t> place_memory(const Library& library, std::uint32_t bytes, const Call& call) {
    std::optional<std::uint32_t> place;
    if (const stl::Symbol* chosen = own_symbol(library.memory)) {
      const auto* address = chosen->value ? std::get_if<stl::Address>(&*chosen->value) : nullptr;
      if (!address || address->area != "V" || address->number + bytes > model_.size_of(Area::V))
        return error(chosen->position, fmt::format("{} is not a place for {} bytes of V memory", library.memory, bytes),
                     fmt::format("CPU {} has VB0 to VB{}", model_.name, model_.size_of(Area::V) - 1));
      place = address->number;
    } else {
      place = memory_.free_place(bytes);
    }
    if (!place)
      return error(call.statement->operands.front().position,
                   fmt::format("there are no {} free bytes of V memory for {}", bytes, library.file),
                   fmt::format("say where they may be: a row of a symbol table with {} and VB…", library.memory));
    memory_.take(*place, bytes);
    return place;
  }

  std::optional<std::uint32_t> error(const stl::Position& at, std::string message, std::string hint) {
    program_.diagnostics.push_back({stl::Severity::Error, at, std::move(message), std::move(hint)});
    return {};
  }

  /// Gives blocks and labels free numbers. False after a message.
  bool renumber(const Library& library, stl::Source& file, const std::vector<Call>& calls) {
    std::map<std::pair<OperandKind, std::int64_t>, std::uint32_t> renumbered;
    bool room = true;
    const auto of = [&](OperandKind kind, std::int64_t number) {
      const auto [found, is_new] = renumbered.try_emplace({kind, number});
      if (!is_new) return found->second;
      const auto free = numbers_of(kind)->next();
      room &= free.has_value();
      return found->second = free.value_or(0);
    };
    for (stl::Block& block : file.blocks)
      block.number =
          of(block.kind == stl::Block::Kind::Subroutine ? OperandKind::Subroutine : OperandKind::Interrupt, block.number);
    for (stl::Line& line : file.lines)
      if (auto* statement = std::get_if<stl::Statement>(&line))
        for_each_number(*statement, [&](OperandKind kind, stl::Operand& operand) {
          if (auto* integer = std::get_if<stl::Integer>(&operand.value); integer && numbers_of(kind))
            integer->value = of(kind, integer->value);
        });
    if (!room)
      error(calls.front().statement->operands.front().position,
            fmt::format("there are no free numbers of routines or labels for {}", library.file),
            fmt::format("CPU {} has {} subroutines, {} interrupt routines and {} labels", model_.name, model_.subroutines,
                        model_.interrupts, model_.labels));
    return room;
  }

  /// Symbols of V memory are where the library's memory is, but for those that the program has in its own table; what the
  /// CPU does not have of analog inputs is 0.
  void fit(std::vector<stl::Symbol>& symbols, std::uint32_t place) const {
    for (stl::Symbol& symbol : symbols) {
      auto* const address = std::get_if<stl::Address>(&*symbol.value);
      if (address && address->area == "V") address->number += place;
      if (address && address->area == "AI" && address->number >= model_.size_of(Area::AI)) symbol.value = stl::Integer{0};
      const stl::Symbol* own = symbol.name.starts_with(kPublic) ? own_symbol(symbol.name) : nullptr;
      if (own && own->value) symbol.value = own->value;
      if (symbol.name == kCpuMemory) symbol.value = stl::Integer{model_.size_of(Area::V)};
      if (symbol.name == kCpuFastest) symbol.value = stl::Integer{*std::ranges::max_element(model_.baud)};
    }
  }

  /// The program's own symbols go first, then those of port 0.
  void publish(const std::vector<stl::Symbol>& symbols) {
    for (const stl::Symbol& symbol : symbols)
      if (symbol.name.starts_with(kPublic) && !own_symbol(symbol.name) && !stl::find_symbol(published_, symbol.name))
        published_.push_back(symbol);
  }

  static std::uint32_t number_of(std::string_view routine, const stl::Source& file) {
    return std::ranges::find(file.blocks, routine, &stl::Block::name)->number;
  }

  stl::ParseResult& program_;
  const CpuModel& model_;
  Numbers subroutines_, interrupts_, labels_;
  UsedMemory memory_;
  std::map<std::string, const stl::Symbol*> symbols_;  // of the program, by their names in capitals
  std::vector<stl::Symbol> published_;                 // of the libraries, for the program
  StandInFiles files_;
  bool noted_ = false;  // what the program takes
};

/// The routine of its library that a program calls before the others.
std::string initial_routine(const StandIn& stand_in) {
  const auto library = std::ranges::find(kLibraries, stand_in.file, name_of);
  return fmt::format("{}{}", library->routines.front(), library->suffix);
}

std::string in_no_export(const StandIn& stand_in) {
  return fmt::format("{} {} in no export", fmt::join(stand_in.routines, " and "),
                     stand_in.routines.size() == 1 ? "is" : "are");
}

}  // namespace

StandInFiles link_stand_ins(stl::ParseResult& program, const CpuModel& model) { return Linker(program, model).result(); }

bool has_stand_in(const stl::Statement& call) {
  const std::string routine = called_by_name(call);
  return !routine.empty() && is_routine_of_any(routine);
}

bool is_library_routine(std::string_view name) {
  const std::string routine = stl::upper_case(name);
  return is_routine_of_any(routine) || std::ranges::any_of(kOtherLibraries, [&](const OtherLibrary& library) {
           return routine.starts_with(library.prefix);
         });
}

namespace {

/// A wizard of the programming software, and what the names of its routines begin with: `PID0_INIT`, `NET_EXE`.
struct Wizard {
  std::string_view prefix;
  bool numbered;
  std::string_view name;
};
constexpr std::array kWizards{
    Wizard{"NET_EXE", false, "NETR/NETW wizard"},
    Wizard{"HSC_INIT", false, "HSC wizard"},
    Wizard{"PID", true, "PID wizard"},
    Wizard{"POS", true, "position control wizard"},
    Wizard{"PTO", true, "pulse output wizard"},
    Wizard{"PWM", true, "pulse output wizard"},
    Wizard{"MOD", true, "modem wizard"},
    Wizard{"ETH", true, "Ethernet wizard"},
    Wizard{"RCP", true, "recipe wizard"},
    Wizard{"DAT", true, "data log wizard"},
    Wizard{"ASI", true, "AS-i wizard"},
    Wizard{"AXIS", true, "motion wizard (SMART)"},
};

const Wizard* wizard_of(std::string_view routine) {
  const auto made = std::ranges::find_if(kWizards, [routine](const Wizard& wizard) {
    if (!routine.starts_with(wizard.prefix)) return false;
    const std::string_view rest = routine.substr(wizard.prefix.size());
    const std::size_t digits = std::min(rest.find_first_not_of("0123456789X"), rest.size());
    return wizard.numbered ? digits > 0 && rest.substr(digits).starts_with('_') : rest.empty();
  });
  return made == kWizards.end() ? nullptr : &*made;
}

}  // namespace

bool may_need_stand_ins(const stl::ParseResult& program) {
  return std::ranges::any_of(program.source.lines, [](const stl::Line& line) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    return statement && has_stand_in(*statement);
  });
}

MissingRoutine missing_routine(const stl::Name& name, const CpuModel& model) {
  const std::string routine = stl::upper_case(routine_name(name.text));
  const std::string shown = stl::shortened(routine_name(name.text));
  for (const Library& library : kLibraries)
    if (is_routine_of(library, routine) && !(library.cpus & model.self))
      return {fmt::format("{} is a routine of a library that CPU {} cannot have", shown, model.name),
              needs("the library needs", library.cpus), fmt::format("library {}", library.file)};
  for (const OtherLibrary& library : kOtherLibraries)
    if (routine.starts_with(library.prefix) && !is_routine_of_any(routine))
      return {fmt::format("{} is a routine of the {} library, which is in no export and has no stand-in here", shown,
                          library.name),
              std::string(kWriteYourOwn), fmt::format("library {}", library.name)};
  if (const auto* const wizard = wizard_of(routine))
    return {fmt::format("{}: the {} of Micro/WIN has made it", name.reason, wizard->name),
            "its block is in the project: export it, too (File, Export), and give its file",
            fmt::format("wizard {}", wizard->name)};
  return {name.reason,
          "give the file with its block too; the blocks of libraries are in no export: " + std::string(kWriteYourOwn),
          name.reason};
}

bool is_stand_in(std::string_view file) { return number_of_stand_in(file).has_value(); }

std::optional<std::size_t> number_of_stand_in(std::string_view file) {
  const auto library = std::ranges::find(kLibraries, file, [](const Library& each) { return name_of(each); });
  return library == kLibraries.end() ? std::nullopt
                                     : std::optional(static_cast<std::size_t>(library - kLibraries.begin()) + 1);
}

std::string stand_in_text(std::size_t number) {
  return number >= 1 && number <= kLibraries.size() ? text_of(kLibraries[number - 1]) : std::string();
}

std::vector<StandIn> stand_ins_of(const stl::Source& program) {
  std::vector<StandIn> all;
  for (const stl::FurtherFile& file : program.further_files) {
    const auto value = [&](std::string_view symbol) {
      const auto* const found = stl::find_symbol(program.symbols, qualified(file.name, symbol));
      return found ? found->value : std::nullopt;
    };
    const auto memory = value(kMemory), size = value(kMemorySize);
    const auto* const first = memory ? std::get_if<stl::Address>(&*memory) : nullptr;
    const auto* const bytes = size ? std::get_if<stl::Integer>(&*size) : nullptr;
    if (!first || !bytes) continue;  // a file on the disk that has the name of one
    StandIn& stand_in = all.emplace_back();
    stand_in.file = file.name;
    stand_in.memory = first->number;
    stand_in.bytes = static_cast<std::uint32_t>(bytes->value);
    for (const stl::Line& line : program.lines) add_call(line, program, stand_in);
  }
  return all;
}

std::string to_text(const StandIn& stand_in) {
  const std::string_view name = std::string_view(stand_in.file).substr(stand_in.file.find(':') + 1);
  const std::string initial = initial_routine(stand_in);
  const bool initialised = std::ranges::find(stand_in.routines, initial) != stand_in.routines.end();
  return fmt::format("{}: our stand-in {} is used, with times of our own; its variables are VB{} to VB{}{}",
                     in_no_export(stand_in), name, stand_in.memory, stand_in.memory + stand_in.bytes - 1,
                     initialised ? "" : fmt::format("; nothing calls its {}, which switches it on", initial));
}

stl::Diagnostic refusal(const StandIn& stand_in) {
  return {stl::Severity::Error, stand_in.call, in_no_export(stand_in),
          fmt::format("--no-stand-ins refuses the stand-in for its library: {}", kWriteYourOwn)};
}

}  // namespace s7200
