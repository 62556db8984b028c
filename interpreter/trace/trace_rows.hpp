// One row for each kind of record: its name, what the members of a record mean for it, and how it reads. Every format of a
// trace is written from these rows.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

class EventText;

enum class FieldType : std::uint8_t {
  Number,     ///< a whole number
  Flag,       ///< 0 or 1
  Instant,    ///< an instant, in ns of simulated time
  Interval,   ///< in ns
  Statement,  ///< the index of an instruction; kNoRoutine: none, between two scans
  Words       ///< a text
};

struct TraceField {
  std::string_view name;
  FieldType type{};
  std::int64_t (*number)(const TraceRecord&) = nullptr;  ///< of all types but Words
  std::string (*words)(const TraceRecord&) = nullptr;
};

struct TraceRow {
  TraceKind kind{};
  std::string_view name;               ///< `service_begin`
  std::span<const TraceField> fields;  ///< besides the instant and the port
  bool of_port = false;                ///< whether the record is about a port

  /// Appends the record in words, without its time and port.
  void (*say)(EventText&, fmt::memory_buffer&, const TraceRecord&) = nullptr;
};

/// In the order of TraceKind.
std::span<const TraceRow> trace_rows();
const TraceRow& row_of(TraceKind kind);

}  // namespace s7200
