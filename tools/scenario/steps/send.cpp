// send: a frame as it stands, in hex or as text.
#include <algorithm>

#include "serial_sim/modbus/request.hpp"
#include "tools/scenario/reading/answer_reader.hpp"
#include "tools/scenario/steps/exchange.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

serial::Frame text_frame(ValueReader& values, const YamlNode& map) {
  const auto written = text_inside(values, map);
  if (!written) return {};
  serial::ParsedFrame parsed = parse_text(*written);
  if (!parsed.ok()) values.wrong(map.items[0], parsed.errors[0].message, R"(write for example {text: 'HELLO\r'})");
  return std::move(parsed.frame);
}

bool is_of_modbus(const Expected& expected) {
  using Kind = Expected::Kind;
  return expected.kind == Kind::Exception || expected.kind == Kind::Values || expected.kind == Kind::Accepted ||
         expected.kind == Kind::Refused;
}

}  // namespace

std::shared_ptr<const StepAction> read_send(const StepSource& source) {
  auto step = std::make_shared<ExchangeStep>();
  step->request = source.is.is_map() ? text_frame(source.values, source.is) : hex_frame(source.values, source.is);
  step->has_crc = source.values.truth(source.beside("crc"));
  if (step->has_crc) modbus::append_crc(step->request);
  step->read_beside(source);
  if (source.is.is_map() && !step->has_crc && std::any_of(step->expected.begin(), step->expected.end(), is_of_modbus))
    wrong_expectation(source,
                      "values, accepted, refused and exceptions are answers of Modbus, and a text is not a Modbus request",
                      R"(write for example {text: 'OK\r'}, hex, any, silence or echo)");
  return step;
}

}  // namespace s7200::tools
