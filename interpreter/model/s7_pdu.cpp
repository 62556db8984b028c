#include "interpreter/model/s7_pdu.hpp"

#include <algorithm>

namespace s7200::s7 {

std::uint8_t code_of(Area area) {
  const auto found = std::ranges::find(kWireAreas, area, &WireArea::area);
  return found == kWireAreas.end() ? std::uint8_t{0} : found->code;
}

void append(Bytes& to, const Variable& variable) {
  to.insert(to.end(), kVariableHead.begin(), kVariableHead.end());
  to.push_back(variable.type);
  append16(to, variable.count);
  append16(to, variable.area == Area::V ? 1 : 0);
  to.push_back(code_of(variable.area));
  to.push_back(static_cast<std::uint8_t>(variable.first >> 16));
  append16(to, variable.first & 0xFFFF);
}

Bytes pdu(Kind kind, std::uint16_t number, const Bytes& parameters, const Bytes& data) {
  Bytes bytes{kProtocol, kind, 0, 0};
  append16(bytes, number);
  append16(bytes, parameters.size());
  append16(bytes, data.size());
  bytes.insert(bytes.end(), parameters.begin(), parameters.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

}  // namespace s7200::s7
