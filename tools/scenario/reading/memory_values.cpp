#include "tools/scenario/reading/memory_values.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "interpreter/base/bytes.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

struct PlaceAndValue {
  std::string address, value;  ///< as they were written
  MemoryRange range;
};

std::optional<PlaceAndValue> read_place(ValueReader& values, const YamlNode& key, const YamlNode& item,
                                        const AddressSpace& space) {
  const auto address = values.text(key), value = values.text(item);
  if (!address || !value) return {};
  const auto range = parse_range(*address, space);
  if (!range) {
    values.wrong(key, range.why());
    return {};
  }
  return PlaceAndValue{*address, *value, *range};
}

std::optional<Assignment> read_assignment(ValueReader& values, const YamlNode& item, const PlaceAndValue& written) {
  auto result = parse_value(written.range, written.value);
  if (!result)
    values.wrong(item, fmt::format("'{}' does not fit {}", stl::shortened(written.value), written.address),
                 "write a number such as 5, -5, 16#1234, or 1.5 for a double word");
  return result;
}

std::optional<MemoryExpected> limits_expected(ValueReader& values, const YamlNode& item, const PlaceAndValue& written) {
  const auto refuse = [&](std::string_view why) {
    values.wrong(item, fmt::format("'{}': {}", stl::shortened(written.value), why),
                 "write for example 5..10, 5.., -5..5, or 1.0..2.5 for a double word");
    return std::nullopt;
  };
  MemoryExpected expected{.range = written.range, .address = written.address, .written = written.value};
  if (expected.range.width == Width::Bit) return refuse("a bit is 0 or 1");
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  MemoryExpected::Limits limits{.from = -kUnlimited, .to = kUnlimited};
  const auto [from, to, range] = sides(written.value);
  int reals = 0, numbers = 0;
  for (const auto& [side, limit] : {std::pair(from, &limits.from), std::pair(to, &limits.to)}) {
    if (side.empty()) continue;
    const auto assigned = parse_value(expected.range, side);
    const auto number = parse_number(side);
    if (!assigned || !(number || assigned->place.real))
      return refuse(fmt::format("'{}' does not fit {}", side, written.address));
    *limit = assigned->place.real ? std::bit_cast<float>(assigned->value) : static_cast<double>(*number);
    ++(assigned->place.real ? reals : numbers);
  }
  if (reals + numbers == 0) return refuse("neither from nor to");
  if (reals > 0 && numbers > 0) return refuse("both limits of a real are reals");
  if (limits.from > limits.to) return refuse("no value is inside");
  expected.range.real = reals > 0;
  const double largest = expected.range.width == Width::Word ? INT16_MAX : INT32_MAX;
  limits.is_signed =
      expected.range.width != Width::Byte && limits.from <= largest && (limits.to <= largest || limits.to == kUnlimited);
  const bool both = numbers > 1 && !limits.is_signed && limits.from < 0;
  if (both) return refuse("a value with a sign is not that large, and one without is not below 0");
  expected.limits = limits;
  return expected;
}

/// `5`, `16#1234`, `1.5`
std::optional<MemoryExpected> value_expected(ValueReader& values, const YamlNode& item, const PlaceAndValue& written) {
  const auto one = read_assignment(values, item, written);
  if (!one) return {};
  MemoryExpected expected{.range = one->place, .address = written.address, .written = written.value};
  if (one->place.real) {
    const double value = std::bit_cast<float>(one->value);
    expected.limits = {.from = value, .to = value};
    return expected;
  }
  std::array<std::uint8_t, 4> big_endian{};
  store32(big_endian.data(), one->value);
  expected.bytes.assign(big_endian.end() - one->place.bytes(), big_endian.end());
  return expected;
}

/// `01 02 .. 04`
std::optional<MemoryExpected> bytes_expected(ValueReader& values, const YamlNode& item, const PlaceAndValue& written) {
  auto pattern = parse_pattern(written.value);
  if (!pattern) {
    values.wrong(item, fmt::format("'{}' are not bytes: {}", stl::shortened(written.value), pattern.why()),
                 "write for example 01 02 .. 04");
    return {};
  }
  if (pattern->size() != written.range.bytes()) {
    values.wrong(item,
                 fmt::format("{} bytes for {}, which has {}", pattern->size(), written.address, written.range.bytes()));
    return {};
  }
  return MemoryExpected{
      .range = written.range, .bytes = std::move(*pattern), .address = written.address, .written = written.value};
}

std::optional<MemoryExpected> read_expected(ValueReader& values, const YamlNode& key, const YamlNode& item,
                                            const AddressSpace& space) {
  const auto written = read_place(values, key, item, space);
  if (!written) return {};
  if (written->range.count > 1) return bytes_expected(values, item, *written);
  const bool limits = written->value.find("..") != std::string::npos;
  return limits ? limits_expected(values, item, *written) : value_expected(values, item, *written);
}

/// As an instruction reads the value.
double value_of(const MemoryRange& range, bool is_signed, const std::vector<std::uint8_t>& bytes) {
  switch (range.width) {
    case Width::Bit:
    case Width::Byte:
      return bytes[0];
    case Width::Word: {
      const std::uint16_t value = load16(bytes.data());
      return is_signed ? static_cast<std::int16_t>(value) : value;
    }
    case Width::Double: {
      const std::uint32_t value = load32(bytes.data());
      if (range.real) return std::bit_cast<float>(value);
      return is_signed ? static_cast<std::int32_t>(value) : static_cast<double>(value);
    }
  }
  return 0;
}

std::string real_text(const std::vector<std::uint8_t>& bytes) {
  return stl::to_text(stl::Operand{.value = stl::Real{std::bit_cast<float>(load32(bytes.data()))}});
}

/// In the notation of what was expected: hex beside hex, decimal beside decimal.
std::string found_text(const Program& program, const MemoryExpected& expected, const Bytes& found) {
  if (expected.range.real) return real_text(found);
  const bool in_hex = expected.written.find('#') != std::string::npos;
  if (in_hex) return value_text(program, expected.range, found);
  const bool is_signed = !expected.limits || expected.limits->is_signed;
  return fmt::format("{:.0f}", value_of(expected.range, is_signed, found));
}

}  // namespace

std::vector<Assignment> read_assignments(ValueReader& values, const YamlNode& map, const AddressSpace& space) {
  std::vector<Assignment> assignments;
  if (!map.is_map())
    values.wrong(map, "addresses and values are a map, not " + to_text(map), "write for example {VW20: 16#1234, I0.3: 1}");
  for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i)
    if (const auto written = read_place(values, map.keys[i], map.items[i], space))
      if (const auto one = read_assignment(values, map.items[i], *written)) assignments.push_back(*one);
  return assignments;
}

std::vector<MemoryExpected> read_memory_expected(ValueReader& values, const YamlNode& map, const AddressSpace& space) {
  std::vector<MemoryExpected> expected;
  if (!map.is_map() || map.keys.empty()) {
    values.wrong(map, "addresses and values are a map, not " + (map.is_map() ? "an empty one" : to_text(map)),
                 "write for example {VW20: 16#1234, Q0.0: 1}");
    return expected;
  }
  for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i)
    if (auto one = read_expected(values, map.keys[i], map.items[i], space)) expected.push_back(std::move(*one));
  return expected;
}

bool MemoryExpected::fits(const std::vector<std::uint8_t>& found) const {
  if (limits) {
    const double value = value_of(range, limits->is_signed, found);
    return value >= limits->from && value <= limits->to;
  }
  return std::equal(bytes.begin(), bytes.end(), found.begin(), found.end(),
                    [](const BytePattern& pattern, std::uint8_t byte) { return !pattern || *pattern == byte; });
}

Finding memory_finding(const Program& program, const MemoryExpected& expected, const Bytes& found) {
  Finding finding{.what = named(program, expected.range),
                  .expected_bytes = expected.bytes,
                  .found_bytes = {found.begin(), found.end()},
                  .memory = expected.range};
  if (expected.range.count > 1) return finding;
  finding.expected = expected.written;
  finding.found = found_text(program, expected, found);
  if (!expected.limits && expected.range.width == Width::Double)
    if (const std::string real = real_text(found); real == expected.written + ".0")
      finding.found += fmt::format(", the real {}: write {} for it", real, real);
  return finding;
}

}  // namespace s7200::tools
