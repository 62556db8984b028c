// What a machine looks like in words: its ports.
#include "tools/views/state/machine_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"

namespace s7200::tools::machine_text_test {
namespace {

std::string ports_of(const CpuModel& model, std::string_view text, std::uint8_t port = 0) {
  serial::Simulation simulation(check_text(text, "test", model, default_times(model)).program, {}, port);
  simulation.power_up();
  simulation.run_until(10 * kMillisecond);
  return port_text(simulation);
}

TEST(MachineText, ACpuWithOnePortShowsOne) {
  EXPECT_EQ(ports_of(*find_cpu("224"), "LD SM0.1\nMOVB 9, SMB30\nMEND\n"),
            "SMB30      16#09 = 2#00001001: Freeport, 9600 baud, 8 data bits, no parity, 1 stop bit\n"
            "receiver   on; event 8 is not attached; SMB2 = 16#00, parity error SM3.0 = 0\n"
            "transmitter idle; event 9 is not attached\n"
            "master     has sent nothing\n");
}

TEST(MachineText, APortShowsItsJobsAsAMaster) {
  EXPECT_EQ(ports_of(*find_cpu("224"),
                     "LD SM0.1\nMOVB 2, SMB30\nMOVB 5, VB101\nMOVD &VB0, VD102\nMOVB 1, VB106\nMOVD VD101, VD201\n"
                     "MOVW VW105, VW205\nNETR VB100, 0\nNETW VB200, 0\nMEND\n"),
            "SMB30      16#02 = 2#00000010: PPI master\n"
            "receiver   PPI, station 2; event 8 is not attached; SMB2 = 16#00, parity error SM3.0 = 0\n"
            "jobs       NETR VB100, NETW VB200\n"
            "transmitter idle; event 9 is not attached\n"
            "master     has sent nothing\n");
}

TEST(MachineText, ACpuWithTwoPortsShowsBothAndTheMasterWhereItIs) {
  const char* const program =
      "LD SM0.1\nMOVB 5, SMB130\nMOVB 16#C0, SMB187\nMOVB 20, SMB194\nATCH 0, 24\nRCV VB0, 1\nMEND\nINT 0\nRETI\n";
  const std::string port0 =
      "SMB30      16#00 = 2#00000000: PPI slave\n"
      "receiver   PPI, station 2; event 8 is not attached; SMB2 = 16#00, parity error SM3.0 = 0\n"
      "transmitter idle; event 9 is not attached\n";
  const std::string port1 =
      "SMB130     16#05 = 2#00000101: Freeport, 19200 baud, 8 data bits, no parity, 1 stop bit\n"
      "receiver   on; SMB2 = 16#00, parity error SM3.0 = 0\n"
      "RCV        waits for the start of a message; event 24 → INT 0\n"
      "transmitter idle; event 26 is not attached\n";
  const std::string master = "master     has sent nothing\n";
  EXPECT_EQ(ports_of(*find_cpu("226"), program), port0 + master + port1);
  EXPECT_EQ(ports_of(*find_cpu("226"), program, 1), port0 + port1 + master);
}

TEST(MachineText, AProgramThatReceivesWithRcvIsToldWhetherOneWaits) {
  const auto receiver = [](std::string_view more) {
    const std::string shown =
        ports_of(*find_cpu("224"), fmt::format("LD SM0.1\nMOVB 9, SMB30\n{}MEND\nINT 0\nRETI\n", more));
    const std::size_t begin = shown.find("receiver");
    return shown.substr(begin, shown.find("transmitter") - begin);
  };
  constexpr std::string_view kRest = "SMB2 = 16#00, parity error SM3.0 = 0\n";
  EXPECT_EQ(receiver("MOVB 16#80, SMB87\nRCV VB100, 0\n"),  // no start condition
            fmt::format("receiver   on; {}RCV        no RCV waits, SMB86 = 16#40 (no start condition or no room); event 23 "
                        "is not attached\n",
                        kRest));
  EXPECT_EQ(receiver("ATCH 0, 23\nAN SM0.0\nRCV VB100, 0\n"),
            fmt::format("receiver   on; {}RCV        no RCV waits, SMB86 = 16#00; event 23 → INT 0\n", kRest));
  EXPECT_EQ(
      receiver("ATCH 0, 8\nAN SM0.0\nRCV VB100, 0\n"),
      fmt::format("receiver   on; event 8 → INT 0; {}RCV        no RCV waits, SMB86 = 16#00; event 23 is not attached\n",
                  kRest));
}

}  // namespace
}  // namespace s7200::tools::machine_text_test
