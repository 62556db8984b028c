// request, read, write: a request of Modbus, to a station, with its CRC.
#include "serial_sim/modbus/request.hpp"

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/address.hpp"
#include "tools/scenario/reading/answer_reader.hpp"
#include "tools/scenario/steps/exchange.hpp"

namespace s7200::tools {
namespace {

/// Unless the step says so itself: the scenario's, or that of the PLC that `on` names.
std::uint8_t usual_station(const StepSource& source) {
  if (source.scenario.station) return *source.scenario.station;
  if (!source.step.spot) return 1;
  const PlcPlan& plc = source.scenario.plan->plcs[source.step.spot->plc];
  const std::string& on = source.step.on.empty() ? source.scenario.on : source.step.on;
  const bool names_it = on.substr(0, on.find('.')) == plc.name;  // and not its line
  return names_it ? plc.address.value_or(1) : 1;
}

std::shared_ptr<ExchangeStep> with_station(const StepSource& source, const Bytes& pdu) {
  auto step = std::make_shared<ExchangeStep>();
  const auto station = source.values.number(source.beside("station"), 0, 255).value_or(usual_station(source));
  step->request = serial::to_frame(modbus::rtu_frame(static_cast<std::uint8_t>(station), pdu));
  step->has_crc = true;
  step->read_beside(source);
  return step;
}

Bytes hex_pdu(const StepSource& source) {
  const serial::Frame frame = hex_frame(source.values, source.is);
  if (serial::has_wrong_parity(frame))
    source.values.wrong(source.is, "a byte with wrong parity in a request", "'send' has them");
  return serial::bytes_of(frame);
}

Result<modbus::DataAddress> area_and_number(const std::string& written) {
  const std::size_t blank = written.find(' ');
  const auto first = parse_number(written.substr(blank));
  for (const modbus::AreaRow& row : modbus::areas())
    if (row.word == stl::lower_case(written.substr(0, blank)) && first && *first >= 0 && *first <= 0xFFFF)
      return modbus::DataAddress{row.area, static_cast<std::uint16_t>(*first)};
  return trouble("'{}' is not a place: one of {}, and a number from 0 to 65535", stl::shortened(written),
                 stl::joined(modbus::areas(), &modbus::AreaRow::word));
}

/// `holding 10` or `40011`
std::optional<modbus::DataAddress> place(const StepSource& source, bool to_write) {
  const auto written = source.values.text(source.is);
  if (!written) return {};
  const auto address = written->find(' ') == std::string::npos ? modbus::parse_address(*written) : area_and_number(*written);
  const std::string why = address && to_write && !modbus::row_of(address->area).write_one
                              ? fmt::format("{}s cannot be written", modbus::row_of(address->area).singular)
                              : address.why();
  if (why.empty()) return address.if_any();
  source.values.wrong(source.is, why, "write for example holding 10, coils 0, or 40011");
  return {};
}

Bytes read_pdu(const StepSource& source) {
  const auto where = place(source, false);
  const auto count = static_cast<std::uint16_t>(source.values.number(source.beside("count"), 0, 0xFFFF).value_or(1));
  if (!where) return {};
  Bytes pdu = modbus::read_holding_registers(where->address, count);
  pdu[0] = static_cast<std::uint8_t>(modbus::row_of(where->area).read);
  return pdu;
}

Bytes write_pdu(const StepSource& source) {
  ValueReader& values = source.values;
  const auto where = place(source, true);
  const YamlNode* one = source.beside("value");
  const YamlNode* several = source.beside("values");
  if (!one == !several)
    values.wrong(one ? *one : source.is, one ? "both 'value' and 'values'" : "neither 'value' nor 'values'",
                 "value: 1 writes one, values: [1, 0] several");
  if (!where || !one == !several) return {};
  const std::uint16_t first = where->address;
  const bool coils = modbus::row_of(where->area).bits;
  if (one) {
    const auto written = values.number(one, coils ? 0 : -0x8000, coils ? 1 : 0xFFFF);
    if (!written) return {};
    return coils ? modbus::write_coil(first, *written != 0)
                 : modbus::write_register(first, static_cast<std::uint16_t>(*written));
  }
  std::vector<std::uint16_t> words;
  for (const auto& word : read_numbers(values, *several, coils ? 1 : 0xFFFF, false))
    words.push_back(word.value_or(std::uint16_t{0}));
  if (coils) return modbus::write_coils(first, std::vector<bool>(words.begin(), words.end()));
  return modbus::write_registers(first, words);
}

/// Complains about values that no right answer to a read can have.
void check_values(const StepSource& source, const ExchangeStep& step) {
  const Bytes request = serial::bytes_of(step.request);
  if (request.size() < 6) return;
  const bool bits = request[1] <= 2;
  const auto count = static_cast<std::size_t>(request[4] << 8 | request[5]);
  for (const Expected& expected : step.expected) {
    if (expected.kind != Expected::Kind::Values) continue;
    if (expected.values.size() != count)
      wrong_expectation(source, fmt::format("{} read, {} expected", count, expected.values.size()),
                        fmt::format("write count: {}, or as many values", expected.values.size()));
    if (bits && std::any_of(expected.values.begin(), expected.values.end(), [](auto v) { return v.value_or(0) > 1; }))
      wrong_expectation(source, "coils and inputs are 0 or 1");
  }
}

}  // namespace

std::shared_ptr<const StepAction> read_request(const StepSource& source) { return with_station(source, hex_pdu(source)); }

std::shared_ptr<const StepAction> read_read(const StepSource& source) {
  auto step = with_station(source, read_pdu(source));
  check_values(source, *step);
  return step;
}

std::shared_ptr<const StepAction> read_write(const StepSource& source) { return with_station(source, write_pdu(source)); }

}  // namespace s7200::tools
