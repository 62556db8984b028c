// The files of instruction vectors: reading and writing. The format is described in README.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::vectors {

/// `VW100=16#1234`, `M0.3=1`, `LD4=16#1`, `T33=5`, `T33.bit=1`, `AC0=16#12345678`, `PIB0=16#01` (input points), `PQB0=16#01`
/// (output points).
struct Assignment {
  std::string area;        ///< I Q M SM S V L AI AQ T C HC AC PI PQ; T.bit and C.bit
  std::uint32_t at = 0;    ///< byte in the area
  std::uint8_t width = 1;  ///< bytes; 0: one bit
  std::uint8_t bit = 0;
  std::uint32_t value = 0;

  bool operator==(const Assignment&) const = default;
};

/// Nothing for a text that is not an assignment.
std::optional<Assignment> parse_assignment(std::string_view text);
std::string to_text(const Assignment& assignment);

/// A logic stack, S0 first.
using Levels = std::vector<bool>;

struct Vector {
  std::string cpu{"214"};        ///< of the file
  std::string title;             ///< a line of comment in front of it
  std::vector<std::string> ops;  ///< one instruction, or a whole program
  std::vector<Assignment> before, after;
  Levels stack{true};                 ///< before; levels not given are 0
  std::optional<Levels> leaves;       ///< after; nothing: the stack stays as it is
  std::uint32_t steps = 1;            ///< instructions executed
  std::optional<std::int64_t> until;  ///< ns since power-up, instead of steps: the program runs, scan after scan
  std::optional<std::uint32_t> next;  ///< op to execute next; nothing: the following one
  bool ends = false;                  ///< `next end`: the program has ended for this scan
  bool stops = false;                 ///< `next stop`: the CPU has gone to STOP
  int error = 0, fatal = 0;
  std::optional<std::int64_t> time;  ///< ns; not given with `until`
  std::string source;
  std::string expected_failure{};  ///< why the interpreter does not do so yet; empty: it does

  bool is_program() const { return ops.size() > 1; }
  std::size_t line = 0;  ///< of its first op in the file
};

struct File {
  std::vector<std::string> heading;  ///< comment lines at the top
  std::string cpu{"214"};            ///< `cpu 224` after the heading: of all vectors in the file
  std::vector<Vector> vectors;
};

/// Throws a std::runtime_error that names the line.
File parse(std::string_view text, const std::string& name);
std::string to_text(const File& file);

/// What a mark makes of what is wrong with a vector (empty: nothing): a known gap must be there.
std::string judged(const Vector& vector, const std::string& wrong);

/// Puts the marks of `from` on the same vectors of `to`: what is generated anew keeps them.
void keep_marks(const File& from, File& to);

/// Name of the file for a mnemonic, without extension: `ADD_I` for `+I`, `LDW_GE` for `LDW>=`; `ADD_I.224` for a CPU 224.
std::string file_name(std::string_view mnemonic, std::string_view cpu = "214");

}  // namespace s7200::vectors
