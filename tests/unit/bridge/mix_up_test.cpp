// Notes about bytes that are right, but not for this line.
#include "tools/bridge/mix_up.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "interpreter/base/ppi_frame.hpp"
#include "serial_sim/modbus/crc.hpp"

namespace s7200::tools::mix_up_test {
namespace {

std::string note(const Bytes& bytes, const State* state = nullptr) { return mix_up(bytes, state, 0); }

TEST(MixUp, ModbusTcpIsKnownByItsHeader) {
  EXPECT_NE(note({0, 1, 0, 0, 0, 6, 1, 3, 0, 10, 0, 2}).find("--modbus-tcp is the gateway"), std::string::npos);
  EXPECT_EQ(note({0, 1, 0, 0, 0, 7, 1, 3, 0, 10, 0, 2}), "") << "its length is another";
}

TEST(MixUp, ARequestWithoutItsCrcIsKnownByItsLength) {
  EXPECT_NE(note({1, 3, 0, 10, 0, 2}).find("lacks its CRC"), std::string::npos);
  EXPECT_NE(note({1, 16, 0, 10, 0, 1, 2, 0x12, 0x34}).find("lacks its CRC"), std::string::npos);
  Bytes whole{1, 3, 0, 10, 0, 2};
  modbus::add_crc(whole);
  EXPECT_EQ(note(whole), "");
  EXPECT_EQ(note({'H', 'E', 'L', 'L', 'O', '\r'}), "");
}

TEST(MixUp, PpiAtAPortInFreeportModeIsSaidWithItsControlByte) {
  const Bytes status = ppi::to_frame({.destination = 2, .source = 0, .function = ppi::kStatusFunction});
  const auto state = std::make_unique<State>();
  EXPECT_EQ(note(status, state.get()), "") << "the port speaks PPI";
  state->port[0].active = true;
  state->port[0].format = {9600, 8, Parity::None, 1};
  state->image[image::kSM + 30] = 0x09;
  EXPECT_NE(note(status, state.get()).find("SMB30 = 16#09: Freeport, 9600 baud"), std::string::npos)
      << note(status, state.get());
}

}  // namespace
}  // namespace s7200::tools::mix_up_test
