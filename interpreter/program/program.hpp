// A checked program: decoded, immutable, ready to execute. From here on nothing is looked up by name.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "interpreter/model/counters.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/times/times.hpp"
#include "interpreter/program/loading/looks.hpp"
#include "interpreter/program/loading/system_block.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// The place of an operand with an error. It is met only by the search for warnings in a program that has errors.
inline constexpr std::uint32_t kUnread = image::kSize;

/// The place of an operand in the image.
struct Operand {
  std::uint32_t at = 0;     ///< for a number that is part of the instruction (label, event …): the number itself
  std::uint8_t bit = 0;     ///< number of the bit in its byte
  bool pointer = false;     ///< `at` holds the pointer (a double word), not the value
  std::uint16_t width = 1;  ///< bytes

  bool unread() const { return at == kUnread; }
  bool operator==(const Operand&) const = default;
};

/// A decoded instruction.
struct Op {
  Body body = nullptr;          ///< what the loop calls: direct_body(), or a step around it
  Link link = nullptr;          ///< the same for the fast loop, alone or as a chain that begins here
  std::int32_t cost = 0;        ///< ns, with power flow and for these operands
  std::int32_t unit_cost = 0;   ///< additional ns for each bit, byte, word … (see the table of times)
  std::uint32_t skip_to = 0;    ///< next op if power flow is needed and missing
  std::uint32_t target = 0;     ///< next op of JMP, CALL, NEXT (loop body), FOR (after its NEXT); of a contact: in contacts;
                                ///< of S, R, SI, RI, SHRB: bits from the first one to the end of its area
  std::int32_t chain_cost = 0;  ///< ns, of the chain that begins here
  std::array<Operand, 3> operand{};
  std::uint8_t power_mask = 0;  ///< 1: needs power flow
  bool has_pointer = false;     ///< some operand is a pointer
  bool in_segment = false;      ///< between LSCR and SCRE
  bool sets_eno = false;        ///< a box with an ENO output, in a program that reads it
  bool is_contact = false;      ///< neither a box nor a coil, nor part of the structure of the program
  std::uint8_t inputs = 0;      ///< operands that it only reads, a bit each
  std::uint8_t outputs = 0;     ///< the others that it has
  const Instruction* instruction = nullptr;

  const Operand& operator[](std::size_t i) const { return operand[i]; }
  /// The instruction's own body, for operands that need no step around it.
  Body direct_body() const {
    const Bodies& own = instruction->body;
    return in_segment && own.in_segment ? own.in_segment : own.usual;
  }
};

/// A contact or a coil of a chain.
struct Contact {
  std::uint32_t at = 0;   ///< of its byte in the image
  std::uint8_t mask = 0;  ///< of its bit in the byte
  bool inverted = false;  ///< LDN, AN, ON
};

// Steps around a body, chosen at load if the operands need one; the CPU defines them.

/// Resolves pointer operands first, so that the body finds only direct ones.
void run_with_pointers(Core& core, const Op& op);
/// Runs the op where operand 0, or operand 1, is the only pointer.
void run_with_pointer_first(Core& core, const Op& op);
void run_with_pointer_second(Core& core, const Op& op);
/// Runs an instruction that writes special memory: the port follows SMB30.
void run_with_port_control(Core& core, const Op& op);
/// Sets ENO after a box; only in programs with AENO.
void run_with_eno(Core& core, const Op& op);
/// Runs an instruction that writes analog outputs: they have no image, so a change goes to the module at once.
void run_with_analog_output(Core& core, const Op& op);

/// Runs a CALL with parameters: copies them into the local memory of the subroutine. Operands 1 and 2 are not of the
/// instruction: they say where its parameters are in Program::parameters, and how many there are.
void run_with_parameters(Core& core, const Op& op);

inline constexpr std::uint32_t kNoRoutine = 0xFFFF'FFFF;

inline constexpr std::size_t kReaches = 16;  ///< pointer codes are below this

/// The memory that a pointer with a certain top byte can reach on the program's CPU.
struct Reach {
  std::uint32_t base = 0;  ///< in the image
  std::uint32_t size = 0;  ///< bytes; 0: nothing
};

inline constexpr std::size_t kMostParameters = 16;  ///< of a subroutine

/// A parameter of a CALL.
struct Parameter {
  Operand actual;  ///< the caller's
  Operand local;   ///< in the local memory of the subroutine
  Width width = Width::Byte;
  Role role = Role::In;
  bool real = false;  ///< of type REAL
};

/// Bytes of V memory that the data block sets.
struct InitialData {
  std::uint32_t offset = 0;
  std::vector<std::uint8_t> bytes;
};

struct Program {
  const CpuModel* model = nullptr;
  TimeTable times;
  stl::Source source;
  std::vector<stl::Statement> statements;  ///< one for each op
  std::vector<Op> ops;
  std::vector<Contact> contacts{};              ///< of the chains
  std::vector<Body> box_body;                   ///< what run_with_eno() calls, for each op; empty in a program without AENO
  std::vector<std::uint8_t> constants;          ///< content of the image from image::kConstants
  std::vector<Parameter> parameters{};          ///< of all CALLs
  std::vector<InitialData> data{};              ///< downloaded with the program
  SystemBlock system_block{};                   ///< the same
  std::array<std::uint32_t, 128> subroutine{};  ///< op of each SBR; kNoRoutine where there is none
  std::array<std::uint32_t, 128> interrupt{};   ///< op of each INT

  std::vector<std::uint8_t> timers_1ms, timers_10ms, timers_100ms;  ///< numbers of the timers that the program uses
  bool uses_timers = false;
  Looks looks{};
  bool uses_local_memory = false;
  std::array<bool, kPorts.size()> receives_messages{};  ///< with RCV, by port
  std::array<CounterModes, kCounters.size()> counter_modes{};  ///< that it gives each high-speed counter, with HDEF
  Areas pointed_at = 0;                                 ///< areas of the addresses that it makes pointers of, with &
  std::array<Reach, kReaches> reach{};                  ///< by the top byte of a pointer
  std::vector<std::uint32_t> reals;  ///< double words that some instruction uses as a real: places in the image, sorted

  // Times that the CPU needs while running, taken from `times`.
  Time no_power_flow = 0, interrupt_entry = 0, eeprom_save = 0;
  /// Parts of a scan other than the program, in order.
  enum ScanPart : std::size_t { kReadInputs, kCommunication, kSelfTest, kWriteOutputs };
  std::array<Time, kWriteOutputs + 1> scan_phase{};  ///< by ScanPart

  const stl::Statement& statement(std::uint32_t op) const { return statements[op]; }

  /// The ranges that survive power off: as the system block says, or as the CPU is delivered.
  const std::vector<RetentiveRange>& retentive() const {
    return system_block.retentive ? *system_block.retentive : model->retentive;
  }

  /// Whether some instruction uses the double word at this place of the image as a real number.
  bool is_real(std::uint32_t at) const { return std::binary_search(reals.begin(), reals.end(), at); }
};

}  // namespace s7200
