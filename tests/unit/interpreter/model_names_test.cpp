// Names of special memory and events, and the rows of the ports, against the lists that the checker and the queues read.
#include <gtest/gtest.h>

#include <algorithm>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200::model_names_test {
namespace {

bool is_modelled(std::uint32_t at) {
  const std::uint32_t number = at - image::kSM;
  return std::any_of(special_memory().begin(), special_memory().end(), [&](const SpecialMemory& range) {
    return range.use == SpecialUse::Modelled && number >= range.first && number <= range.last;
  });
}

TEST(ModelNames, ProgramsMayUseEveryByteThatHasAName) {
  for (const std::uint32_t at :
       {sm::kScanStatus, sm::kFlags, sm::kReceivedCharacter, sm::kReceiveStatus, sm::kInterruptStatus, sm::kIdentification,
        sm::kLastScan, sm::kShortestScan, sm::kLongestScan, sm::kPotentiometer[0], sm::kPotentiometer[1], kPorts[0].control,
        sm::kEepromRequest, sm::kEepromAddress, sm::kTimedInterval[0], sm::kTimedInterval[1]})
    EXPECT_TRUE(is_modelled(at)) << "SMB" << at - image::kSM;
  for (const CounterInfo& counter : kCounters) EXPECT_TRUE(is_modelled(counter.status) && is_modelled(counter.status + 9));
  for (const PortInfo& port : kPorts)
    EXPECT_TRUE(is_modelled(port.control) && is_modelled(port.message) && is_modelled(port.message + 8));
  for (const std::uint32_t at : sm::pulses::kStatus) EXPECT_TRUE(is_modelled(at) && is_modelled(at + 9));
}

TEST(ModelNames, TheListHasEachEventAtItsNumber) {
  for (std::size_t number = 0; number < all_events().size(); ++number) EXPECT_EQ(all_events()[number].number, number);
  EXPECT_EQ(find_event(event::kPort0Received)->cause, "port 0: character received");
  EXPECT_EQ(find_event(event::kTimed0)->cause, "timed interrupt 0, SMB34");
  EXPECT_EQ(find_event(event::kCounter2Reset)->cause, "HSC2: external reset");
  EXPECT_EQ(find_event(event::kPulses1Complete)->cause, "PLS1: pulse count complete");
  EXPECT_EQ(find_event(event::kT96Reached)->cause, "timer T96: current value = preset value");
}

TEST(ModelNames, APortIsARowOfItsSpecialMemoryItsEventsAndItsError) {
  struct Row {
    std::uint32_t control, message;
    int idle, received, sent, received_message, busy;
  };
  const Row rows[] = {{30, 86, 1 << 5, 8, 9, 23, 0x09}, {130, 186, 1 << 6, 25, 26, 24, 0x0B}};
  for (std::size_t number = 0; number < kPorts.size(); ++number) {
    const PortInfo& port = kPorts[number];
    const Row& row = rows[number];
    EXPECT_EQ(port.control, image::kSM + row.control);
    EXPECT_EQ(port.message, image::kSM + row.message);
    EXPECT_EQ(port.idle, row.idle);
    EXPECT_EQ(port.received, row.received);
    EXPECT_EQ(port.sent, row.sent);
    EXPECT_EQ(port.received_message, row.received_message);
    EXPECT_EQ(static_cast<int>(port.busy), row.busy);
    for (const std::uint8_t event : {port.received, port.sent, port.received_message})
      EXPECT_EQ(find_event(event)->queue, Queue::Communication);
  }
}

}  // namespace
}  // namespace s7200::model_names_test
