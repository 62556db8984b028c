#include "interpreter/trace/trace_rows.hpp"

#include <iterator>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/special_bits.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "interpreter/trace/text/event_lines.hpp"
#include "interpreter/trace/text/line_parts.hpp"
#include "interpreter/trace/text/ppi_words.hpp"
#include "interpreter/trace/trace_reasons.hpp"

namespace s7200 {
namespace {

using Text = fmt::memory_buffer;

/// `0f`, as bytes of frames are written.
void append_byte(Text& text, std::uint8_t byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  text.push_back(kDigits[byte >> 4]);
  text.push_back(kDigits[byte & 15]);
}

void append_character(Text& text, const TraceRecord& r) {
  append_byte(text, r.byte);
  if (r.parity_error) append(text, " parity error");
  if (r.framing_error) append(text, " framing error");
}

/// Why a message has ended, after the bits of SMB86.
std::string status_text(std::uint8_t status) {
  const std::string reasons = special_meanings_text(kPorts[0].message, status);
  return fmt::format("status 16#{:02X}{}", status, reasons.empty() ? "" : fmt::format(" ({})", reasons));
}

// --- the members of a record, by what they mean ---

constexpr TraceField number(std::string_view name, std::int64_t (*get)(const TraceRecord&)) {
  return {name, FieldType::Number, get};
}
constexpr TraceField flag(std::string_view name, std::int64_t (*get)(const TraceRecord&)) {
  return {name, FieldType::Flag, get};
}
constexpr TraceField words(std::string_view name, std::string (*get)(const TraceRecord&)) {
  return {name, FieldType::Words, nullptr, get};
}
constexpr TraceField since(std::string_view name) {
  return {name, FieldType::Instant, [](const TraceRecord& r) -> std::int64_t { return r.since; }};
}
constexpr TraceField statement(std::string_view name) {
  return {name, FieldType::Statement, [](const TraceRecord& r) -> std::int64_t { return r.op; }};
}

constexpr TraceField kEvent = number("event", [](const TraceRecord& r) -> std::int64_t { return r.event; });
constexpr TraceField kRoutine = number("routine", [](const TraceRecord& r) -> std::int64_t { return r.routine; });
constexpr TraceField kByte = number("byte", [](const TraceRecord& r) -> std::int64_t { return r.byte; });
constexpr TraceField kCode = number("code", [](const TraceRecord& r) -> std::int64_t { return r.code; });
constexpr TraceField kParityError =
    flag("parity_error", [](const TraceRecord& r) -> std::int64_t { return r.parity_error; });
constexpr TraceField kFramingError =
    flag("framing_error", [](const TraceRecord& r) -> std::int64_t { return r.framing_error; });
constexpr TraceField kStation = number("ppi_station", [](const TraceRecord& r) -> std::int64_t { return r.event; });
constexpr TraceField kStartEdge = since("start_edge");
constexpr TraceField kBy = statement("by");
constexpr TraceField kIn = statement("in");
constexpr TraceField count_named(std::string_view name) {
  return number(name, [](const TraceRecord& r) { return static_cast<std::int64_t>(r.count); });
}
constexpr TraceField place_named(std::string_view name) {
  return number(name, [](const TraceRecord& r) -> std::int64_t { return r.op; });
}
constexpr TraceField code_is_1(std::string_view name) {
  return flag(name, [](const TraceRecord& r) -> std::int64_t { return r.code == 1; });
}

constexpr TraceField kScanBegin[] = {count_named("scan")};
constexpr TraceField kModeChange[] = {code_is_1("run")};
constexpr TraceField kEventOccurred[] = {kEvent, kRoutine};
constexpr TraceField kEventLost[] = {kEvent};
constexpr TraceField kEventDropped[] = {kEvent, since("occurred")};
constexpr TraceField kServiceBegin[] = {kEvent, kRoutine, since("occurred"), statement("after")};
constexpr TraceField kServiceEnd[] = {kEvent, kRoutine, since("began")};
constexpr TraceField kAttach[] = {
    kEvent,
    kRoutine,
    {"interval", FieldType::Interval, [](const TraceRecord& r) -> std::int64_t { return r.interval; }},
    kBy};
constexpr TraceField kDetach[] = {kEvent, kBy};
constexpr TraceField kTransmit[] = {count_named("characters"), kBy};  // 0 characters: a break
constexpr TraceField kSent[] = {kByte};                               // the instant is the end of its stop bit
constexpr TraceField kReceived[] = {kByte, kParityError, kFramingError, kStartEdge};
constexpr TraceField kIgnored[] = {kByte, kParityError, kFramingError, kStartEdge, words("because", ignored_because)};
constexpr TraceField kReceive[] = {count_named("at_most"), kBy};
constexpr TraceField kReceiveEnd[] = {number("status", kByte.number), count_named("characters")};
constexpr TraceField kPortControl[] = {number("control", kByte.number), kBy};
constexpr TraceField kOutputChanged[] = {place_named("output_byte"), number("value", kByte.number)};
constexpr TraceField kAnalogChanged[] = {
    place_named("output_word"),
    number("value", [](const TraceRecord& r) -> std::int64_t { return static_cast<std::int16_t>(r.count); })};
constexpr TraceField kRuntimeError[] = {
    kCode, words("meaning", [](const TraceRecord& r) { return std::string(meaning_of(RunError{r.code})); }), kIn};
constexpr TraceField kFatalError[] = {
    kCode, words("meaning", [](const TraceRecord& r) { return std::string(meaning_of(FatalError{r.code})); }), kIn};
constexpr TraceField kEnable[] = {code_is_1("enabled"), kBy};
constexpr TraceField kNetworkJob[] = {kStation,
                                      flag("writes", [](const TraceRecord& r) -> std::int64_t { return r.routine != 0; }),
                                      words("table", [](const TraceRecord& r) { return byte_text(r.op); }),
                                      number("status", kByte.number), count_named("bytes")};
constexpr TraceField kPpiService[] = {kStation, words("asks", asked_text), number("error", kCode.number)};
constexpr TraceField kPpiAccess[] = {
    kStation, words("does", [](const TraceRecord& r) { return std::string(does_text(PpiVerb{r.byte})); }),
    words("variable", variable_text), number("return_code", kCode.number)};
constexpr TraceField kCharacters[] = {count_named("characters")};
constexpr TraceField kPpiNotModelled[] = {kStation, number("to", kByte.number), words("what", unmodelled_ppi_text)};

// --- the rows ---

constexpr TraceRow kTraceRows[] = {
    {TraceKind::ScanBegin, "scan_begin", kScanBegin, false,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, "scan ", r.count, " begins"); }},
    {TraceKind::ModeChange, "mode_change", kModeChange, false,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, r.code == 1 ? "RUN" : "STOP"); }},
    {TraceKind::EventOccurred, "event_occurred", kEventOccurred, false,
     [](EventText& e, Text& t, const TraceRecord& r) { append(t, e.event(r.event), " occurred, for INT ", r.routine); }},
    {TraceKind::EventLost, "event_lost", kEventLost, false,
     [](EventText& e, Text& t, const TraceRecord& r) { append(t, e.event(r.event), " LOST: its queue is full"); }},
    {TraceKind::EventDropped, "event_dropped", kEventDropped, false,
     [](EventText& e, Text& t, const TraceRecord& r) {
       append(t, e.event(r.event), " of ");
       append_clock(t, r.since);
       append(t, " ms dropped: detached while it waited");
     }},
    {TraceKind::ServiceBegin, "service_begin", kServiceBegin, false,
     [](EventText& e, Text& t, const TraceRecord& r) {
       append(t, "INT ", r.routine, " begins: ", e.event(r.event), ", waited ", e.duration(r.at - r.since));
     }},
    {TraceKind::ServiceEnd, "service_end", kServiceEnd, false,
     [](EventText& e, Text& t, const TraceRecord& r) {
       append(t, "INT ", r.routine, " ends: took ", e.duration(r.at - r.since));
     }},
    {TraceKind::Attach, "attach", kAttach, false,
     [](EventText& e, Text& t, const TraceRecord& r) {
       append(t, "ATCH: INT ", r.routine, " to ", e.event(r.event));
       if (r.interval) append(t, ", every ", e.duration(r.interval));
     }},
    {TraceKind::Detach, "detach", kDetach, false,
     [](EventText& e, Text& t, const TraceRecord& r) { append(t, "DTCH: ", e.event(r.event)); }},
    {TraceKind::Transmit, "transmit", kTransmit, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       if (r.count)
         append(t, "XMT: ", counted(r.count, "character"));
       else
         append(t, "XMT: break");
     }},
    {TraceKind::TransmitEnd,
     "transmit_end",
     {},
     true,
     [](EventText&, Text& t, const TraceRecord&) { append(t, "transmit complete"); }},
    {TraceKind::CharacterSent, "sent", kSent, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "sent     ");
       append_byte(t, r.byte);
     }},
    {TraceKind::CharacterReceived, "received", kReceived, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "received ");
       append_character(t, r);
     }},
    {TraceKind::CharacterIgnored, "ignored", kIgnored, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "ignored  ");
       append_character(t, r);
       if (Ignored{r.code} == Ignored::NoPpiFrame) append(t, " and the rest up to the next pause");
       append(t, ": ", ignored_because(r));
     }},
    {TraceKind::CharacterDropped, "dropped", kIgnored, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "dropped  ");
       append_character(t, r);
       append(t, ": ", ignored_because(r));
     }},
    {TraceKind::Receive, "receive", kReceive, true,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, "RCV: at most ", counted(r.count, "character")); }},
    {TraceKind::ReceiveEnd, "receive_end", kReceiveEnd, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "RCV ends: ", counted(r.count, "character"), ", ", status_text(r.byte));
     }},
    {TraceKind::PortControl, "port_control", kPortControl, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "SMB", kPorts[r.port].control - image::kSM, " = ");
       append_hex(t, r.byte, 2);
     }},
    {TraceKind::OutputChanged, "output_changed", kOutputChanged, false,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, fmt::format("QB{} = 2#{:08b}", r.op, r.byte)); }},
    {TraceKind::AnalogChanged, "analog_changed", kAnalogChanged, false,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, "AQW", r.op, " = ", static_cast<std::int16_t>(r.count)); }},
    {TraceKind::RuntimeError, "runtime_error", kRuntimeError, false,
     [](EventText& e, Text& t, const TraceRecord& r) {
       append(t, fmt::format("run-time error {:04X} ({}) in {}", r.code, meaning_of(RunError{r.code}), e.place(r.op)));
     }},
    {TraceKind::FatalError, "fatal_error", kFatalError, false,
     [](EventText& e, Text& t, const TraceRecord& r) {
       append(t, fmt::format("FATAL error {:04X} ({}) in {}", r.code, meaning_of(FatalError{r.code}), e.place(r.op)));
     }},
    {TraceKind::Enable, "enable", kEnable, false,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, r.code == 1 ? "ENI: interrupts are enabled" : "DISI: interrupts are disabled");
     }},
    {TraceKind::NetworkJob, "network_job", kNetworkJob, true,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, network_text(r)); }},
    {TraceKind::PpiService, "ppi_service", kPpiService, true,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, ppi_text(r)); }},
    {TraceKind::PpiAccess, "ppi_access", kPpiAccess, true,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, ppi_text(r)); }},
    {TraceKind::PpiIgnored, "ppi_ignored", kCharacters, true,
     [](EventText&, Text& t, const TraceRecord& r) {
       append(t, "PPI frame of ", counted(r.count, "character"), " ignored: its check sum or end is wrong");
     }},
    {TraceKind::PpiNotModelled, "ppi_not_modelled", kPpiNotModelled, true,
     [](EventText&, Text& t, const TraceRecord& r) { append(t, unmodelled_ppi_text(r)); }},
};

static_assert(
    [] {
      for (std::size_t place = 0; place < std::size(kTraceRows); ++place)
        if (static_cast<std::size_t>(kTraceRows[place].kind) != place) return false;
      return true;
    }(),
    "the rows stand in the order of TraceKind");

}  // namespace

std::span<const TraceRow> trace_rows() { return kTraceRows; }

const TraceRow& row_of(TraceKind kind) { return kTraceRows[static_cast<std::size_t>(kind)]; }

}  // namespace s7200
