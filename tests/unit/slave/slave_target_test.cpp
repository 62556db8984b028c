#include "tools/slave/slave_target.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace s7200::tools::slave_target_test {
namespace {

using Kind = SlaveTarget::Kind;

TEST(SlaveTarget, AnAddressHasASchemeAHostAndAPort) {
  const SlaveTarget rtu = parse_slave_target("tcp://plc.local:4001");
  EXPECT_EQ(rtu.kind, Kind::Tcp);
  EXPECT_EQ(rtu.host, "plc.local");
  EXPECT_EQ(rtu.port, "4001");
  const SlaveTarget tcp = parse_slave_target("modbus-tcp://10.0.0.7:1502");
  EXPECT_EQ(tcp.kind, Kind::ModbusTcp);
  EXPECT_EQ(tcp.host, "10.0.0.7");
  EXPECT_EQ(tcp.port, "1502");
}

TEST(SlaveTarget, ModbusTcpHasAPortOfItsOwn) { EXPECT_EQ(parse_slave_target("modbus-tcp://plc").port, "502"); }

TEST(SlaveTarget, AHostWithAPortAndNoSchemeIsToldTheSchemes) {
  for (const char* text : {"127.0.0.1:5029", "plc.local:502"}) try {
      parse_slave_target(text);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("write tcp://") + text), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(std::string("modbus-tcp://") + text), std::string::npos) << error.what();
    }
  EXPECT_EQ(parse_slave_target("C:5").kind, Kind::Program) << "a drive";
  EXPECT_EQ(parse_slave_target("no/such:7").kind, Kind::Program);
  EXPECT_EQ(parse_slave_target("program.stl:x").kind, Kind::Program);
}

TEST(SlaveTarget, AnIpv6AddressStandsInBrackets) {
  const SlaveTarget with_port = parse_slave_target("tcp://[fe80::1]:4001");
  EXPECT_EQ(with_port.host, "fe80::1");
  EXPECT_EQ(with_port.port, "4001");
  EXPECT_EQ(parse_slave_target("modbus-tcp://[::1]").host, "::1");
}

TEST(SlaveTarget, ATerminalDeviceIsADeviceEvenIfItIsMissing) {
  EXPECT_EQ(parse_slave_target("/dev/ttyNOT_HERE").kind, Kind::Device);
  EXPECT_EQ(parse_slave_target("/dev/null").kind, Kind::Device);
}

TEST(SlaveTarget, EverythingElseIsAProgram) {
  EXPECT_EQ(parse_slave_target("slave.stl").kind, Kind::Program);
  EXPECT_EQ(parse_slave_target("missing").path, "missing");
}

TEST(SlaveTarget, ASystemFileAndAPlcOfAnotherMakeAreNeitherProgramsNorConnectedTo) {
  const SlaveTarget system = parse_slave_target("plant.yaml"), peer = parse_slave_target("westinghouse:pc1200");
  EXPECT_EQ(system.kind, Kind::System);
  EXPECT_EQ(peer.kind, Kind::Peer);
  EXPECT_EQ(peer.path, "pc1200");
  for (const SlaveTarget& target : {system, peer, parse_slave_target("slave.stl")})
    EXPECT_THROW(connect(target, {}, modbus::crc_ok, {}), std::invalid_argument);
}

TEST(SlaveTarget, HelpLeavesOutWhatAVerbDoesNotTake) {
  const std::string some = slave_targets_help({Kind::System, Kind::Peer});
  EXPECT_EQ(some.find("SYSTEM"), std::string::npos);
  EXPECT_EQ(some.find("westinghouse"), std::string::npos);
  EXPECT_NE(some.find("modbus-tcp://"), std::string::npos);
  EXPECT_NE(slave_targets_help().find("SYSTEM"), std::string::npos);
}

TEST(SlaveTarget, WhatIsNoAddressIsRefused) {
  for (const char* text : {"tcp://", "tcp://host", "tcp://host:", "tcp://:502", "tcp://[::1", "tcp://[::1]", "tcp://::1:502",
                           "modbus-tcp://", "modbus-tcp://host:", "modbus-tcp://[::1]502", "udp://host:502"})
    EXPECT_THROW(parse_slave_target(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace s7200::tools::slave_target_test
