#include <gtest/gtest.h>

#include "serial_sim/modbus/address.hpp"

namespace s7200::modbus::modbus_address_test {
namespace {

std::optional<DataAddress> parsed(std::string_view text) {
  const auto address = parse_address(text);
  EXPECT_EQ(address.has_value(), address.why().empty()) << text;
  return address.if_any();
}

std::string refused(std::string_view text) { return parse_address(text).why(); }

TEST(ModbusAddress, EachAreaBeginsAt1AndEndsAt9999) {
  struct Limit {
    std::string_view text;
    Area area;
    std::uint16_t address;
  };
  for (const Limit& limit :
       {Limit{"00001", Area::Coils, 0}, Limit{"00017", Area::Coils, 16}, Limit{"09999", Area::Coils, 9998},
        Limit{"10001", Area::Inputs, 0}, Limit{"10005", Area::Inputs, 4}, Limit{"19999", Area::Inputs, 9998},
        Limit{"30001", Area::InputRegisters, 0}, Limit{"39999", Area::InputRegisters, 9998},
        Limit{"40001", Area::HoldingRegisters, 0}, Limit{"49999", Area::HoldingRegisters, 9998}}) {
    EXPECT_EQ(parsed(limit.text), (DataAddress{limit.area, limit.address})) << limit.text;
    EXPECT_EQ(parsed("0" + std::string(limit.text)), (DataAddress{limit.area, limit.address})) << limit.text;
    EXPECT_EQ(notation({limit.area, limit.address}), limit.text);
  }
}

TEST(ModbusAddress, SixDigitsReachAllHoldingRegisters) {
  EXPECT_EQ(parsed("400001"), (DataAddress{Area::HoldingRegisters, 0}));
  EXPECT_EQ(parsed("410000"), (DataAddress{Area::HoldingRegisters, 9999}));
  EXPECT_EQ(parsed("465536"), (DataAddress{Area::HoldingRegisters, 65535}));
  EXPECT_EQ(notation({Area::HoldingRegisters, 9999}), "410000");
  EXPECT_EQ(notation({Area::HoldingRegisters, 65535}), "465536");
  EXPECT_EQ(notation({Area::Coils, 9999}), "");
}

TEST(ModbusAddress, ZeroIsRefusedInEachArea) {
  EXPECT_EQ(refused("00000"), "there is no coil 00000: this notation counts from 1, the first is 00001");
  EXPECT_EQ(refused("000000"), "there is no coil 000000: this notation counts from 1, the first is 000001");
  EXPECT_EQ(refused("10000"), "there is no input 10000: this notation counts from 1, the first is 10001");
  EXPECT_EQ(refused("30000"), "there is no input register 30000: this notation counts from 1, the first is 30001");
  EXPECT_EQ(refused("40000"), "there is no holding register 40000: this notation counts from 1, the first is 40001");
  EXPECT_EQ(refused("400000"), "there is no holding register 400000: this notation counts from 1, the first is 400001");
}

TEST(ModbusAddress, BetweenTheAreasIsNothing) {
  for (const char* text :
       {"20000", "20001", "29999", "50000", "50001", "99999", "100001", "165536", "300001", "399999", "465537", "999999"})
    EXPECT_NE(refused(text).find("is in no area: 00001 to 09999 coils"), std::string::npos) << text;
}

TEST(ModbusAddress, NothingButFiveOrSixDigitsIsAnAddress) {
  for (const char* text : {"", "1", "17", "9999", "4000001", "0400001", "-0001", "4000x", "40 01", "VW100"})
    EXPECT_NE(refused(text).find("is not an address of 5 or 6 digits"), std::string::npos) << text;
}

TEST(ModbusAddress, TheAreaSelectsTheFunctions) {
  const AreaRow& coils = row_of(Area::Coils);
  EXPECT_EQ(coils.read, Function::ReadCoils);
  EXPECT_EQ(coils.write_one, Function::WriteCoil);
  EXPECT_EQ(coils.write_many, Function::WriteCoils);
  const AreaRow& holding = row_of(Area::HoldingRegisters);
  EXPECT_EQ(holding.read, Function::ReadHoldingRegisters);
  EXPECT_EQ(holding.write_one, Function::WriteRegister);
  EXPECT_EQ(holding.write_many, Function::WriteRegisters);
  EXPECT_EQ(row_of(Area::Inputs).read, Function::ReadInputs);
  EXPECT_EQ(row_of(Area::InputRegisters).read, Function::ReadInputRegisters);
  for (const Area area : {Area::Inputs, Area::InputRegisters}) {
    EXPECT_FALSE(row_of(area).write_one);
    EXPECT_FALSE(row_of(area).write_many);
  }
}

}  // namespace
}  // namespace s7200::modbus::modbus_address_test
