#include "tools/views/timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/received_text.hpp"

namespace s7200::tools {
namespace {

using Kind = TimelineRow::Kind;

constexpr std::size_t kWidth = 38;       // of the column of the port
constexpr std::size_t kCharacters = 23;  // eight, in it

/// Rows whose interrupts may still come. More than any queue of the CPU holds, whatever else happens meanwhile.
constexpr std::size_t kOpenRows = 1000;

bool belong_together(const TimelineRow& a, const TimelineRow& b) {
  const bool repeats = a.kind != Kind::Transmit && a.kind != Kind::Other && a.kind != Kind::Way &&
                       a.kind != Kind::Unanswered && (a.kind != Kind::Ignored || a.why == b.why);
  return repeats && a.kind == b.kind && a.port == b.port && a.event == b.event && a.routine == b.routine;
}

void join(TimelineRow& row, const TimelineRow& next) {
  const std::size_t kept = std::min(next.characters.size(), TimelineRow::kMostCharacters - row.characters.size());
  const auto end = next.characters.begin() + static_cast<std::ptrdiff_t>(kept);
  row.characters.insert(row.characters.end(), next.characters.begin(), end);
  row.more_characters += next.characters.size() - kept;
  row.served += next.served;
  row.shortest = std::min(row.shortest, next.shortest);
  row.longest = std::max(row.longest, next.longest);
  row.in_all += next.in_all;
  if (next.longest_wait > row.longest_wait) {
    row.longest_wait = next.longest_wait;
    row.why = next.why;
  }
}

/// The rows as they are shown: what belongs together is one row, and what is too much in the middle is only counted.
class ShownRows {
 public:
  void add(TimelineRow row) {
    TimelineRow* const before = !last_.empty() ? &last_.back() : !first_.empty() ? &first_.back() : nullptr;
    if (before && belong_together(*before, row)) return join(*before, row);
    if (first_.size() < kHalf) return first_.push_back(std::move(row));
    last_.push_back(std::move(row));
    if (last_.size() <= kHalf) return;
    if (left_out_++ == 0) left_out_since_ = last_.front().at;
    last_.pop_front();
  }

  std::vector<TimelineRow> all() const {
    std::vector<TimelineRow> rows = first_;
    if (left_out_ > 0)
      rows.push_back({.at = left_out_since_, .kind = Kind::LeftOut, .text = fmt::format("… {} rows left out", left_out_)});
    rows.insert(rows.end(), last_.begin(), last_.end());
    return rows;
  }

 private:
  static constexpr std::size_t kHalf = TimelineReport::kMostRows / 2;

  std::vector<TimelineRow> first_;
  std::deque<TimelineRow> last_;
  std::uint64_t left_out_ = 0;
  Time left_out_since_ = 0;
};

}  // namespace

/// Rows of one thing each, with the services that belong to them.
class Timeline::Reader {
 public:
  explicit Reader(const Program& program) : program_(program) {}

  /// Reads a record. `why` is the reason why an interrupt has waited; or the line of the program that did it, with its
  /// comment.
  void read(const TraceRecord& r, const std::string& why) {
    switch (r.kind) {
      case TraceKind::ScanBegin:
        return begin_scan(r);
      case TraceKind::CharacterReceived:
        return add_characters(r, Kind::Received);
      case TraceKind::CharacterIgnored:
        add_characters(r, Kind::Ignored);
        rows_.back().why = ignored_because(r);
        return;
      case TraceKind::CharacterDropped:
        return add_characters(r, Kind::Dropped);
      case TraceKind::CharacterSent:
        return add_characters(r, Kind::Sent);
      case TraceKind::EventOccurred:
        return occurred(r);
      case TraceKind::EventLost:
        return lost(r);
      case TraceKind::ServiceBegin:
        return begin_service(r, why);
      case TraceKind::ServiceEnd:
        return end_service(r);
      case TraceKind::Transmit:
        add(r, Kind::Transmit, r.count ? "XMT " + counted(r.count, "character") : "XMT break");
        rows_.back().place = place_of(r);
        rows_.back().why = stl::trim(why);
        return;
      case TraceKind::Attach:
      case TraceKind::Detach:
      case TraceKind::Enable:
      case TraceKind::TransmitEnd:
        return;
      default:
        return add(r, Kind::Other, describe(r, program_) + why);
    }
  }

  /// Reads the way of the main program through the scan that ends; the first scan shows the usual way.
  void read_way(Time at, std::string way) {
    if (!std::exchange(way_known_, true)) return;
    add({.at = at}, Kind::Way, std::move(way));
  }
  void read_note(Time at, std::string what) { add({.at = at}, Kind::Other, std::move(what)); }

  void read_unanswered(const TraceRecord& r, TraceReasons::Unanswered unanswered) {
    add({.at = r.at}, Kind::Unanswered, "no answer to " + characters_text(unanswered.characters));
    rows_.back().why = std::move(unanswered.decided_by);
  }

  TimelineReport report() const {
    ShownRows shown = shown_;
    for (const TimelineRow& row : rows_) shown.add(row);
    TimelineReport report = report_;
    report.rows = shown.all();
    return report;
  }

 private:
  void add(const TraceRecord& r, Kind kind, std::string text = {}) {
    while (rows_.size() >= kOpenRows && serving_ != &rows_.front()) {
      shown_.add(std::move(rows_.front()));
      rows_.pop_front();
    }
    rows_.push_back(
        {.at = r.at, .kind = kind, .port = r.port, .event = r.event, .routine = r.routine, .text = std::move(text)});
  }
  void add_characters(const TraceRecord& r, Kind kind) {
    add(r, kind);
    rows_.back().characters.push_back({r.byte, r.parity_error, r.framing_error, r.since, r.at});
  }

  /// The receive event of the character that has just been added.
  bool belongs_to_character(const TraceRecord& r) const {
    return is_receive_event(r.event) && !rows_.empty() && rows_.back().kind == Kind::Received && rows_.back().at == r.at;
  }

  void occurred(const TraceRecord& r) {
    if (!belongs_to_character(r)) return add(r, Kind::Event);
    rows_.back().event = r.event;
    rows_.back().routine = r.routine;
  }
  void lost(const TraceRecord& r) {
    if (!belongs_to_character(r)) return add(r, Kind::Other, describe(r, program_));
    rows_.back().kind = Kind::Lost;
    rows_.back().event = r.event;
    rows_.back().routine = r.routine;
  }

  void begin_scan(const TraceRecord& r) {
    scan_ = r.count;
    if (scan_begin_ != kNever) {
      const Time scan = r.at - scan_begin_;
      ++report_.scans;
      report_.shortest_scan = std::min(report_.shortest_scan, scan);
      report_.longest_scan = std::max(report_.longest_scan, scan);
    }
    scan_begin_ = r.at;
  }

  void begin_service(const TraceRecord& r, const std::string& why) {
    serving_ = nullptr;
    for (auto row = rows_.rbegin(); row != rows_.rend() && !serving_; ++row)
      if (row->event == r.event && row->at == r.since && (row->kind == Kind::Received || row->kind == Kind::Event))
        serving_ = &*row;
    report_.longest_wait = std::max(report_.longest_wait, r.at - r.since);
    if (serving_) {
      serving_->longest_wait = r.at - r.since;
      serving_->why = why;
    }
    in_routine_ = true;
    routine_ = r.routine;
  }
  void end_service(const TraceRecord& r) {
    const Time took = r.at - r.since;
    in_routine_ = false;
    service_end_ = r.at;
    ++report_.served;
    report_.in_all += took;
    if (!serving_) return;
    serving_->routine = r.routine;
    serving_->served = 1;
    serving_->shortest = serving_->longest = serving_->in_all = took;
    serving_ = nullptr;
  }

  std::string place_of(const TraceRecord& r) const {
    if (in_routine_) return fmt::format("INT {}", routine_);
    const std::string scan = scan_ ? fmt::format("scan {}", scan_) : "";
    if (service_end_ == kNever) return fmt::format("{:<9}{}", "program", scan);
    return fmt::format("{:<9}{}, {} after INT {}", "program", scan, format_duration(r.at - service_end_), routine_);
  }

  const Program& program_;
  ShownRows shown_;
  std::deque<TimelineRow> rows_;  // one that stays where it is
  TimelineReport report_;         // without the rows
  bool way_known_ = false;
  std::uint64_t scan_ = 0;
  Time scan_begin_ = kNever;
  TimelineRow* serving_ = nullptr;  // null for an interrupt that occurred before the exchange
  bool in_routine_ = false;
  std::uint8_t routine_ = 0;
  Time service_end_ = kNever;
};

namespace {

// --- text ---

/// As many characters as fit the column, and their number if not all do.
std::string characters_text(const TimelineRow& row) {
  std::string text;
  for (const ReceivedCharacter& c : row.characters) {
    const std::string next = received_text(c);
    if (text.size() + next.size() > kCharacters)
      return fmt::format("{}… {}", text, row.characters.size() + row.more_characters);
    text += next + ' ';
  }
  return text;
}

std::string what_text(const TimelineRow& row) {
  switch (row.kind) {
    case Kind::Received:
      return "received  " + characters_text(row);
    case Kind::Ignored:
      return "ignored   " + characters_text(row);
    case Kind::Dropped:
      return "dropped   " + characters_text(row);
    case Kind::Lost:
      return "LOST      " + characters_text(row);
    case Kind::Sent:
      return "sent      " + characters_text(row);
    case Kind::Event:
      return fmt::format("event {:<3} {}", row.event, find_event(row.event)->cause);
    case Kind::Transmit:
    case Kind::Other:
    case Kind::LeftOut:
    case Kind::Way:
    case Kind::Unanswered:
      return row.text;
  }
  return {};
}

/// Port 0 goes without saying; what is told in words names its port itself.
std::string line_text(const TimelineRow& row) {
  const bool in_words = row.kind == Kind::Other;
  return row.port == 0 || in_words ? what_text(row) : fmt::format("port {} {}", row.port, what_text(row));
}

std::string remark(const TimelineRow& row) {
  if (row.kind == Kind::Ignored || row.kind == Kind::Unanswered) return row.why;
  if (row.kind == Kind::Dropped) return "RCV waits for the start of a message";
  if (row.kind == Kind::Lost) return fmt::format("the queue before INT {} was full", row.routine);
  if (row.served == 0) return row.why.empty() ? row.place : row.place + "  " + row.why;
  std::string took = format_duration(row.longest);
  if (row.served > 1) {
    const std::string from = row.shortest == row.longest ? "" : format_duration(row.shortest) + " to ";
    took = fmt::format("{} × {}{}", row.served, from, took);
  }
  const std::string waited =
      row.longest_wait ? fmt::format("waited {}{}", row.served > 1 ? "up to " : "", format_duration(row.longest_wait)) : "";
  const std::string why = row.why.empty() ? "" : ": " + row.why;
  return fmt::format("INT {:<4} {:<26} {}{}", row.routine, took, waited, why);
}

/// fmt counts a character of several bytes as the columns it takes.
std::string row_text(Time at, std::string_view station, const TimelineRow& row) {
  std::string text = fmt::format("{:>10.3f}  {}{:<{}}  {}", static_cast<double>(at) / kMillisecond, station, line_text(row),
                                 kWidth, remark(row));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

bool is_trouble(const TimelineRow& row) {
  return row.kind == Kind::Lost || row.kind == Kind::Ignored || row.kind == Kind::Unanswered ||
         std::any_of(row.characters.begin(), row.characters.end(),
                     [](const auto& c) { return c.parity_error || c.framing_error; });
}

std::string painted(const std::string& text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : text;
}

constexpr const char* kDim = "2";
constexpr const char* kYellow = "33";

std::string summary(const TimelineReport& report) {
  bool marked = false;
  for (const TimelineRow& row : report.rows)
    for (const ReceivedCharacter& c : row.characters) marked |= c.parity_error || c.framing_error;
  std::string text = fmt::format("{} served in {}, longest wait {}", counted(report.served, "interrupt"),
                                 format_duration(report.in_all), format_duration(report.longest_wait));
  if (report.scans)
    text += fmt::format("; {} of {} to {}", counted(report.scans, "scan"), format_duration(report.shortest_scan),
                        format_duration(report.longest_scan));
  if (marked) text += "; p wrong parity, f framing error";
  return text;
}

/// Names of stations, in a column as wide as the longest; nothing if none has a name.
class Column {
 public:
  explicit Column(const std::vector<StationTimeline>& stations) {
    for (const StationTimeline& each : stations) width_ = std::max(width_, each.station.size());
    if (width_ > 0) width_ = std::max(width_, std::string_view("station").size());
  }
  std::string of(std::string_view name) const { return width_ == 0 ? "" : fmt::format("{:<{}}  ", name, width_); }

 private:
  std::size_t width_ = 0;
};

using StationRow = std::pair<const std::string*, const TimelineRow*>;

/// The rows of one instant in the order of the stations.
std::vector<StationRow> in_order(const std::vector<StationTimeline>& stations) {
  std::vector<StationRow> rows;
  for (const StationTimeline& each : stations)
    for (const TimelineRow& row : each.report.rows) rows.emplace_back(&each.station, &row);
  if (stations.size() > 1) std::ranges::stable_sort(rows, {}, [](const StationRow& row) { return row.second->at; });
  return rows;
}

// --- JSON ---

nlohmann::ordered_json to_json(const TimelineRow& row, const std::string& station, const serial::Exchange& exchange) {
  static constexpr std::string_view kNames[] = {"received", "ignored",  "lost",    "event", "transmit",  "sent",
                                                "other",    "left out", "dropped", "way",   "unanswered"};
  const auto microseconds = [](Time t) { return static_cast<double>(t) / kMicrosecond; };
  nlohmann::ordered_json json{{"at_us", microseconds(row.at - exchange.request_start)}};
  if (!station.empty()) json["station"] = station;
  json["kind"] = kNames[static_cast<std::size_t>(row.kind)];
  if (row.port != 0) json["port"] = row.port;
  if (!row.characters.empty()) {
    std::vector<std::uint8_t> bytes;
    for (const ReceivedCharacter& c : row.characters) bytes.push_back(c.byte);
    json["characters"] = plain_hex(bytes);
    json["parity_errors"] =
        std::count_if(row.characters.begin(), row.characters.end(), [](const auto& c) { return c.parity_error; });
    json["framing_errors"] =
        std::count_if(row.characters.begin(), row.characters.end(), [](const auto& c) { return c.framing_error; });
  }
  if (row.more_characters) json["more_characters"] = row.more_characters;
  if (!row.text.empty()) json["text"] = row.text;
  if (!row.place.empty()) json["place"] = row.place;
  if (!row.why.empty() && !row.served) json["why"] = row.why;
  if (row.served) {
    json["event"] = row.event;
    json["routine"] = row.routine;
    json["served"] = row.served;
    json["shortest_us"] = microseconds(row.shortest);
    json["longest_us"] = microseconds(row.longest);
    json["longest_wait_us"] = microseconds(row.longest_wait);
    if (!row.why.empty()) json["longest_wait_why"] = row.why;
  }
  return json;
}

}  // namespace

Timeline::Timeline(std::shared_ptr<const Program> program, TraceSink* next, Looks looks)
    : program_(std::move(program)),
      next_(next),
      looks_(looks),
      reader_(std::make_unique<Reader>(*program_)),
      reasons_(*program_),
      path_(*program_, 1) {}

Timeline::~Timeline() = default;

void Timeline::begin() {
  reader_ = std::make_unique<Reader>(*program_);
  reasons_.forget_instructions();
  path_.forget();
  looking_ = true;
}

void Timeline::begin_amid(const TraceReasons::Disabled& interrupts) {
  begin();
  reasons_.forget(interrupts);
}

/// The place of the record in the program: `  line 82: XMT VB200, 0  // answer`. An event has none, since its routine says
/// why it waited.
std::string Timeline::place_text(const TraceRecord& record) {
  const bool shown =
      record.kind == TraceKind::Transmit || record.kind == TraceKind::PortControl || record.kind == TraceKind::Receive;
  return shown ? reasons_.of(record) : "";
}

void Timeline::record(const TraceRecord& record) {
  if (looking_) {
    reader_->read(record, record.kind == TraceKind::ServiceBegin ? reasons_.held_up_by(record) : place_text(record));
    for (auto& unanswered : reasons_.unanswered(record)) reader_->read_unanswered(record, std::move(unanswered));
  }
  reasons_.note(record);
  path_.of(record);
  if (next_) next_->record(record);
}

void Timeline::instruction(const InstructionRecord& record) {
  if (looking_ && looks_ == Looks::AtInstructions) {
    reasons_.note(record);
    if (const std::string* way = path_.of(record)) reader_->read_way(record.end, *way);
  }
  if (next_wants_instructions()) next_->instruction(record);
}

void Timeline::note(Time at, const std::string& what) {
  if (looking_) reader_->read_note(at, what);
}

TimelineReport Timeline::report() const { return reader_->report(); }

std::string to_text(const TimelineReport& report, const serial::Exchange& exchange, bool colour) {
  return to_text(std::vector<StationTimeline>{{"", report}}, exchange, colour);
}

std::string to_text(const std::vector<StationTimeline>& stations, const serial::Exchange& exchange, bool colour) {
  const Column column(stations);
  std::string text =
      painted(fmt::format("{:>10}  {}{:<{}}  {}", "ms", column.of("station"), "at the port", kWidth, "in the CPU"), kDim,
              colour) +
      '\n';
  for (const auto& [station, row] : in_order(stations)) {
    const std::string line = row_text(row->at - exchange.request_start, column.of(*station), *row);
    text += (is_trouble(*row) ? painted(line, kYellow, colour) : line) + '\n';
  }
  for (const StationTimeline& each : stations)
    text += painted(fmt::format("{:>10}  {}{}", "", column.of(each.station), summary(each.report)), kDim, colour) + '\n';
  return text;
}

nlohmann::ordered_json to_json(const TimelineReport& report, const serial::Exchange& exchange) {
  return to_json(std::vector<StationTimeline>{{"", report}}, exchange);
}

nlohmann::ordered_json to_json(const std::vector<StationTimeline>& stations, const serial::Exchange& exchange) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [station, row] : in_order(stations)) list.push_back(to_json(*row, *station, exchange));
  return list;
}

}  // namespace s7200::tools
