#include "serial_sim/field/field_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "interpreter/base/text/csv.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/special_memory.hpp"
#include "interpreter/program/checking/special_memory_use.hpp"
#include "interpreter/program/operands/address.hpp"
#include "interpreter/program/operands/operands.hpp"

namespace s7200::serial {
namespace {

__extension__ using Wide = __int128;

constexpr std::size_t kAddress = 1;  // of the fields of a row

constexpr std::uint64_t kHighestMillihertz = 1'000'000'000;  // 1 MHz

/// # begins a comment where a word could begin: not in 16#FF, nor in the quotes of a symbol.
std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == '"') quoted = !quoted;
    const bool could_begin = at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t';
    if (line[at] == '#' && !quoted && could_begin) return line.substr(0, at);
  }
  return line;
}

/// Parses a frequency in mHz, in any range: `5kHz`, `0.5 Hz`. It is read as a duration whose nanosecond is a millihertz.
std::optional<std::uint64_t> parse_frequency(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kUnits[] = {{"MHz", "s"}, {"kHz", "ms"}, {"Hz", "us"}};
  for (const auto& [unit, duration] : kUnits) {
    if (!text.ends_with(unit)) continue;
    const std::string_view figure = stl::trim(text.substr(0, text.size() - unit.size()));
    const auto millihertz = parse_duration_or_never(std::string(figure).append(duration));
    return millihertz ? std::optional(static_cast<std::uint64_t>(*millihertz)) : std::nullopt;
  }
  return {};
}

class FieldScriptReader {
 public:
  FieldScriptReader(const std::string& name, const AddressSpace& space, std::vector<std::string>& errors)
      : name_(name), space_(space), errors_(errors) {}

  FieldScript read(std::string_view csv) {
    bool first = true;
    while (!csv.empty()) {
      ++line_;
      const std::string_view line = csv.substr(0, csv.find('\n'));
      csv.remove_prefix(std::min(csv.size(), line.size() + 1));
      const std::string_view row = stl::trim(without_comment(line));
      if (row.find_first_not_of(",;\t ") == std::string_view::npos || row.starts_with("\"#")) continue;
      if (first) separator_ = csv_separator(row);
      auto fields = csv_fields(row, separator_);
      if (!fields)
        error("a double quote is not closed");
      else if (!(first && row.starts_with("time")))
        read_row(std::move(*fields));
      first = false;
    }
    return std::move(script_);
  }

 private:
  struct Busy {
    Time until = 0;
    std::size_t line = 0;
  };

  void error(std::string_view what) { errors_.push_back(fmt::format("{}:{}: {}", name_, line_, what)); }

  void read_row(std::vector<std::string> field) {
    constexpr std::size_t kFewest = 3;
    while (field.size() > kFewest && field.back().empty()) field.pop_back();  // spreadsheets fill rows up
    for (std::size_t i = 0; i < field.size(); ++i)
      if (i != kAddress) field[i] = with_decimal_point(std::move(field[i]), separator_);
    const bool pulses = field.size() == 5 && field[2] == "pulses";
    if (!pulses && field.size() != 3) return error("write time,address,value or time,address,pulses,frequency,duration");
    const auto at = parse_duration(field[0]);
    if (!at) return error(fmt::format("'{}' is not a time; write for example 10ms or 1.5s", stl::shortened(field[0])));
    if (*at < last_) return error(fmt::format("{} lies before the row above; put the rows in the order of time", field[0]));
    last_ = *at;
    if (pulses)
      add_pulses(*at, field);
    else
      add_change(*at, field);
  }

  /// Checks that the field can drive the memory: it drives inputs. Returns a message for anything else.
  bool drivable(const MemoryRange& range, std::string_view address) {
    const std::size_t potentiometers = is_modelled_special_memory(space_.model, sm::kPotentiometer[1] - image::kSM) ? 2 : 1;
    const bool potentiometer =
        range.area == Area::SM && range.width == Width::Byte && range.at - sm::kPotentiometer[0] < potentiometers;
    const bool analog = range.area == Area::AI && range.number % 2 == 0;
    const bool mode_switch =
        range.width == Width::Bit && range.at == sm::kScanStatus && 1U << range.bit == sm::kModeSwitchRun;
    if (range.area == Area::I || analog || potentiometer || mode_switch) return true;
    error(fmt::format("'{}' is not an input; rows set I, words of AI at even addresses, the {}, and the mode switch SM0.7",
                      stl::shortened(address),
                      potentiometers == 1 ? "potentiometer SMB28" : "potentiometers SMB28 and SMB29"));
    return false;
  }

  std::optional<Assignment> assignment(std::string_view address, std::string_view value) {
    const auto range = parse_range(address, space_);
    if (!range || range->count != 1) {
      error(range ? fmt::format("'{}': a row sets one address, without a count", stl::shortened(address)) : range.why());
      return {};
    }
    if (!drivable(*range, address)) return {};
    const auto parsed = parse_value(*range, value);
    if (!parsed)
      error(fmt::format("'{}' is not a value for {}; write a number that fits, for example 1, 16#FF or -5",
                        stl::shortened(value), address));
    return parsed;
  }

  void add_change(Time at, const std::vector<std::string>& field) {
    const auto given = assignment(field[1], field[2]);
    if (!given) return;
    const MemoryRange& range = given->place;
    const std::uint32_t place = range.area == Area::I ? range.at - image::kI + image::kInputs : range.at;
    const bool bit = range.width == Width::Bit;
    for (std::uint32_t i = 0; i < range.bytes(); ++i) {
      FieldChange change{
          .at = at, .place = place + i, .value = static_cast<std::uint8_t>(given->value >> 8 * (range.bytes() - 1 - i))};
      if (bit) {
        change.mask = static_cast<std::uint8_t>(1u << range.bit);
        change.value = given->value ? change.mask : std::uint8_t{0};
      }
      if (range.area == Area::I && !is_free(change.place, change.mask, at, field[1])) return;
      script_.changes.push_back(change);
    }
  }

  void add_pulses(Time at, const std::vector<std::string>& field) {
    const auto given = assignment(field[1], "0");
    if (!given) return;
    if (given->place.area != Area::I || given->place.width != Width::Bit)
      return error(fmt::format("'{}': pulses need one input point, for example I0.6", stl::shortened(field[1])));
    const auto millihertz = parse_frequency(field[3]);
    if (!millihertz)
      return error(fmt::format("'{}' is not a frequency; write for example 50Hz or 5kHz", stl::shortened(field[3])));
    if (*millihertz == 0 || *millihertz > kHighestMillihertz)
      return error(fmt::format("'{}' is out of range (0.001Hz to 1MHz)", stl::shortened(field[3])));
    const auto duration = parse_duration_or_never(field[4]);
    if (!duration) return error(fmt::format("'{}' is not a duration; write for example 200ms", stl::shortened(field[4])));
    FieldPulses train{.at = at,
                      .place = given->place.at - image::kI + image::kInputs,
                      .mask = static_cast<std::uint8_t>(1u << given->place.bit),
                      .pulses = static_cast<std::uint64_t>(Wide{*duration} * *millihertz / 1'000'000'000'000),
                      .millihertz = *millihertz};
    if (train.pulses == 0) return error(fmt::format("no whole pulse of {} fits in {}; make it longer", field[3], field[4]));
    if (*duration >= kNever - at) return error(fmt::format("'{}' ends beyond 292 years; make it shorter", field[4]));
    if (!is_free(train.place, train.mask, at, field[1])) return;
    busy(train.place, given->place.bit) = {at + *duration, line_};
    script_.pulses.push_back(train);
  }

  Busy& busy(std::uint32_t place, std::uint32_t bit) { return busy_[(place - image::kInputs) * 8 + bit]; }

  /// Checks that no pulses run on these points at `at`. Returns a message if they do.
  bool is_free(std::uint32_t place, std::uint8_t mask, Time at, std::string_view address) {
    for (std::uint32_t bit = 0; bit < 8; ++bit) {
      if (!(mask >> bit & 1) || busy(place, bit).until <= at) continue;
      error(fmt::format("{} has the pulses of line {} until {}; let them end first", address, busy(place, bit).line,
                        format_duration(busy(place, bit).until)));
      return false;
    }
    return true;
  }

  const std::string& name_;
  const AddressSpace& space_;
  std::vector<std::string>& errors_;
  char separator_ = ',';
  std::size_t line_ = 0;
  Time last_ = 0;
  FieldScript script_;
  std::array<Busy, 16 * 8> busy_{};  // by input point
};

}  // namespace

Time FieldPulses::edge(std::uint64_t number) const {
  return at + static_cast<Time>(Wide{number} * 500'000'000'000 / Wide{millihertz});
}

FieldScript parse_field_script(std::string_view csv, const std::string& name, const AddressSpace& space,
                               std::vector<std::string>& errors) {
  return FieldScriptReader(name, space, errors).read(csv);
}

}  // namespace s7200::serial
