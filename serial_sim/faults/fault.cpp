#include "serial_sim/faults/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::serial {
namespace {

using stl::trim;

/// A parameter, and how its value gets from text to fault and back. `read` gives a message when the text is not a value.
struct Parameter : FaultParameter {
  std::string (*read)(std::string_view, Fault&);
  std::string (*write)(const Fault&);
};

/// Parses a whole number of at least `least` into a member of Fault.
template <auto Fault::*member>
std::string read_count(std::string_view text, Fault& fault, std::uint64_t least, std::uint64_t most) {
  const auto value = parse_decimal<std::uint64_t>(text);
  if (!value || *value < least || *value > most) return fmt::format("is not a whole number from {} to {}", least, most);
  fault.*member = static_cast<std::remove_reference_t<decltype(fault.*member)>>(*value);
  return {};
}

constexpr std::uint64_t kMost = std::uint64_t{1} << 53;  // fits every language's number

/// Parses a probability: `0.01`, `1e-4`, `5%`.
std::optional<double> share(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  const auto value = parse_decimal<double>(text);
  if (!value || !(*value >= 0) || *value > (percent ? 100 : 1)) return std::nullopt;
  return percent ? *value / 100 : *value;
}

template <double Fault::*member>
std::string read_share(std::string_view text, Fault& fault) {
  const auto value = share(text);
  if (!value || *value == 0) return "is not a share above 0 and up to 1; write for example 1e-4, 0.5 or 2%";
  fault.*member = *value;
  return {};
}

constexpr Time kLongestLength = 3600 * kSecond;

/// A duration, or bits as in `0.3bit`: read as milliseconds, whose nanosecond is a microbit.
template <Length Fault::*member, bool positive>
std::string read_length(std::string_view text, Fault& fault) {
  constexpr std::string_view kUnit = "bit";
  Length length;
  const bool bits = text.ends_with(kUnit);
  const auto value = bits ? parse_duration(std::string(trim(text.substr(0, text.size() - kUnit.size()))).append("ms"))
                          : parse_duration(text);
  if (!value || *value > kLongestLength || (positive && *value == 0))
    return fmt::format("is not a length{}; write for example 30us, 1.5ms, 0.3bit or 12bit", positive ? " above 0" : "");
  (bits ? length.microbits : length.time) = *value;
  fault.*member = length;
  return {};
}

/// The exact text of format_duration without its blank.
std::string duration_text(Time duration) {
  if (duration == 0) return "0s";
  std::string text = format_duration(duration, 9);
  std::erase(text, ' ');
  return text;
}

template <Length Fault::*member>
std::string write_length(const Fault& fault) {
  const Length& length = fault.*member;
  if (length.time != 0) return duration_text(length.time);
  std::string bits = fmt::format("{}.{:06}", length.microbits / 1'000'000, length.microbits % 1'000'000);
  bits.erase(bits.find_last_not_of('0') + 1);
  if (bits.back() == '.') bits.pop_back();
  return bits + "bit";
}

template <class Value>
struct Word {
  std::string_view text;
  Value value;
};

constexpr std::array kHalves{Word<Half>{"request", Half::Request}, Word<Half>{"answer", Half::Answer},
                             Word<Half>{"both", Half::Both}};
constexpr std::array kStations{Word<Station>{"master", Station::Master}, Word<Station>{"plc", Station::Plc}};
constexpr std::array kBits{Word<int>{"start", Fault::kStartBit}, Word<int>{"parity", Fault::kParityBit},
                           Word<int>{"stop", Fault::kStopBit}};

template <auto& words, auto Fault::*member>
std::string read_word(std::string_view text, Fault& fault) {
  for (const auto& word : words)
    if (word.text == text) {
      fault.*member = word.value;
      return {};
    }
  return fmt::format("is none of {}", stl::joined(words, [](const auto& word) { return word.text; }));
}

template <auto& words, auto Fault::*member>
std::string write_word(const Fault& fault) {
  for (const auto& word : words)
    if (word.value == fault.*member) return std::string(word.text);
  return {};
}

std::string read_bit(std::string_view text, Fault& fault) {
  if (read_word<kBits, &Fault::bit>(text, fault).empty()) return {};
  const auto value = parse_decimal<int>(text);
  if (!value || *value < 0 || *value > 7) return "is not a bit: 0 (sent first) to 7, start, parity or stop";
  fault.bit = *value;
  return {};
}

std::string write_bit(const Fault& fault) {
  const std::string word = write_word<kBits, &Fault::bit>(fault);
  return word.empty() ? fmt::format("{}", fault.bit) : word;
}

constexpr std::uint32_t kMostCharacters = 1'000'000;

std::string read_character(std::string_view text, Fault& fault) {
  if (text == "each") {
    fault.character = Fault::kEachCharacter;
    return {};
  }
  const auto value = parse_decimal<std::uint32_t>(text);
  if (!value || *value < 1 || *value > kMostCharacters)
    return fmt::format("is not a character: a number from 1 to {}, or each", kMostCharacters);
  fault.character = value;
  return {};
}

std::string write_character(const Fault& fault) {
  if (!fault.character) return std::string(kLeftOut);
  return *fault.character == Fault::kEachCharacter ? "each" : fmt::format("{}", *fault.character);
}

std::string read_behind(std::string_view text, Fault& fault) {
  const auto value = parse_decimal<std::uint32_t>(text);
  if (!value || *value > kMostCharacters)
    return fmt::format("is not a character: a number up to {}, or 0 for the place before the first", kMostCharacters);
  fault.character = value;
  return {};
}

std::string write_behind(const Fault& fault) { return fmt::format("{}", fault.character.value_or(0)); }

/// The latest time that a fault may name: two such times and what follows them can be added without exceeding Time.
constexpr Time kLatest = Time{10'000} * 3600 * kSecond;

std::string read_from(std::string_view text, Fault& fault) {
  fault.from = parse_duration(text);
  return fault.from && *fault.from <= kLatest ? "" : "is not a time up to 10000h; write for example 1.5s or 250ms";
}

std::string read_lasts(std::string_view text, Fault& fault) {
  const auto value = parse_duration(text);
  if (text != "ever" && (!value || *value == 0 || *value > kLatest))
    return "is not a duration above 0 and up to 10000h; write for example 200ms, or ever";
  fault.lasts = value.value_or(kNever);
  return {};
}

std::string read_clock_error(std::string_view text, Fault& fault) {
  std::string_view figure = text;
  const bool percent = figure.ends_with('%');
  if (percent) figure.remove_suffix(1);
  if (figure.starts_with('+')) figure.remove_prefix(1);
  const auto value = parse_decimal<double>(figure);
  const double millionths = value ? std::round(*value * 10'000) : 0;
  if (!percent || !value || !(std::abs(millionths) <= Fault::kLargestClockError) || millionths == 0)
    return "is not a deviation up to 50%; write for example 2.5% for a clock that is too fast, -3% for a slow one";
  fault.clock_error = static_cast<std::int32_t>(millionths);
  return {};
}

constexpr std::size_t kMostBytes = 256;

std::string read_bytes(std::string_view text, Fault& fault) {
  fault.bytes.clear();
  if (text == "random") return {};
  for (std::size_t at = 0; at + 1 < text.size(); at += 2) {
    std::uint8_t byte = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 2, byte, 16);
    if (error != std::errc{} || end != text.data() + at + 2) break;
    fault.bytes.push_back(byte);
  }
  if (text.empty() || 2 * fault.bytes.size() != text.size() || fault.bytes.size() > kMostBytes)
    return fmt::format("is neither random nor 1 to {} bytes in hex such as 0183", kMostBytes);
  return {};
}

std::string write_bytes(const Fault& fault) {
  if (fault.bytes.empty()) return "random";
  std::string text;
  for (const std::uint8_t byte : fault.bytes) text += fmt::format("{:02x}", byte);
  return text;
}

const std::array kParameters{
    Parameter{{"ber", "share", "how many of the bits are inverted"},
              read_share<&Fault::error_rate>,
              [](const Fault& f) { return fmt::format("{}", f.error_rate); }},
    Parameter{{"character", "N, each", "number in the request or answer, from 1"}, read_character, write_character},
    Parameter{{"behind", "N", "number of the character, 0 for the place before the first"}, read_behind, write_behind},
    Parameter{{"bit", "0…7, start, parity, stop", "data bits count from the one sent first"}, read_bit, write_bit},
    Parameter{{"at", "time, bits", "after the start edge of the character"},
              read_length<&Fault::offset, false>,
              write_length<&Fault::offset>},
    Parameter{{"length", "time, bits", "how long it is"}, read_length<&Fault::length, true>, write_length<&Fault::length>},
    Parameter{{"bytes", "hex, random", "what is sent"}, read_bytes, write_bytes},
    Parameter{{"count", "N", "how many characters; with bytes given, how often those"},
              [](std::string_view text, Fault& f) { return read_count<&Fault::count>(text, f, 1, kMostBytes); },
              [](const Fault& f) { return fmt::format("{}", f.count); }},
    Parameter{{"error", "percent", "above 0 the station is too fast"},
              read_clock_error,
              [](const Fault& f) { return fmt::format("{}%", f.clock_error / 10'000.0); }},
    Parameter{{"station", "master, plc", "whose clock; master stands for every peer of the PLC"},
              read_word<kStations, &Fault::station>,
              write_word<kStations, &Fault::station>},
    Parameter{{"from", "time", "since the injection, whatever is sent then"},
              read_from,
              [](const Fault& f) { return f.from ? duration_text(*f.from) : std::string(kLeftOut); }},
    Parameter{{"for", "time, ever", "how long it lasts"},
              read_lasts,
              [](const Fault& f) { return f.lasts == kNever ? "ever" : duration_text(f.lasts); }},
    Parameter{{"of", "request, answer, both", "what is disturbed: what the PLC hears, or what it sends"},
              read_word<kHalves, &Fault::of>,
              write_word<kHalves, &Fault::of>},
    Parameter{{"exchange", "N", "in this exchange only, counted from 1 since the injection"},
              [](std::string_view text, Fault& f) { return read_count<&Fault::exchange>(text, f, 1, kMost); },
              [](const Fault& f) { return f.exchange ? fmt::format("{}", f.exchange) : std::string(kLeftOut); }},
    Parameter{{"every", "N", "in every Nth exchange"},
              [](std::string_view text, Fault& f) { return read_count<&Fault::every>(text, f, 1, kMost); },
              [](const Fault& f) { return fmt::format("{}", f.every); }},
    Parameter{{"probability", "share", "in so many of those exchanges, at random"},
              read_share<&Fault::probability>,
              [](const Fault& f) { return fmt::format("{}", f.probability); }},
    Parameter{{"seed", "N", "of what is left to chance; the same seed gives the same run"},
              [](std::string_view text, Fault& f) { return read_count<&Fault::seed>(text, f, 0, kMost); },
              [](const Fault& f) { return fmt::format("{}", f.seed); }},
};

/// Makes an answer misbehave; the message if it already does, as it can in one way only.
std::string misbehave(Fault& fault, Misbehaviour misbehaviour) {
  if (fault.misbehaviour != Misbehaviour::Nothing)
    return "comes after another misbehaviour of the same answer: give one of them";
  fault.misbehaviour = misbehaviour;
  return {};
}

template <Misbehaviour misbehaviour>
std::string read_code(std::string_view text, Fault& fault) {
  if (std::string why = misbehave(fault, misbehaviour); !why.empty()) return why;
  return read_count<&Fault::code>(text, fault, misbehaviour == Misbehaviour::Station ? 0 : 1,
                                  misbehaviour == Misbehaviour::Function ? 127 : 255);
}

template <Misbehaviour misbehaviour>
std::string write_code(const Fault& fault) {
  return fault.misbehaviour == misbehaviour ? fmt::format("{}", fault.code) : std::string(kLeftOut);
}

/// Parses a misbehaviour that has no value: its name is enough.
template <Misbehaviour misbehaviour>
std::string read_named(std::string_view, Fault& fault) {
  return misbehave(fault, misbehaviour);
}

template <Misbehaviour misbehaviour>
std::string write_named(const Fault& fault) {
  return fault.misbehaviour == misbehaviour ? std::string() : std::string(kLeftOut);
}

/// The parameters of a fault that changes a whole answer; `station` means something else for other faults.
const std::array kAnswerParameters{
    Parameter{{"delay", "time, bits", "how late the answer begins"},
              read_length<&Fault::length, true>,
              [](const Fault& f) { return f.length == Length{} ? std::string(kLeftOut) : write_length<&Fault::length>(f); }},
    Parameter{{"exception", "1…255", "the answer is this exception instead"},
              read_code<Misbehaviour::Exception>,
              write_code<Misbehaviour::Exception>},
    Parameter{{"station", "0…255", "of answer: the station that it seems to come from"},
              read_code<Misbehaviour::Station>,
              write_code<Misbehaviour::Station>},
    Parameter{{"function", "1…127", "the function that it seems to be about"},
              read_code<Misbehaviour::Function>,
              write_code<Misbehaviour::Function>},
    Parameter{{"stale", "", "the answer before this one is sent again"},
              read_named<Misbehaviour::Stale>,
              write_named<Misbehaviour::Stale>},
    Parameter{{"twice", "", "the answer is sent twice, 3.5 characters apart"},
              read_named<Misbehaviour::Twice>,
              write_named<Misbehaviour::Twice>},
    Parameter{{"short", "", "the last two bytes of its data are left out"},
              read_named<Misbehaviour::Short>,
              write_named<Misbehaviour::Short>},
    Parameter{{"silent", "", "nothing is sent"}, read_named<Misbehaviour::Silent>, write_named<Misbehaviour::Silent>},
};

const Parameter& parameter_of(FaultKind kind, std::string_view name) {
  const auto of_answer = std::ranges::find(kAnswerParameters, name, &Parameter::name);
  if (kind == FaultKind::Answer && of_answer != kAnswerParameters.end()) return *of_answer;
  return *std::ranges::find(kParameters, name, &Parameter::name);
}

bool has_value(const Parameter& parameter) { return !parameter.values.empty(); }

/// The parameters that every kind has: they say when the fault happens.
constexpr std::array kWhen{ParameterOfKind{"exchange", kLeftOut}, ParameterOfKind{"every", "1"},
                           ParameterOfKind{"probability", "1"}, ParameterOfKind{"seed", "1"}};

FaultKindInfo kind_info(FaultKind kind, std::string_view name, std::string_view meaning, std::string_view example,
                        std::vector<ParameterOfKind> parameters) {
  parameters.insert(parameters.end(), kWhen.begin(), kWhen.end());
  return {kind, name, meaning, example, std::move(parameters)};
}

/// A fault at an instant cannot also name an exchange and a place in it.
bool excluded_by_instant(const Fault& fault, std::string_view parameter) {
  return at_an_instant(fault) && (parameter == "character" || parameter == "at" || parameter == "of" ||
                                  parameter == "exchange" || parameter == "every" || parameter == "probability");
}

class FaultReader {
 public:
  explicit FaultReader(std::string_view text) : text_(text) {}

  ParsedFault read() {
    const std::size_t colon = text_.find(':');
    const std::string_view name = trim(text_.substr(0, colon));
    const auto& kinds = fault_kinds();
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const FaultKindInfo& k) { return k.name == name; });
    if (kind == kinds.end()) return fail(name, unknown("fault", name, kinds));
    kind_ = &*kind;
    result_.fault.kind = kind->kind;
    for (const ParameterOfKind& p : kind->parameters)
      if (p.standard != kRequired && p.standard != kLeftOut)
        parameter_of(kind->kind, p.name).read(p.standard, result_.fault);

    if (colon != std::string_view::npos)
      for (std::string_view rest = text_.substr(colon + 1);;) {
        const std::size_t comma = rest.find(',');
        read_parameter(rest.substr(0, comma));
        if (result_.error || comma == std::string_view::npos) break;
        rest.remove_prefix(comma + 1);
      }
    if (!result_.error) check_whole(name);
    return result_;
  }

 private:
  template <class Rows>
  static std::string unknown(std::string_view what, std::string_view name, const Rows& rows) {
    const std::string known = stl::joined(rows, [](const auto& row) { return row.name; });
    return name.empty() ? fmt::format("a {} is missing here; there are {}", what, known)
                        : fmt::format("there is no {} '{}'; there are {}", what, stl::shortened(name), known);
  }

  ParsedFault& fail(std::string_view where, std::string message) {
    result_.error = {column_of(where), std::max<std::size_t>(where.size(), 1), std::move(message)};
    return result_;
  }

  void read_parameter(std::string_view assignment) {
    const std::size_t equals = assignment.find('=');
    const std::string_view name = trim(assignment.substr(0, equals));
    const auto& of_kind = kind_->parameters;
    if (std::none_of(of_kind.begin(), of_kind.end(), [&](const ParameterOfKind& p) { return p.name == name; })) {
      fail(name, unknown(fmt::format("parameter of {}", kind_->name), name, of_kind));
      return;
    }
    const Parameter& parameter = parameter_of(kind_->kind, name);
    const bool given_value = equals != std::string_view::npos;
    if (has_value(parameter) && !given_value) {
      fail(name, fmt::format("{} needs a value ({}): write {}=VALUE", name, parameter.values, name));
    } else if (!has_value(parameter) && given_value) {
      fail(name, fmt::format("{0} has no value: write {0} alone", name));
    } else if (result_.find(name)) {
      fail(name, fmt::format("{} is given twice", name));
    } else {
      result_.given.push_back({parameter.name, column_of(name), stl::trim(assignment).size()});
      const std::string_view value = given_value ? trim(assignment.substr(equals + 1)) : name;
      if (const std::string wrong = parameter.read(value, result_.fault); !wrong.empty())
        fail(value, given_value ? fmt::format("{}: '{}' {}", name, stl::shortened(value), wrong)
                                : fmt::format("{} {}", name, wrong));
    }
  }

  std::size_t column_of(std::string_view where) const { return static_cast<std::size_t>(where.data() - text_.data()) + 1; }

  void check_whole(std::string_view name) {
    for (const ParameterOfKind& p : kind_->parameters)
      if (p.standard == kRequired && !result_.find(p.name)) {
        fail(name, fmt::format("{} needs {}=VALUE ({}), for example {}", name, p.name,
                               parameter_of(kind_->kind, p.name).values, kind_->example));
        return;
      }
    const Fault& fault = result_.fault;
    if (fault.kind == FaultKind::Answer && fault.misbehaviour == Misbehaviour::Nothing && fault.length == Length{}) {
      fail(name, fmt::format("{} needs one of {}, for example {}", name,
                             stl::joined(kAnswerParameters, [](const Parameter& p) { return p.name; }), kind_->example));
      return;
    }
    for (const GivenParameter& given : result_.given)
      if (excluded_by_instant(result_.fault, given.name)) {
        fail(text_.substr(given.column - 1, given.name.size()), contradiction(given.name));
        return;
      }
  }

  std::string contradiction(std::string_view given) const {
    if (!result_.fault.from)
      return fmt::format("{} says where in an exchange, but at no character of it: write character=N too", given);
    return fmt::format("{} says where in an exchange, from={} at which instant; give one of the two", given,
                       duration_text(*result_.fault.from));
  }

  std::string_view text_;
  const FaultKindInfo* kind_ = nullptr;
  ParsedFault result_;
};

std::string joined(const FaultKindInfo& kind) {
  std::string text;
  for (const ParameterOfKind& p : kind.parameters) {
    if (std::any_of(kWhen.begin(), kWhen.end(), [&](const ParameterOfKind& w) { return w.name == p.name; })) continue;
    if (!text.empty()) text += ", ";
    if (p.standard == kRequired) {
      text += fmt::format("**{}**", p.name);
    } else if (p.standard == kLeftOut) {
      text += p.name;
    } else {
      text += fmt::format("{}={}", p.name, p.standard);
    }
  }
  return text;
}

}  // namespace

Time Length::at(const BitClock& clock) const {
  if (microbits == 0) return time;
  __extension__ using Wide = __int128;
  const Wide per_microbit = Wide{clock.format.baud} * (1'000'000 + clock.clock_error);
  return time + static_cast<Time>((Wide{microbits} * kSecond + per_microbit / 2) / per_microbit);
}

bool at_an_instant(const Fault& fault) {
  const bool cut_at_once = fault.kind == FaultKind::Cut && !fault.character;
  return fault.kind != FaultKind::Noise && (fault.from || cut_at_once);
}

bool is_of_a_station(const Fault& fault) { return fault.kind != FaultKind::Noise && !at_an_instant(fault); }

const GivenParameter* ParsedFault::find(std::string_view parameter) const {
  const auto found = std::ranges::find(given, parameter, &GivenParameter::name);
  return found == given.end() ? nullptr : &*found;
}

ParsedFault parse_fault(std::string_view text) { return FaultReader(text).read(); }

std::string to_text(const Fault& fault) {
  const FaultKindInfo& kind = info_of(fault.kind);
  std::string text(kind.name);
  char separator = ':';
  for (const ParameterOfKind& p : kind.parameters) {
    if (excluded_by_instant(fault, p.name)) continue;
    const Parameter& parameter = parameter_of(fault.kind, p.name);
    const std::string value = parameter.write(fault);
    if (value == p.standard || value == kLeftOut) continue;
    text += fmt::format("{}{}{}{}", separator, p.name, has_value(parameter) ? "=" : "", value);
    separator = ',';
  }
  return text;
}

std::span<const FaultParameter> fault_parameters() {
  static const std::vector<FaultParameter> kTable = [] {
    std::vector<FaultParameter> all(kParameters.begin(), kParameters.end());
    all.insert(all.end(), kAnswerParameters.begin(), kAnswerParameters.end());
    return all;
  }();
  return kTable;
}

const std::array<FaultKindInfo, kFaultKinds>& fault_kinds() {
  static const std::array<FaultKindInfo, kFaultKinds> kKinds{
      kind_info(FaultKind::Noise, "noise", "bits inverted at random, on the idle line too", "noise:ber=1e-4,seed=7",
                {{"ber", kRequired}, {"from", "0s"}, {"for", "ever"}, {"of", "both"}}),
      kind_info(FaultKind::Flip, "flip", "one bit inverted", "flip:character=3,bit=5",
                {{"character", "1"}, {"bit", "0"}, {"of", "request"}}),
      kind_info(FaultKind::Parity, "parity", "the parity bit inverted", "parity:character=2",
                {{"character", "1"}, {"of", "request"}}),
      kind_info(FaultKind::Framing, "framing", "the stop bit at space", "framing:character=2",
                {{"character", "1"}, {"of", "request"}}),
      kind_info(FaultKind::Break, "break", "the line held at space", "break:character=4,length=20bit",
                {{"character", "1"}, {"at", "0bit"}, {"length", "20bit"}, {"of", "request"}, {"from", kLeftOut}}),
      kind_info(FaultKind::Glitch, "glitch", "the level inverted, however short",
                "glitch:character=2,at=4.4bit,length=0.2bit",
                {{"character", "1"}, {"at", "0bit"}, {"length", "0.3bit"}, {"of", "request"}, {"from", kLeftOut}}),
      kind_info(FaultKind::Missing, "missing", "characters that never reach the line; their time passes",
                "missing:character=3", {{"character", "1"}, {"count", "1"}, {"of", "request"}}),
      kind_info(FaultKind::Extra, "extra", "characters that no one sent", "extra:behind=8,bytes=00",
                {{"behind", "1"}, {"bytes", "random"}, {"count", "1"}, {"of", "request"}}),
      kind_info(FaultKind::Gap, "gap", "a pause before a character", "gap:character=4,length=10ms",
                {{"character", "2"}, {"length", kRequired}, {"of", "request"}}),
      kind_info(FaultKind::Echo, "echo", "a two-wire adapter: the master hears its own request", "echo", {}),
      kind_info(
          FaultKind::Collision, "collision", "another station sends at the same time",
          "collision:character=2,at=3bit,bytes=0103",
          {{"character", "1"}, {"at", "0bit"}, {"bytes", "random"}, {"count", "1"}, {"of", "request"}, {"from", kLeftOut}}),
      kind_info(FaultKind::Baud, "baud", "a station whose clock is off, sending and hearing", "baud:error=-3%,station=plc",
                {{"error", kRequired}, {"station", "master"}}),
      kind_info(FaultKind::Cut, "cut", "the line is cut: everybody hears mark", "cut:character=5,for=20ms",
                {{"character", kLeftOut}, {"at", "0bit"}, {"of", "request"}, {"from", kLeftOut}, {"for", "ever"}}),
      kind_info(FaultKind::Answer, "answer", "a slave that misbehaves in whole frames, whose CRC is right",
                "answer:exception=6,every=3",
                {{"delay", kLeftOut},
                 {"exception", kLeftOut},
                 {"station", kLeftOut},
                 {"function", kLeftOut},
                 {"stale", kLeftOut},
                 {"twice", kLeftOut},
                 {"short", kLeftOut},
                 {"silent", kLeftOut}}),
  };
  return kKinds;
}

const FaultKindInfo& info_of(FaultKind kind) { return fault_kinds().at(static_cast<std::size_t>(kind)); }

std::string fault_tables() {
  std::string text = "| fault | parameters (**needed**) | what happens |\n|---|---|---|\n";
  for (const FaultKindInfo& kind : fault_kinds())
    text += fmt::format("| `{}` | {} | {} |\n", kind.name, joined(kind), kind.meaning);
  text += "\n| parameter | value | |\n|---|---|---|\n";
  for (const FaultParameter& parameter : fault_parameters())
    text += fmt::format("| `{}` | {} | {} |\n", parameter.name, parameter.values, parameter.meaning);
  return text;
}

}  // namespace s7200::serial
