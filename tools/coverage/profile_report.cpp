#include "tools/coverage/profile_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/time.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/coverage/coverage_report.hpp"
#include "tools/coverage/programs.hpp"
#include "tools/views/text_table.hpp"

namespace s7200::tools {
namespace {

using Align = TextTable::Align;

constexpr std::size_t kMostRows = 12;    // of networks and of instructions
constexpr std::size_t kLongestBar = 40;  // of a histogram

double percent_of(Time part, Time all) { return all == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(all); }

/// Something that time was spent on.
struct TimeRow {
  std::uint32_t op = 0;  ///< the instruction, or the first of the network
  Time time = 0;
};

/// The rows with time, the longest first.
std::vector<TimeRow> longest_first(std::vector<TimeRow> rows) {
  std::erase_if(rows, [](const TimeRow& row) { return row.time == 0; });
  std::ranges::stable_sort(rows, std::greater{}, &TimeRow::time);
  return rows;
}

/// A profile with what it takes to name its parts.
class NamedProfile {
 public:
  explicit NamedProfile(const Profile& profile)
      : profile_(profile), inspection_(for_places(profile.program)), networks_(*profile.program), by_op_(profile.by_op()) {}

  nlohmann::ordered_json summary_json() const {
    nlohmann::ordered_json json{{"program", coverage_name(*profile_.program)},
                                {"cpu", profile_.program->model->name},
                                {"time_ns", profile_.total},
                                {"system_ns", profile_.system},
                                {"interrupt_entries_ns", profile_.entries()}};
    add_scans_and_events(json);
    return json;
  }

  std::string text() const { return heading() + "\n" + routines() + "\n" + places() + scans_text() + events_text(); }

  nlohmann::ordered_json json() const {
    nlohmann::ordered_json json{{"program", coverage_name(*profile_.program)},
                                {"cpu", profile_.program->model->name},
                                {"time_ns", profile_.total},
                                {"system_ns", profile_.system},
                                {"interrupt_entries_ns", profile_.entries()}};
    for (const char* const list : {"routines", "networks", "instructions"}) json[list] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < flow().routines.size(); ++i)
      json["routines"].push_back({{"routine", routine_text(flow().routines[i])}, {"time_ns", time_of_routine(i)}});
    for (const TimeRow& row : networks()) {
      json["networks"].push_back(row_json(row));
      json["networks"].back()["in_scan"] = durations_json(in_scan(row));
    }
    for (const TimeRow& row : instructions()) {
      json["instructions"].push_back(row_json(row));
      json["instructions"].back()["executed"] = profile_.executed[row.op];
    }
    add_scans_and_events(json);
    return json;
  }

  std::string folded() const {
    std::string text;
    const auto add = [&](const std::string& stack, Time time) {
      if (time > 0) text += fmt::format("{} {}\n", stack, time);
    };
    add("system", profile_.system);
    for (const auto& [stack, of_stack] : profile_.stacks) {
      std::string frames;
      for (const std::uint32_t routine : stack)
        frames += (frames.empty() ? "" : ";") + routine_text(flow().routines[routine]);
      add(frames + ";entry", of_stack.entry);
      for (std::uint32_t op = 0; op < of_stack.ops.size(); ++op)
        if (of_stack.ops[op] > 0) add(frames + ";" + frame_of(op), of_stack.ops[op]);
    }
    return text;
  }

 private:
  const ControlFlow& flow() const { return inspection_.facts.flow; }

  void add_scans_and_events(nlohmann::ordered_json& json) const {
    json["scans"] = durations_json(profile_.scans);
    json["worst_scan"] = scan_json();
    json["events"] = nlohmann::ordered_json::array();
    for (const auto& [number, event] : profile_.events) {
      nlohmann::ordered_json worst{
          {"at_ns", event.worst.at}, {"waited_ns", event.worst.waited}, {"why", without_colon(event.worst.why)}};
      add_origin(worst, event.worst.in, event.worst.at);
      json["events"].push_back({{"event", number},
                                {"routine", event.routine},
                                {"service", durations_json(event.service)},
                                {"latency", durations_json(event.latency)},
                                {"worst_latency", std::move(worst)}});
    }
  }

  static void add_origin(nlohmann::ordered_json& json, const ProfileOrigin& in, Time at) {
    json["plc"] = in.plc;
    if (in.debug.empty()) return;
    json["scenario"] = in.scenario;
    json["debug"] = debug_text(in, at);
  }

  /// The moment is given to the nanosecond.
  static std::string debug_text(const ProfileOrigin& in, Time at) {
    const std::string station = in.plc.empty() ? "" : fmt::format("station {}; ", stl::printable(in.plc));
    return fmt::format("{} -x '{}at {}ns'", in.debug, station, at);
  }

  std::string heading() const {
    return fmt::format("profile of {}, CPU {}: {} simulated\n", stl::printable(coverage_name(*profile_.program)),
                       profile_.program->model->name, format_duration(profile_.total, 9));
  }

  Time time_of_routine(std::size_t number) const {
    const Routine& routine = flow().routines[number];
    Time time = 0;
    for (std::uint32_t op = routine.first; op < routine.end; ++op) time += by_op_[op];
    for (const auto& [stack, of_stack] : profile_.stacks)
      if (stack.back() == number) time += of_stack.entry;
    return time;
  }

  std::string share(Time time) const { return fmt::format("{:.1f}%", percent_of(time, profile_.total)); }

  std::string routines() const {
    TextTable table({{"share", Align::Right}, {"time", Align::Right}, {"routine"}});
    std::vector<TimeRow> rows;
    for (std::size_t i = 0; i < flow().routines.size(); ++i)
      rows.push_back({static_cast<std::uint32_t>(i), time_of_routine(i)});
    table.add({share(profile_.system), format_duration(profile_.system, 6),
               "(system: inputs, communication, self-test, outputs)"});
    for (const TimeRow& row : longest_first(std::move(rows)))
      table.add({share(row.time), format_duration(row.time, 6), routine_text(flow().routines[row.op])});
    return table.text(100);
  }

  std::vector<TimeRow> networks() const {
    std::vector<TimeRow> rows;
    for (std::uint32_t op = 0; op < by_op_.size(); ++op) {
      if (networks_.begins(op)) rows.push_back({op, 0});
      rows.back().time += by_op_[op];
    }
    return longest_first(std::move(rows));
  }

  std::vector<TimeRow> instructions() const {
    std::vector<TimeRow> rows;
    for (std::uint32_t op = 0; op < by_op_.size(); ++op) rows.push_back({op, by_op_[op]});
    return longest_first(std::move(rows));
  }

  std::string places() const {
    std::string text = "networks, with their time in a scan\n";
    const auto line = [&](const TimeRow& row, const std::string& what) {
      const std::string all = fmt::format("  {:>6}  {:>14}  {}{}", share(row.time), format_duration(row.time, 6),
                                          column(place_text(inspection_, row.op), 36), what);
      return std::string(stl::trim_end(all)) + "\n";
    };
    const auto all_networks = networks(), all = instructions();
    for (std::size_t i = 0; i < std::min(kMostRows, all_networks.size()); ++i)
      text += line(all_networks[i], in_scan_text(in_scan(all_networks[i])));
    text += "instructions\n";
    for (std::size_t i = 0; i < std::min(kMostRows, all.size()); ++i)
      text += line(all[i], stl::shortened(instruction_text(inspection_, all[i].op)));
    return text;
  }

  /// The time of a network in the scans that it took time in.
  Durations in_scan(const TimeRow& network) const {
    const auto found = profile_.networks.find(network.op);
    return found == profile_.networks.end() ? Durations() : found->second;
  }
  static std::string in_scan_text(const Durations& durations) {
    if (durations.empty()) return {};
    return fmt::format("mean {}, most {}", format_duration(durations.mean(), 3), format_duration(durations.most(), 3));
  }

  static std::string spread(const Durations& durations) {
    return fmt::format("{} to {}, mean {}, half within {}, 99% within {}", format_duration(durations.least()),
                       format_duration(durations.most()), format_duration(durations.mean()),
                       format_duration(durations.within(0.5)), format_duration(durations.within(0.99)));
  }

  static std::string moment(Time at, const ProfileOrigin& in) {
    const std::string plc = in.plc.empty() ? "" : fmt::format(" of {}", stl::printable(in.plc));
    const std::string scenario = in.scenario.empty() ? "" : fmt::format(" in '{}'", stl::printable(in.scenario));
    return format_duration(at, 6) + plc + scenario;
  }

  /// Where it can be looked at: the command of the shell, and that of the debugger.
  static std::string debug_line(const ProfileOrigin& in, Time at) {
    if (in.debug.empty()) return {};
    const std::string station = in.plc.empty() ? "" : fmt::format("station {}; ", stl::printable(in.plc));
    return "    " + wrapped_at(fmt::format("look: {}", stl::printable(in.debug)), 6, 4) +
           fmt::format("\n      {}at {}ns\n", station, at);
  }

  /// A line for each bin; nothing if all durations are the same.
  static std::string histogram(const Durations& durations) {
    if (durations.least() == durations.most()) return {};
    const auto bins = durations.histogram();
    std::uint64_t most = 0;
    for (const Durations::Bin& bin : bins) most = std::max(most, bin.count);
    std::string text;
    for (const Durations::Bin& bin : bins) {
      const auto length =
          static_cast<std::size_t>(1 + static_cast<double>(bin.count) * (kLongestBar - 1) / static_cast<double>(most));
      text += fmt::format("    {:>10} to {:>10}  {:<{}}  {}\n", format_duration(bin.from), format_duration(bin.to),
                          std::string(length, '#'), kLongestBar, bin.count);
    }
    return text;
  }

  std::string scans_text() const {
    if (profile_.scans.empty()) return "no scan has ended\n";
    std::string text = fmt::format("{}\n  {}\n", counted(profile_.scans.count(), "scan"), spread(profile_.scans));
    text += histogram(profile_.scans);
    const ProfiledScan& worst = *profile_.worst_scan;
    text += "  " +
            wrapped_at(fmt::format("worst: {}, scan {} from {}: {}", format_duration(worst.length), worst.number,
                                   moment(worst.begin, worst.in), shares_of(worst)),
                       4, 2) +
            "\n" + debug_line(worst.in, worst.begin);
    return text;
  }

  std::string shares_of(const ProfiledScan& scan) const {
    std::vector<TimeRow> rows;
    Time in_program = 0;
    for (std::uint32_t i = 0; i < scan.routines.size(); ++i) {
      rows.push_back({i, scan.routines[i]});
      in_program += scan.routines[i];
    }
    std::string text;
    for (const TimeRow& row : longest_first(std::move(rows)))
      text += fmt::format("{} {}, ", routine_text(flow().routines[row.op]), format_duration(row.time));
    text += fmt::format("system {}", format_duration(scan.length - in_program));
    return scan.interrupts == 0 ? text : fmt::format("{}; {}", text, counted(scan.interrupts, "interrupt"));
  }

  static std::string without_colon(const std::string& why) { return why.starts_with(": ") ? why.substr(2) : why; }

  std::string events_text() const {
    std::string text;
    for (const auto& [number, event] : profile_.events) {
      text += fmt::format("event {}, INT_{}: {}\n", number, event.routine, counted(event.latency.count(), "time"));
      if (!event.service.empty()) text += "  takes  " + spread(event.service) + "\n" + histogram(event.service);
      text += "  waits  " + spread(event.latency) + "\n" + histogram(event.latency);
      if (event.worst.waited == 0) continue;
      const std::string why = without_colon(event.worst.why);
      text += "  " +
              wrapped_at(stl::printable(fmt::format("worst: {} at {}{}{}", format_duration(event.worst.waited),
                                                    moment(event.worst.at, event.worst.in), why.empty() ? "" : ": ", why)),
                         4, 2) +
              "\n" + debug_line(event.worst.in, event.worst.at);
    }
    return text;
  }

  nlohmann::ordered_json row_json(const TimeRow& row) const {
    nlohmann::ordered_json json = place_json(inspection_, row.op);
    json["time_ns"] = row.time;
    return json;
  }

  static nlohmann::ordered_json durations_json(const Durations& durations) {
    nlohmann::ordered_json bins = nlohmann::ordered_json::array();
    for (const Durations::Bin& bin : durations.histogram())
      bins.push_back({{"from_ns", bin.from}, {"to_ns", bin.to}, {"count", bin.count}});
    return {{"count", durations.count()},
            {"least_ns", durations.least()},
            {"most_ns", durations.most()},
            {"mean_ns", durations.mean()},
            {"half_within_ns", durations.within(0.5)},
            {"99_percent_within_ns", durations.within(0.99)},
            {"histogram", std::move(bins)}};
  }

  nlohmann::ordered_json scan_json() const {
    if (!profile_.worst_scan) return nullptr;
    const ProfiledScan& scan = *profile_.worst_scan;
    nlohmann::ordered_json json{
        {"number", scan.number}, {"at_ns", scan.begin}, {"time_ns", scan.length}, {"interrupts", scan.interrupts}};
    add_origin(json, scan.in, scan.begin);
    json["routines"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < scan.routines.size(); ++i)
      if (scan.routines[i] > 0)
        json["routines"].push_back({{"routine", routine_text(flow().routines[i])}, {"time_ns", scan.routines[i]}});
    return json;
  }

  /// `network 7;120 CALL 52`: semicolons part frames.
  std::string frame_of(std::uint32_t op) const {
    const std::uint32_t line = stl::in_file(profile_.program->source, profile_.program->statement(op).position.line).line;
    std::string text = fmt::format("{} {}", line, stl::printable(short_text(profile_.program->statement(op))));
    std::ranges::replace(text, ';', ',');
    return fmt::format("network {};{}", inspection_.facts.networks[op], text);
  }

  const Profile& profile_;
  const Inspection inspection_;
  const Networks networks_;
  const std::vector<Time> by_op_;
};

}  // namespace

void ProfileOfPrograms::add(const ProfileOfPrograms& other, const ProfileOrigin& origin) {
  for (const Profile& each : other.programs_) add(each, origin);
}

void ProfileOfPrograms::add(const Profile& profile, const ProfileOrigin& origin) {
  for (Profile& known : programs_)
    if (is_same_program(*known.program, *profile.program)) return known.add(profile, origin);
  programs_.push_back({.program = profile.program});
  programs_.back().add(profile, origin);
}

std::string profile_text(const Profile& profile) { return NamedProfile(profile).text(); }

nlohmann::ordered_json profile_json(const Profile& profile) { return NamedProfile(profile).json(); }

nlohmann::ordered_json profile_summary_json(const Profile& profile) { return NamedProfile(profile).summary_json(); }

std::string profile_by_run_text(const std::vector<ProfiledRun>& runs) {
  TextTable table({{"time", Align::Right},
                   {"scans", Align::Right},
                   {"longest scan", Align::Right},
                   {"longest wait", Align::Right},
                   {"scenario"}});
  for (const ProfiledRun& run : runs)
    for (const Profile& profile : run.profile->programs()) {
      Time waited = 0;
      for (const auto& [event, seen] : profile.events) waited = std::max(waited, seen.worst.waited);
      table.add({format_duration(profile.total), fmt::format("{}", profile.scans.count()),
                 format_duration(profile.scans.most()), format_duration(waited), stl::printable(run.name)});
    }
  return table.text(100);
}

std::string profile_folded(const ProfileOfPrograms& profile) {
  std::string text;
  for (const Profile& each : profile.programs()) text += NamedProfile(each).folded();
  return text;
}

}  // namespace s7200::tools
