// The script that drives the inputs over time, as plain data, and its CSV form.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/time.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::serial {

/// A change of one input byte; only the bits in `mask` change.
struct FieldChange {
  Time at = 0;
  std::uint32_t place = 0;  ///< in the image: an input point's byte, AI, or a potentiometer or the mode switch in SM
  std::uint8_t mask = 0xFF;
  std::uint8_t value = 0;
  bool operator==(const FieldChange&) const = default;
};

/// Pulses of an input point, each a 1 half and a 0 half.
struct FieldPulses {
  Time at = 0;
  std::uint32_t place = 0;
  std::uint8_t mask = 0;
  std::uint64_t pulses = 0;
  std::uint64_t millihertz = 0;

  /// Edge 0 rises at `at`; never accumulated, rounded down to the nanosecond.
  Time edge(std::uint64_t number) const;
  std::uint64_t edges() const { return 2 * pulses; }
  bool operator==(const FieldPulses&) const = default;
};

/// The field's changes and pulses, each in the order of time.
struct FieldScript {
  std::vector<FieldChange> changes;
  std::vector<FieldPulses> pulses;
  bool operator==(const FieldScript&) const = default;
};

/// Reads
///
///   time,address,value
///   10ms,I0.3,1                      a bit, byte or word of I, a word of AI, SMB28, SMB29, SM0.7, or a symbol of one
///   1.5s,I0.6,pulses,5kHz,200ms      whole pulses of that frequency, as many as the duration holds
///
/// Where the first row has semicolons or tabs, they separate, and numbers may have a decimal comma. The heading may be left
/// out, # at the start of a line or after a blank begins a comment, times ascend. Errors, each `name:line: what, and what to
/// do`: nothing is to be done with a script that has any.
FieldScript parse_field_script(std::string_view csv, const std::string& name, const AddressSpace& space,
                               std::vector<std::string>& errors);

}  // namespace s7200::serial
