#include "tools/recordings/protocols/heard_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/address.hpp"

namespace s7200::tools {
namespace {

using Octets = std::span<const std::uint8_t>;

std::string holding_register(std::uint16_t address) {
  const std::string notation = modbus::notation({modbus::Area::HoldingRegisters, address});
  return notation.empty() ? fmt::format("{} on the wire", address) : notation;
}

std::string registers_in(Octets data) {
  std::string text;
  for (std::size_t at = 0; at + 1 < data.size(); at += 2) text += fmt::format(" 16#{:04X}", load16(&data[at]));
  return text;
}

std::string mask_text(Octets data) {
  constexpr std::size_t kLength = 6;
  if (data.size() != kLength) return {};
  return fmt::format("register {}: AND 16#{:04X}, OR 16#{:04X}", holding_register(load16(&data[0])), load16(&data[2]),
                     load16(&data[4]));
}

std::string mask_request(Octets data) {
  const std::string mask = mask_text(data);
  return mask.empty() ? mask : "mask write " + mask;
}

std::string mask_answer(Octets asked, Octets answer) {
  return std::ranges::equal(asked, answer) ? "masked " + mask_text(answer) : "";
}

std::string read_write_request(Octets data) {
  constexpr std::size_t kHead = 9, kBytes = 8;
  if (data.size() < kHead || data.size() != kHead + data[kBytes]) return {};
  return fmt::format("write registers {}, {} of them:{}; then read holding registers {}, {} of them",
                     holding_register(load16(&data[4])), load16(&data[6]), registers_in(data.subspan(kHead)),
                     holding_register(load16(&data[0])), load16(&data[2]));
}

std::string read_write_answer(Octets asked, Octets answer) {
  const std::size_t count = asked.size() < 4 ? 0 : load16(&asked[2]);
  if (answer.empty() || answer.size() != 1 + 2 * count || answer[0] != 2 * count) return {};
  return fmt::format("{}:{}", counted(count, "register"), registers_in(answer.subspan(1)));
}

constexpr std::uint8_t kIdentification = 14;

std::string identification_request(Octets data) {
  constexpr std::array<std::string_view, 4> kParts{"the basic ones", "the regular ones", "all", "one object"};
  constexpr std::size_t kLength = 3;
  if (data.size() != kLength || data[0] != kIdentification || data[1] == 0 || data[1] > kParts.size()) return {};
  return fmt::format("read device identification, {}, from object {} on", kParts[data[1] - 1U], data[2]);
}

std::string identification_answer(Octets, Octets answer) {
  constexpr std::array<std::string_view, 7> kObjects{"vendor",       "product code", "revision",   "URL",
                                                     "product name", "model",        "application"};
  constexpr std::size_t kHead = 6, kCount = 5;
  if (answer.size() < kHead || answer[0] != kIdentification) return {};
  std::string text = "device identification";
  Octets rest = answer.subspan(kHead);
  for (std::size_t i = 0; i < answer[kCount]; ++i) {
    if (rest.size() < 2 || rest.size() < 2U + rest[1]) return {};
    const std::string value(rest.begin() + 2, rest.begin() + 2 + rest[1]);
    const std::string name = rest[0] < kObjects.size() ? std::string(kObjects[rest[0]]) : fmt::format("object {}", rest[0]);
    text += fmt::format("{} {} '{}'", i == 0 ? ":" : ",", name, stl::printable(value));
    rest = rest.subspan(2U + rest[1]);
  }
  return rest.empty() ? text : "";
}

struct HeardFunction {
  std::uint8_t number;
  std::string (*request)(Octets data);
  std::string (*answer)(Octets asked, Octets answer);
};
constexpr std::array kHeardFunctions{HeardFunction{22, mask_request, mask_answer},
                                     HeardFunction{23, read_write_request, read_write_answer},
                                     HeardFunction{43, identification_request, identification_answer}};

const HeardFunction* find_heard(std::uint8_t number) {
  const auto found = std::ranges::find(kHeardFunctions, number, &HeardFunction::number);
  return found == kHeardFunctions.end() ? nullptr : &*found;
}

}  // namespace

std::string heard_request_text(std::uint8_t function, Octets data) {
  const HeardFunction* const heard = find_heard(function);
  return heard == nullptr ? "" : heard->request(data);
}

std::string heard_answer_text(std::uint8_t function, Octets asked, Octets answer) {
  const HeardFunction* const heard = find_heard(function);
  return heard == nullptr ? "" : heard->answer(asked, answer);
}

}  // namespace s7200::tools
